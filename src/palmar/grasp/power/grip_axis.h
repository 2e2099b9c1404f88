// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::grasp {

// Kong & Lowe 2005 (Int J Industrial Ergonomics 35:495-507): handles of 19.7 % of hand length are
// the most comfortable. How much worse others are was measured for some diameters only; the
// log-normal spreads are our choice: hands open further than they close.
inline constexpr double kBestDiameter = 0.197;  // of hand length
inline constexpr double kThinSpread = 0.5, kThickSpread = 0.6;

/// A place where a power grip could take a product. Product frame, mm.
struct GripSite {
  Vec3 point = Vec3::Zero();  ///< centre of the section in the middle of the gripped length
  Vec3 axis = Vec3::UnitX();  ///< unit, along the handle, towards the working end (thumb side)
  Vec3 wide = Vec3::UnitY();  ///< unit, the wider direction of the section
  double girth = 0.0;         ///< convex perimeter of the section, mm
  double thickness = 0.0;     ///< smallest width of the section, mm
  double width = 0.0;         ///< its extent across the thickness, mm
  double wall = 1e3;          ///< how thick the solid is under the grip's surface (hollow products:
                              ///< the wall), mm; filled by wall_at()
  double length = 0.0;        ///< length along the axis over which it is handle-like, mm
  double ahead = 1e3;         ///< from the point to the product's end on the thumb side, mm
  std::optional<Vec3> nose;   ///< unit, across the axis: where the working end sticks out
  double score = 0.0;         ///< how handle-like it is, 0 to 1
};

struct GripSearchOptions {
  double hand_length = 190.0;  ///< L, mm
  double palm_breadth = 85.0;  ///< W: what a power grip covers of a handle, mm
  std::optional<Vec3> near;  ///< only sites with this point beside them (product frame, mm), or ...
  std::optional<Vec3> at;    ///< ... with this point on the axis, mm ...
  std::optional<Vec3> axis;  ///< ... or along this direction
};

/// Finds where a person would take a product in a power grip, best first; empty if no part of it
/// is bar-like.
///
/// The product is cut by stacks of planes in about thirty directions laid out in its own principal
/// frame, so that turning the product turns the answer. Outlines that follow each other with little
/// taper form bars; a bar is straightened along its own centre line. Its score is the product of
///
///     girth      log-normal about 19.7 % of hand length as equivalent diameter (Kong & Lowe 2005)
///     coverage   share of the four fingers' breadth that the bar fills, squared
///     roundness  thickness / width of the section, full from 1/2 to 0.8; a little less when quite
///                round (barrels, shafts and mallet heads are; handles mostly are not)
///     straight   how far the centre line bends within the palm breadth
///     place      near the centre of gravity if that lies in the bar, else (a tool with a heavy
///                head) far from it
///
/// The axis points to the side on which more of the product lies beyond the hand.
std::vector<GripSite> find_grip_sites(const geometry::TriangleMesh& mesh,
                                      const GripSearchOptions& options = {});

/// Principal frame of a mesh's surface: columns of a right-handed rotation, largest spread first,
/// signs from the third moments; so it moves along with the mesh. Arbitrary within a symmetry.
struct PrincipalFrame {
  Vec3 centre = Vec3::Zero();  ///< of gravity of the enclosed volume (of the surface if open), mm
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};
PrincipalFrame principal_frame(const geometry::TriangleMesh& mesh);

}  // namespace palmar::grasp
