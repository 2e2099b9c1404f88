// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "hands/capture/photo/surface/depth_fusion.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// What the points near a place rest on, means over them.
struct PointSupport {
  double points = 0.0;
  double views = 0.0;                               ///< that agree about a point
  Eigen::Matrix3d patch = Eigen::Matrix3d::Zero();  ///< SurfacePoint::patch, mm^2
};

/// Points in cells of 2 mm, asked for those in the eight cells nearest to a place.
class PointCells {
 public:
  explicit PointCells(const std::vector<SurfacePoint>& points);
  PointSupport near(const Vec3& place) const;

 private:
  std::unordered_map<std::uint64_t, PointSupport> sums_;
};

/// Whether cameras stand at one height: nine tenths of them within 10 degrees of elevation, seen
/// from `middle` over the board. `usual`: the median elevation, deg.
struct CameraHeights {
  bool are_one = false;
  double usual = 0.0;
};
CameraHeights camera_heights(const std::vector<Vec3>& centres, const Vec3& middle);

/// Which vertices photographs measured: two of them see it, points lie there a tenth as densely as
/// usual or more, and enough photographs agree about them: 2.75 in the mean and two fifths of those
/// that see it, from one height three and 45 %; where less than seven photographs (from one height
/// five) see the surface by the median, two that agree will do. Where gloss or a lack of texture
/// lets some agree about a wrong place, those that see it from elsewhere don't. The numbers are our
/// choice: of a shining synthetic hand in 18 photographs from one height they keep 74 % of the
/// vertices, of which 0.2 % are more than 1 mm off (1.6 % of all that have points).
std::vector<char> measured_vertices(const geometry::TriangleMesh& mesh, const PointCells& cells,
                                    const std::vector<float>& density, const std::vector<int>& seen,
                                    bool is_one_height);

}  // namespace palmar::capture
