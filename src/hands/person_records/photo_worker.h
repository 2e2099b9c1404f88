// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hands/capture/photo/board_pattern.h"
#include "hands/capture/photo/surface/hand_motion.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::person_records {

/// The pattern of a board with `pixels_per_square` pixels along a square. This and the functions
/// below start palmar-photo (beside this program, or $PALMAR_PHOTO), which links OpenCV; they throw
/// ProgramMissing if Palmar was built without it, and as run_worker() does.
capture::BoardPicture draw_board(const capture::BoardPattern& pattern, int pixels_per_square);

/// What a photograph shows of the board.
struct BoardSighting {
  int width = 0, height = 0;  ///< pixels
  double sharpness = 0.0;     ///< steepest edges over the range of brightness; a print's is up to 1
  std::vector<capture::BoardCorner> corners;
};

/// Corners of the board in every file (PNG, JPEG), a file each.
std::vector<BoardSighting> find_boards(const capture::BoardPattern& pattern,
                                       const std::vector<std::filesystem::path>& files,
                                       const Progress& progress = {});

/// A grey picture and where in it points may be found; bytes row by row, inside 0 or 1.
struct MatchPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> grey, inside;
};

/// Points that look distinct and which look alike, for pairs of pictures.
capture::PointMatches match_points(const std::vector<MatchPicture>& pictures,
                                   const std::vector<std::array<int, 2>>& pairs,
                                   const Progress& progress = {});

}  // namespace palmar::person_records
