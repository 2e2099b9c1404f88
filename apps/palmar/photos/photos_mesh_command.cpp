// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>

#include "hand/hand_output.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "photos/photo_lenses.h"
#include "photos/photo_mesh.h"
#include "photos/photos_commands.h"

namespace palmar::cli {
namespace {

struct PhotosMeshArguments {
  std::string folder, out;
  PhotoMeshArguments mesh;
};

int run_mesh(PhotosMeshArguments arguments, const Context& context) {
  if (std::filesystem::path(arguments.out).extension() != ".ply") {
    throw UsageError(arguments.out + ": the mesh is written as .ply, with colours");
  }
  arguments.mesh.check();
  require_writable(folder_of(arguments.out));
  const Progress progress = make_progress(context.common);
  std::optional<PhotoLenses> lenses;
  if (!arguments.mesh.lenses.empty()) {
    lenses = lenses_of(arguments.mesh.lenses, part_of(progress, 0.0, 0.05));
  }
  const PhotoMeshPlan plan =
      plan_photo_mesh(arguments.folder, arguments.out, lenses, arguments.mesh);
  note(context.common, plan.kept ? arguments.out + " is there already, made of the same photographs"
                                 : fmt::format("{} photographs; this takes about {:.0f} s",
                                               plan.set.photographs.size(), plan.seconds));
  const auto report = make_photo_mesh(plan, lenses, arguments.mesh, part_of(progress, 0.05, 1.0));
  finish_progress();
  for (const auto& warning : report.at("warnings")) {
    note(context.common, "warning: " + warning.get<std::string>());
  }
  print(context.common.json ? report.dump(2) + "\n"
                            : photo_mesh_text(report) +
                                  fmt::format("mesh         {}\nreport       {}\n", arguments.out,
                                              report_beside(arguments.out).string()));
  return 0;
}

}  // namespace

void add_photos_mesh_command(CLI::App& photos, Context& context) {
  const auto o = std::make_shared<PhotosMeshArguments>();
  CLI::App* verb = add_verb(photos, "mesh",
                            "A coloured mesh in millimetres from photographs of a hand that stands "
                            "on the middle of the board, taken from all round at two heights",
                            "palmar photos mesh photos/ --lenses lenses.json --out hand.ply");
  verb->add_option("folder", o->folder,
                   "Photographs (.png, .jpg); names like p3_c2.jpg say position and camera")
      ->required();
  verb->add_option("--out", o->out, "The mesh, .ply; a report goes beside it")->required();
  o->mesh.add_to(*verb);
  verb->callback([&context, o] { context.run = [&context, o] { return run_mesh(*o, context); }; });
}

}  // namespace palmar::cli
