// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "photos/photos_commands.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hands/person_workflow/steps/photo_steps.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

int run_board(const person_workflow::PhotoBoardRequest& request, const Context& context) {
  person_workflow::draw_photo_board(request);
  if (context.common.json) {
    print(Json{{"board", request.out}, {"edge_mm", request.board.edge()}}.dump(2) + "\n");
  } else {
    print(
        fmt::format("{}: {:g} x {:g} mm; print it at 100 %, check the ruler, glue it on something "
                    "flat\n",
                    request.out, request.board.edge(), request.board.edge()));
  }
  return 0;
}

int run_calibrate(const person_workflow::PhotoLensesRequest& request, const Context& context) {
  const person_workflow::PhotoLensesOutcome outcome =
      person_workflow::calibrate_photo_lenses(request, make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    print(person_records::format_lenses(outcome.lenses));
    return 0;
  }
  std::string text;
  for (const auto& [camera, one] : outcome.lenses) {
    text += fmt::format(
        "{:<8} focal {:.1f} +- {:.1f} px, centre {:.1f} {:.1f} +- {:.1f} px, residual {:.3f} px of "
        "{} "
        "photographs\n",
        camera, one.lens.focal_x, one.focal_deviation, one.lens.centre_x, one.lens.centre_y,
        one.centre_deviation, one.rms, one.photographs);
  }
  for (const std::string& loose : outcome.notes) note(context.common, loose);
  print(text + "lenses: " + request.out + "\n");
  return 0;
}

}  // namespace

void add_photos_commands(CLI::App& app, Context& context) {
  CLI::App* photos = app.add_subcommand(
      "photos", "A coloured mesh of a hand from photographs: board, lenses, mesh");
  photos->require_subcommand(1);
  photos->fallthrough();
  photos->footer("Example: palmar photos mesh photos/ --lenses lenses.json --out hand.ply");

  const auto b = std::make_shared<person_workflow::PhotoBoardRequest>();
  CLI::App* board = add_verb(*photos, "board", "The board under the hand, to be printed",
                             "palmar photos board --out board.svg");
  board->add_option("--out", b->out, "The drawing, .svg in millimetres")->required();
  board->add_option("--squares", b->board.squares, "Along an edge; odd")->capture_default_str();
  board->add_option("--square-mm", b->board.square, "Edge of a square")->capture_default_str();
  board->add_option("--marker-mm", b->board.marker, "Edge of a marker")->capture_default_str();
  board->callback(
      [&context, b] { context.run = [&context, b] { return run_board(*b, context); }; });

  const auto c = std::make_shared<person_workflow::PhotoLensesRequest>();
  CLI::App* calibrate = add_verb(*photos, "calibrate",
                                 "Lenses of cameras from about 12 photographs each of the board, "
                                 "tilted every way; focus and zoom as for the hand",
                                 "palmar photos calibrate calibration/ --out lenses.json");
  calibrate->add_option("folder", c->folder, "Photographs; names like p3_c2.jpg name the camera")
      ->required();
  calibrate->add_option("--out", c->out, "JSON file to write: the lenses")->required();
  calibrate->callback(
      [&context, c] { context.run = [&context, c] { return run_calibrate(*c, context); }; });

  add_photos_mesh_command(*photos, context);
}

}  // namespace palmar::cli
