// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/grasp.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

inline constexpr double kPadOffset = 3.0;  // mm off the surface, where its distance is smooth

/// Two points of a product that fingers could press from opposite sides. Product frame, mm.
struct OpposingPair {
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  Vec3 normal_a = Vec3::UnitZ(), normal_b = Vec3::UnitZ();  ///< unit, out of the product
  double angle = 0.0;  ///< worst of both normals and a - b, rad
  double cost = 0.0;   ///< how far from where people take such a thing; smaller is better

  Vec3 middle() const { return 0.5 * (a + b); }
  double width() const { return (a - b).norm(); }
};

/// What matters of a product's shape for where it is pinched. Product frame, mm.
struct PinchShape {
  Vec3 centre = Vec3::Zero();  ///< of volume
  /// Principal axes, largest spread first. Signs, and directions among axes of equal spread, are
  /// those of the farthest vertex, so that they turn and mirror with the product; left-handed at
  /// times.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();  ///< extents along them from the centre
  bool is_pen = false;                              ///< long and thin: taken near one end
  std::vector<Vec3> tips;  ///< ends of the pen that write: one, or both if they look alike
  /// Axes about which it is as broad one way as the other (within a tenth): of a lid, a knob, a
  /// jar. The shortest axis of something that is round about none.
  std::vector<Vec3> disc_axes;
};
PinchShape pinch_shape(const geometry::TriangleMesh& mesh);

struct OpposingOptions {
  double widest = 80.0;       ///< mm between the points
  double comfortable = 60.0;  ///< mm; wider costs
  double central = 1.0;       ///< weight of being near the centre (a pen: near the tip)
  int most = 200;             ///< pairs to return
  int points = 300;           ///< of the surface, each of which looks for what is opposite
  std::optional<Vec3> at;     ///< stay near this point instead
  std::vector<Vec3> places;   ///< stay near one of these; empty: the centre (a pen: near the tip)
};

/// Antipodal pairs (both normals within 35 degrees of the line through them), cheapest first.
/// Points spread evenly over the surface each look straight in for the first and the last
/// surface behind. Normals are means over a pad: taken from the distance 3 mm off the surface;
/// points where that differs from the triangle's by more than 25 degrees lie on an edge and are
/// left out. The same for a moved, turned or mirrored product.
///
/// With a place asked for, points are spread over what is within 40 mm of it, and 20 mm stand for
/// 50 in the cost.
///
///     cost = central (|m - c| / 50 mm)^2 + (angle / 20 deg)^2 + (width beyond comfortable / 20)^2
///            + (w / 2 R)^2 / 2
///
/// The last term: a thing of width w between two fingertips rolls over the more easily the smaller
/// the radius R of its surface there. Flat faces: 0; across a round bar: 1/2.
std::vector<OpposingPair> find_opposing_pairs(const product::Product& product,
                                              const PinchShape& shape,
                                              const OpposingOptions& options);

/// Points spread over a mesh, no two nearer than about sqrt(area / count); with their triangles'
/// normals. The same for a moved, turned or mirrored mesh.
struct SurfacePoint {
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
};
std::vector<SurfacePoint> spread_points(const geometry::TriangleMesh& mesh, int count);

}  // namespace palmar::grasp
