// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/bone_outline.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::capture {
namespace {

BoneOutline outline_along(const std::vector<Vec3>& points, const Vec3& centre,
                          const Eigen::Matrix3d& spread) {
  BoneOutline outline;
  outline.centre = centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  std::array<double, 3> extents{};
  for (int a = 0; a < 3; ++a) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vec3& p : points) {
      const double d = axes.eigenvectors().col(a).dot(p);
      low = std::min(low, d);
      high = std::max(high, d);
    }
    extents[a] = high - low;
    if (a == 2) {
      const Vec3 axis = axes.eigenvectors().col(a);
      outline.ends = {centre + (low - axis.dot(centre)) * axis,
                      centre + (high - axis.dot(centre)) * axis};
    }
  }
  outline.axis = axes.eigenvectors().col(2);
  outline.length = extents[2];
  outline.width = 0.5 * (extents[0] + extents[1]);
  return outline;
}

}  // namespace

BoneOutline outline_of(const geometry::TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return {};
  const Vec3 centre = geometry::centre_of_volume(mesh);
  const std::vector<double> area = geometry::vertex_areas(mesh);
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 d = mesh.vertices[v] - centre;
    spread += area[v] * d * d.transpose();
  }
  return outline_along(mesh.vertices, centre, spread);
}

BoneOutline outline_of(const MarrowRegion& marrow) {
  if (marrow.voxels.empty()) return {};
  Vec3 centre = Vec3::Zero();
  for (const Vec3& p : marrow.voxels) centre += p;
  centre /= static_cast<double>(marrow.voxels.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : marrow.voxels) spread += (p - centre) * (p - centre).transpose();
  BoneOutline outline = outline_along(marrow.voxels, centre, spread);
  outline.length += 2.0 * kCorticalShell;
  outline.width += 2.0 * kCorticalShell;
  return outline;
}

}  // namespace palmar::capture
