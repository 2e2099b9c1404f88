// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Two axes of a joint: the bone turns about `second` (fixed to it), then about `first` (fixed to
/// the proximal bone); they may be skew. What slides along either is found and dropped, as in
/// fit_hinge().
struct TwoAxisFit {
  Vec3 first_axis = Vec3::UnitX(), first_point = Vec3::Zero();
  Vec3 second_axis = Vec3::UnitZ(), second_point = Vec3::Zero();
  std::vector<std::array<double, 2>> angle;  ///< first, second; of each motion, rad
  double rms = 0.0;                          ///< mm; slides dropped
  bool is_first_observed = false, is_second_observed = false;
  /// Standard errors of the axes as HingeFit::axis_error: the root of half the trace of the tilts'
  /// covariance, (J^T J)^-1 at the solution with the prior in it. So they hold what the prior
  /// leaves open: what a limit posture of one axis does about the other by the way. rad.
  double first_error = 0.0, second_error = 0.0;
};

/// What is known of a two-axis joint before any motion is looked at: standard deviations show how
/// well.
struct TwoAxisPrior {
  Vec3 near = Vec3::Zero();                            ///< where both axes pass, mm
  double place_sd = 3.0;                               ///< of each axis about there, across it, mm
  Vec3 first = Vec3::UnitX(), second = Vec3::UnitZ();  ///< unit
  double first_sd = 0.35, second_sd = 0.35;            ///< rad
  double square_sd = 0.05;  ///< of the angle between the axes about 90 degrees, rad
  double point_sd = 0.15;   ///< of the motions, mm: what registration leaves
  double slide_sd = 3.0;    ///< of what slides along each axis, mm
  /// Of the angle about the other axis that a limit posture of the first, or of the second axis
  /// changes by the way, rad.
  double by_first_sd = 0.25, by_second_sd = 0.03;
};
/// What a motion is meant to be: a posture at the limit of one of the two axes.
enum class MainAxis { kFirst, kSecond, kEither };

/// Least squares over all motions, axes and angles; the prior decides what the motions don't show.
TwoAxisFit fit_two_axes(std::span<const geometry::Rigid3> motions, std::span<const MainAxis> main,
                        std::span<const Vec3> points, const TwoAxisPrior& prior);

}  // namespace palmar::capture
