// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "hands/capture/photo/photo_camera.h"

namespace palmar::capture {

/// Points that look distinct and which of them look alike, as the picture matcher says.
struct PointMatches {
  std::vector<std::vector<std::array<float, 2>>> point;  ///< per picture: pixels
  std::vector<std::array<int, 2>> pair;                  ///< pictures
  std::vector<std::vector<std::array<int, 2>>> match;    ///< per pair: points of the two
};

struct HandMotionOptions {
  double gate = 7.0;         ///< matches farther from the epipolar line are none, pixels
  double shift_prior = 3.0;  ///< deviation of the hand's shift between positions, mm
  double turn_prior = 1.5;   ///< and of its turn, deg
  /// The correction counts if it lowers the typical residual to this share or less.
  double worth = 0.9;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// How the hand moved between the positions of the rig.
struct HandMotion {
  std::vector<geometry::Rigid3> board_from_hand;  ///< per position; the first stays
  int tracks = 0;                                 ///< points of the skin that were followed
  double before = 0.0;         ///< median residual as if it had not moved, pixels
  double after = 0.0;          ///< with the motions
  bool is_applied = false;     ///< the correction is worth it; else all motions are zero
  double largest_shift = 0.0;  ///< of a motion, at the middle of the points, mm
  double largest_turn = 0.0;   ///< rad
};

/// Points of the skin, followed through pictures of several positions (all the pictures of one
/// position were taken together), and one rigid motion per position that makes what is left of
/// their residuals least (Cauchy's weights; the motions are small by a weak prior). Points are
/// taken out of the normal equations (Schur complement). Pictures are without distortion;
/// `position` from 0.
HandMotion fit_hand_motion(const std::vector<PhotoCamera>& cameras,
                           const std::vector<int>& position, const PointMatches& matches,
                           const HandMotionOptions& options = {});

}  // namespace palmar::capture
