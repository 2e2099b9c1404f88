// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/fat_shift.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr std::size_t kFewest = 5;  // bones

/// Least squares of one bone: the slope of its thickness over its normals.
Vec3 slope_of(const LayerFit& bone) {
  const std::vector<Vec3> normals = geometry::vertex_normals(bone.mesh);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (std::size_t v = 0; v < normals.size(); ++v) {
    const Eigen::Vector4d row(normals[v].x(), normals[v].y(), normals[v].z(), 1.0);
    sum += row * row.transpose();
    right += bone.thickness[v] * row;
  }
  return sum.ldlt().solve(right).head<3>();
}

}  // namespace

Vec3 fat_shift(const std::vector<LayerFit>& bones) {
  std::array<std::vector<double>, 3> slope;
  for (const LayerFit& bone : bones) {
    if (bone.mesh.vertices.size() < 4) continue;
    const Vec3 own = slope_of(bone);
    if (!own.allFinite()) continue;
    for (int k = 0; k < 3; ++k) slope[k].push_back(own[k]);
  }
  if (slope[0].size() < kFewest) return Vec3::Zero();
  return -Vec3(statistics::median(slope[0]), statistics::median(slope[1]),
               statistics::median(slope[2])) /
         kFatShiftShown;
}

Vec3 signed_fat_shift(const Vec3& stated, const Vec3& seen) {
  constexpr double kLeastSeen = 0.3, kLeastShare = 1.0 / 3.0;  // mm; of what is stated
  const double size = stated.norm();
  if (size == 0.0) return seen.norm() < kLeastSeen ? Vec3::Zero() : seen;
  const double along = seen.dot(stated) / size;
  if (std::abs(along) < std::max(kLeastSeen, kLeastShare * size)) return Vec3::Zero();
  return along > 0.0 ? stated : -stated;
}

}  // namespace palmar::capture
