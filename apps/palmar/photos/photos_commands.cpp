// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "photos/photos_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/photo_set.h"
#include "palmar/records/capture/photo_worker.h"
#include "photos/photo_lenses.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct PhotosBoardArguments {
  std::string out;
  BoardPattern board;
};

/// The board in millimetres, with a ruler of 100 mm to check the print with. One path of dark runs,
/// rows of cells by rows.
std::string board_svg(const BoardPattern& board, const BoardPicture& picture) {
  constexpr double kMargin = 12.0;  // mm
  const double edge = board.edge(), pixel = edge / picture.pixels;
  const double width = edge + 2.0 * kMargin, height = width + 14.0;
  std::string path;
  const auto at = [&](int x, int y) {
    return picture.grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.pixels) +
                        static_cast<std::size_t>(x)] < 128;
  };
  for (int y = 0; y < picture.pixels;) {
    // Rows that are alike are one: no seams in print.
    const auto row = picture.grey.begin() + static_cast<long>(y) * picture.pixels;
    int below = y + 1;
    while (below < picture.pixels &&
           std::equal(row, row + picture.pixels,
                      picture.grey.begin() + static_cast<long>(below) * picture.pixels)) {
      ++below;
    }
    for (int x = 0; x < picture.pixels;) {
      int end = x;
      while (end < picture.pixels && at(end, y)) ++end;
      if (end > x) {
        path += fmt::format("M{:.7g} {:.7g}h{:.7g}v{:.7g}h{:.7g}z", kMargin + x * pixel,
                            kMargin + y * pixel, (end - x) * pixel, (below - y) * pixel,
                            (x - end) * pixel);
      }
      x = std::max(end, x + 1);
    }
    y = below;
  }
  const double ruler = width + 2.0;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" viewBox=\"0 0 "
      "{0} "
      "{1}\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n<path d=\"{2}\" "
      "shape-rendering=\"crispEdges\"/>\n<path d=\"M{3} {4}h100m-100 -2v4m100 -4v4\" "
      "stroke=\"#000\" "
      "stroke-width=\"0.3\" fill=\"none\"/>\n<text x=\"{5}\" y=\"{6}\" font-size=\"4\" "
      "font-family=\"sans-serif\">100 mm: measure it; {7} x {7} squares of {8:g} mm, markers {9:g} "
      "mm</text>\n</svg>\n",
      width, height, path, kMargin, ruler, kMargin + 104.0, ruler + 1.5, board.squares,
      board.square, board.marker);
}

int run_board(const PhotosBoardArguments& arguments, const Context& context) {
  const fs::path out(arguments.out);
  if (out.extension() != ".svg") throw UsageError(arguments.out + ": the board is written as .svg");
  // Markers begin between the cells of a grid only if both lengths are whole numbers of them; a
  // fine picture does for any.
  constexpr int kPixelsPerSquare = 144;
  const BoardPicture picture = draw_board(arguments.board, kPixelsPerSquare);
  write_file(out, board_svg(arguments.board, picture));
  if (context.common.json) {
    print(Json{{"board", arguments.out}, {"edge_mm", arguments.board.edge()}}.dump(2) + "\n");
  } else {
    print(
        fmt::format("{}: {:g} x {:g} mm; print it at 100 %, check the ruler, glue it on something "
                    "flat\n",
                    arguments.out, arguments.board.edge(), arguments.board.edge()));
  }
  return 0;
}

struct PhotosCalibrateArguments {
  std::string folder, out;
};

int run_calibrate(const PhotosCalibrateArguments& arguments, const Context& context) {
  const PhotoSet set = read_photo_set(arguments.folder);
  const Progress progress = make_progress(context.common);
  const PhotoLenses lenses =
      calibrate_lenses(set, find_boards(set.board, paths_of(set), progress), arguments.folder);
  write_file(arguments.out, format_lenses(lenses));
  finish_progress();
  if (context.common.json) {
    print(format_lenses(lenses));
    return 0;
  }
  std::string text;
  for (const auto& [camera, one] : lenses) {
    text += fmt::format(
        "{:<8} focal {:.1f} +- {:.1f} px, centre {:.1f} {:.1f} +- {:.1f} px, residual {:.3f} px of "
        "{} "
        "photographs\n",
        camera, one.lens.focal_x, one.focal_deviation, one.lens.centre_x, one.lens.centre_y,
        one.centre_deviation, one.rms, one.photographs);
  }
  for (const std::string& loose :
       loose_lenses(lenses, "add photographs with the board tilted in other ways")) {
    note(context.common, loose);
  }
  print(text + "lenses: " + arguments.out + "\n");
  return 0;
}

}  // namespace

void add_photos_commands(CLI::App& app, Context& context) {
  CLI::App* photos = app.add_subcommand(
      "photos", "A coloured mesh of a hand from photographs: board, lenses, mesh");
  photos->require_subcommand(1);
  photos->fallthrough();
  photos->footer("Example: palmar photos mesh photos/ --lenses lenses.json --out hand.ply");

  const auto b = std::make_shared<PhotosBoardArguments>();
  CLI::App* board = add_verb(*photos, "board", "The board that the hand stands on, to be printed",
                             "palmar photos board --out board.svg");
  board->add_option("--out", b->out, "The drawing, .svg in millimetres")->required();
  board->add_option("--squares", b->board.squares, "Along an edge; odd")->capture_default_str();
  board->add_option("--square-mm", b->board.square, "Edge of a square")->capture_default_str();
  board->add_option("--marker-mm", b->board.marker, "Edge of a marker")->capture_default_str();
  board->callback(
      [&context, b] { context.run = [&context, b] { return run_board(*b, context); }; });

  const auto c = std::make_shared<PhotosCalibrateArguments>();
  CLI::App* calibrate = add_verb(*photos, "calibrate",
                                 "Lenses of cameras from about 12 photographs each of the board, "
                                 "tilted every way; focus and zoom as for the hand",
                                 "palmar photos calibrate calibration/ --out lenses.json");
  calibrate->add_option("folder", c->folder, "Photographs; names like p3_c2.jpg say the camera")
      ->required();
  calibrate->add_option("--out", c->out, "Lenses, JSON")->required();
  calibrate->callback(
      [&context, c] { context.run = [&context, c] { return run_calibrate(*c, context); }; });

  add_photos_mesh_command(*photos, context);
}

}  // namespace palmar::cli
