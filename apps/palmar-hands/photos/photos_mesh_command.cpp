// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hands/person_workflow/steps/photo_steps.h"
#include "palmar/geometry/degrees.h"
#include "photos/photo_mesh_arguments.h"
#include "photos/photos_commands.h"

namespace palmar::cli {
namespace {

struct PhotosMeshArguments {
  person_workflow::PhotoMeshRequest request;
  PhotoMeshArguments mesh;
};

/// Photographs, motion, surface; a line each.
std::string photo_mesh_text(const person_workflow::PhotoMeshReport& report) {
  std::string moved = "not looked for";
  if (report.motion_is_corrected) {
    moved =
        fmt::format("corrected, up to {:.2f} mm and {:.2f} deg ({} points, {:.2f} -> {:.2f} px)",
                    report.largest_shift, report.largest_turn * geometry::kDegreesPerRadian,
                    report.motion_points, report.residual_before, report.residual_after);
  } else if (report.motion_points > 0) {
    moved = fmt::format("none found ({} points, {:.2f} px)", report.motion_points,
                        report.residual_after);
  }
  return fmt::format(
      "photographs  {} of {} used, board {:.2f} px\n"
      "motion       {}\n"
      "surface      {} points, {} triangles, {:.1f} % of the area measured\n",
      report.used, report.photographs, report.board_residual, moved, report.points,
      report.triangles, 100.0 * report.measured_share);
}

int run_mesh(const PhotosMeshArguments& arguments, const Context& context) {
  person_workflow::PhotoMeshRequest request = arguments.request;
  request.options = arguments.mesh.options();
  request.note = [&context](const std::string& text) { note(context.common, text); };
  const person_workflow::PhotoMeshOutcome outcome =
      person_workflow::make_mesh_from_photos(request, make_progress(context.common));
  finish_progress();
  for (const std::string& warning : outcome.report.warnings) {
    note(context.common, "warning: " + warning);
  }
  print(context.common.json
            ? nlohmann::ordered_json::parse(outcome.report.json).dump(2) + "\n"
            : photo_mesh_text(outcome.report) + fmt::format("mesh         {}\nreport       {}\n",
                                                            request.out, outcome.report_file));
  return 0;
}

}  // namespace

void add_photos_mesh_command(CLI::App& photos, Context& context) {
  const auto o = std::make_shared<PhotosMeshArguments>();
  CLI::App* verb = add_verb(photos, "mesh",
                            "A coloured mesh in millimetres from photographs of a hand on the "
                            "middle of the board, taken from all round at two heights",
                            "palmar photos mesh photos/ --lenses lenses.json --out hand.ply");
  verb->add_option("folder", o->request.folder,
                   "Photographs (.png, .jpg); names like p3_c2.jpg name position and camera")
      ->required();
  verb->add_option("--out", o->request.out, "Mesh to write, .ply; a report is written beside it")
      ->required();
  o->mesh.add_to(*verb);
  verb->callback([&context, o] { context.run = [&context, o] { return run_mesh(*o, context); }; });
}

}  // namespace palmar::cli
