// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/photo_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "hands/person_records/photo_worker.h"
#include "hands/person_workflow/steps/hand_output.h"
#include "hands/person_workflow/steps/photo_lenses.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"

namespace palmar::person_workflow {
namespace {

void require_folder(const std::string& folder) {
  if (folder.empty()) {
    throw UsageError("setting \"folder\" is empty; a folder of photographs is required");
  }
}

/// The board in millimetres, with a ruler of 100 mm to check the print with. One path of dark runs,
/// rows of cells by rows.
std::string board_svg(const capture::BoardPattern& board, const capture::BoardPicture& picture) {
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

}  // namespace

void PhotoBoardRequest::check() const {
  if (std::filesystem::path(out).extension() != ".svg") {
    throw UsageError(out + ": the board is written as .svg");
  }
}

void draw_photo_board(const PhotoBoardRequest& request) {
  request.check();
  // Markers begin between the cells of a grid only if both lengths are whole numbers of them; a
  // fine picture does for any.
  constexpr int kPixelsPerSquare = 144;
  const capture::BoardPicture picture = person_records::draw_board(request.board, kPixelsPerSquare);
  formats::write_file(request.out, board_svg(request.board, picture));
}

void PhotoLensesRequest::check() const {
  require_folder(folder);
  if (out.empty()) throw UsageError("setting \"out\" is empty; a file to write is required");
}

PhotoLensesOutcome calibrate_photo_lenses(const PhotoLensesRequest& request,
                                          const Progress& progress) {
  request.check();
  const person_records::PhotoSet set = person_records::read_photo_set(request.folder);
  PhotoLensesOutcome outcome;
  outcome.lenses = calibrate_lenses(
      set, person_records::find_boards(set.board, person_records::paths_of(set), progress),
      request.folder);
  formats::write_file(request.out, person_records::format_lenses(outcome.lenses));
  outcome.notes =
      loose_lenses(outcome.lenses, "add photographs with the board tilted in other ways");
  return outcome;
}

void PhotoMeshRequest::check() const {
  require_folder(folder);
  if (std::filesystem::path(out).extension() != ".ply") {
    throw UsageError(out + ": the mesh is written as .ply, with colours");
  }
  options.check();
}

PhotoMeshOutcome make_mesh_from_photos(const PhotoMeshRequest& request, const Progress& progress) {
  request.check();
  require_writable(folder_of(request.out));
  const PhotoMeshOptions& options = request.options;
  std::optional<person_records::PhotoLenses> lenses;
  if (!options.lenses.empty()) {
    lenses = lenses_of(options.lenses, part_of(progress, 0.0, 0.05));
  }
  const PhotoMeshPlan plan = plan_photo_mesh(request.folder, request.out, lenses, options);
  workflow::note_to(request.note,
                    plan.kept ? request.out + " is there already, made of the same photographs"
                              : fmt::format("{} photographs; this takes about {:.0f} s",
                                            plan.set.photographs.size(), plan.seconds));
  PhotoMeshOutcome outcome;
  outcome.report = make_planned_mesh(plan, lenses, options, part_of(progress, 0.05, 1.0));
  outcome.report_file = report_beside(request.out).string();
  return outcome;
}

}  // namespace palmar::person_workflow
