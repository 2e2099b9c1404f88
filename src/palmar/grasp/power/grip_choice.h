// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar::grasp {

/// How round a whole product is.
struct BodyShape {
  Vec3 centre = Vec3::Zero();                          ///< of gravity, product frame, mm
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< principal frame
  Vec3 extent = Vec3::Zero();                          ///< along the principal axes, mm
  double fill = 0.0;  ///< volume over that of the box of these extents; a ball's is pi/6
};
BodyShape body_shape(const geometry::TriangleMesh& mesh);

/// A ball, an egg, a knob: extents within a third of each other and filled like a ball (0.42 to
/// 0.63; a cylinder as long as thick fills 0.79, a cube 1).
bool is_ball_like(const BodyShape& shape);

/// Above this share of hand length (66 mm for 184 mm) thumb and fingers don't meet round what they
/// hold.
inline constexpr double kLargestClosed = 0.36;

/// The wrap that a girth [mm] is held in. The taxonomy (Feix et al. 2016) draws the line by what
/// fingers do; by Palmar's own hands that happens at these equivalent diameters (girth over pi):
/// below 14 % of hand length (26 mm for 184 mm) the fingertips meet the palm: small diameter; above
/// kLargestClosed: large diameter; medium wrap between.
Grip wrap_for(double girth, double hand_length);

/// Ways through the middle of a rounded body, for a palm on any side of it: a grip site along each
/// principal axis. Empty for an empty mesh.
std::vector<GripSite> ball_sites(const geometry::TriangleMesh& mesh, const BodyShape& shape);

}  // namespace palmar::grasp
