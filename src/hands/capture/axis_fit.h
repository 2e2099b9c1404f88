// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// The fixed axis that describes a rigid motion best: R u = u, (E - R) p = t with the component of
/// t along u dropped (Xie 2014, eq. 2-2 to 2-4).
struct AxisFit {
  Vec3 axis = Vec3::UnitX();  ///< unit; the turn about it is `angle` >= 0
  Vec3 point = Vec3::Zero();  ///< on the axis, nearest to where it was looked for
  double angle = 0.0;         ///< rad, [0, pi]
  double slide = 0.0;        ///< of the motion along the axis, which a pure rotation can't make, mm
  bool is_observed = false;  ///< the angle is large enough to determine an axis
};
/// `motion` of the distal part relative to the proximal one; `near`: where the joint is, mm.
AxisFit fit_axis(const geometry::Rigid3& motion, const Vec3& near);

/// Six points with the centre and the second moments of a surface's area: for any two affine maps
/// the mean of |A x - B x|^2 over them equals that over the surface. They stand for a bone wherever
/// its motions are compared; mm.
std::array<Vec3, 6> moment_points(const geometry::TriangleMesh& mesh);

/// One fixed axis for several motions of a bone.
struct HingeFit {
  Vec3 axis = Vec3::UnitX();  ///< unit; the motion that turns most turns positively about it
  Vec3 point = Vec3::Zero();  ///< on the axis, nearest to where it was looked for, mm
  std::vector<double> angle;  ///< of each motion, rad
  std::vector<double> slide;  ///< of each motion along the axis, mm
  double rms =
      0.0;  ///< of the points' distances from where the motions put them, mm, slides dropped
  bool is_observed = false;
  /// Standard error of the axis: of its tilt in either direction across it, rad. A turn theta with
  /// an error s of the motion's orientation tilts its own axis by s / (2 sin(theta / 2)), so that
  /// small turns say little:
  ///   error = s / sqrt(sum_k w_k),  w_k = (2 sin(theta_k / 2))^2,
  ///   s^2 = max(s0^2, (s0^2 + sum_k w_k off_k^2) / (1 + 2 (K - 1)))
  /// with s0 = kTurnError and off_k the angle from the axis of the k-th of K motions to the fitted
  /// one. 95 of 100 axes lie within kWithin95 times the error of the true one.
  double axis_error = 0.0;
};
/// What registration leaves of the turn between two bones, about each axis: 0.8 degrees of each.
inline constexpr double kTurnError = 0.0197;  // rad
/// Radius that 95 % of a two-dimensional normal distribution lie within, in standard deviations.
inline constexpr double kWithin95 = 2.4477;
/// The axis (u, p), angles and slides that make
///   sum_k sum_i |Rot(u, p, theta_k) x_i + s_k u - M_k x_i|^2 + sum_k (s_k / 20)^2
/// least over the points x_i of the bone that moves. The slides, which a fixed axis doesn't have,
/// are found and dropped as in fit_axis(): an axis without them would tilt to make up for them. A
/// single motion gives fit_axis(). Throws UsageError without motions.
HingeFit fit_hinge(std::span<const geometry::Rigid3> motions, std::span<const Vec3> points,
                   const Vec3& near);

/// Turn from which an axis can be determined in the presence of what registration leaves (about
/// a degree between two bones): then it errs by some 20 degrees.
inline constexpr double kLeastTurn = 0.05;  // rad

}  // namespace palmar::capture
