// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/capture/photo/board_pattern.h"
#include "hands/capture/photo/photo_camera.h"

namespace palmar::capture {

/// Where a camera stands to the board that it sees.
struct BoardPose {
  geometry::Rigid3 camera_from_world;
  double rms = 0.0;  ///< of the corners' residuals, per coordinate, pixels
  int used = 0;      ///< corners; the others were more than a few times the rms off
};

/// From the corners in a photograph whose lens is known: the plane's homography, then least squares
/// of the residuals, corners farther off than 2 and then 1 pixel (or four times the rms) left out.
/// Nothing if fewer than 8 corners are seen, or they lie on a line.
std::optional<BoardPose> find_board_pose(const PhotoLens& lens,
                                         const std::vector<BoardCorner>& corners);

/// A lens, and how well the photographs of the board hold it.
struct LensCalibration {
  PhotoLens lens;
  std::vector<std::optional<BoardPose>> poses;  ///< per photograph
  double rms = 0.0;                             ///< per coordinate, pixels
  double focal_deviation = 0.0;                 ///< standard deviation of the focal length, pixels
  double centre_deviation = 0.0;                ///< of the centre's worse coordinate, pixels
  int photographs = 0;                          ///< that were used
};

/// What is known of a lens before any photograph; deviations as shares.
struct LensExpectation {
  std::optional<double> focal;      ///< what the camera says of it, pixels
  double focal_deviation = 0.04;    ///< of that: lenses say round numbers, focusing changes them
  double centre_deviation = 0.01;   ///< of the centre from the picture's, of the larger side
  double square_deviation = 0.003;  ///< of the pixels' height over width from 1
};

/// All numbers of a lens and its places from photographs of the board with this one camera, focus
/// and zoom untouched. Photographs should show the board tilted every way: a camera that goes round
/// a flat board at one height can't determine its centre from its tilt (the deviations then say
/// so). What lenses are like (LensExpectation) counts for as much as it is certain: nothing beside
/// good photographs, but it holds what these can't determine. Throws InputError naming `name` if
/// fewer than three photographs show 8 corners or more, or no lens fits. Source: Zhang 2000, "A
/// flexible new technique for camera calibration".
LensCalibration calibrate_lens(int width, int height,
                               const std::vector<std::vector<BoardCorner>>& photographs,
                               const std::string& name, const LensExpectation& expected = {});

}  // namespace palmar::capture
