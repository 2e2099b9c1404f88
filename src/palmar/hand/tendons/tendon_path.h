// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::hand {

/// A point of a tendon that is held by a bone (insertion, pulley, edge of the hood); hand frame,
/// reference posture, mm.
struct TendonPoint {
  int body = 0;
  Vec3 point = Vec3::Zero();
};

/// Cylinder of a joint over which a tendon is drawn when the straight line between two of its
/// points would cut through it. With sense +1 a tendon followed from the palm outwards runs round
/// the axis right-handed.
/// Over a single hinge it also keeps a bowstringing tendon from collapsing: past the angle at which
/// its chord has the largest arm, that arm is kept.
struct TendonCylinder {
  int body = 0;
  Vec3 centre = Vec3::Zero();  ///< on the axis; hand frame, reference posture, mm
  Vec3 axis = Vec3::UnitX();   ///< unit
  double radius = 0.0;         ///< mm
  double sense = 1.0;          ///< +1 or -1
};

/// The way of a tendon between two of its points.
struct TendonSpan {
  TendonPoint proximal, distal;
  std::optional<TendonCylinder> cylinder;
  double share = 1.0;  ///< of the muscle's force that runs here: extensor hood, heads of a muscle
};

/// One muscle's tendon: all its spans that cross joints.
using TendonPath = std::vector<TendonSpan>;

/// Sum of the spans' lengths times their shares, mm. What lies between spans runs along one bone
/// and doesn't change.
double path_length(const TendonPath& path, const PosedDigit& digit);

/// Moment arms r_k = -d(path_length)/d(angle_k), mm/rad = mm: 1 N of muscle force gives r_k N mm in
/// the positive sense of the k-th angle. Exact: a span's ends move with their bones; touching
/// points on a cylinder may be held to it, since the path between them is shortest (Sherman et al.
/// 2013).
std::array<double, kDigitDofs> moment_arms(const TendonPath& path, const PosedDigit& digit);

}  // namespace palmar::hand
