// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/capture/palm_placement.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "palmar/geometry/icp.h"
#include "palmar/geometry/mesh_measures.h"

namespace palmar {
namespace {

constexpr std::array<std::string_view, 6> kPalm{"index_metacarpal", "middle_metacarpal",
                                                "ring_metacarpal",  "trapezoid",
                                                "capitate",         "little_metacarpal"};
constexpr std::size_t kSteady = 2;  // the first ones hold the palm; the others help to begin

const ScannedBone* bone_named(const ScanSurfaces& scan, std::string_view name) {
  for (const ScannedBone& bone : scan.bones) {
    if (bone.name == name) return &bone;
  }
  return nullptr;
}

void append(TriangleMesh& mesh, const TriangleMesh& more) {
  const int first = mesh.vertex_count();
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const Triangle& t : more.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

/// Least-squares motion between paired points (Kabsch 1976).
Rigid3 motion_between(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
  Vec3 middle = Vec3::Zero(), target = Vec3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    middle += from[i] / static_cast<double>(from.size());
    target += to[i] / static_cast<double>(from.size());
  }
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    cross += (to[i] - target) * (from[i] - middle).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) *= -1.0;
  Rigid3 motion;
  motion.rotation = Quat(Eigen::Matrix3d(u * svd.matrixV().transpose()));
  motion.translation = target - motion.rotation * middle;
  return motion;
}

}  // namespace

std::optional<Rigid3> place_palm(const ScanSurfaces& reference, const ScanSurfaces& posture) {
  std::vector<Vec3> from, to;
  TriangleMesh moving, fixed;
  for (std::size_t b = 0; b < kPalm.size(); ++b) {
    const ScannedBone* mine = bone_named(reference, kPalm[b]);
    const ScannedBone* theirs = bone_named(posture, kPalm[b]);
    if (mine == nullptr || theirs == nullptr || mine->is_cut || theirs->is_cut) continue;
    from.push_back(centre_of_volume(mine->mesh));
    to.push_back(centre_of_volume(theirs->mesh));
    if (b >= kSteady && !moving.vertices.empty()) continue;
    append(moving, mine->mesh);
    append(fixed, theirs->mesh);
  }
  constexpr std::size_t kFewest = 3;  // middles that hold a motion
  if (from.size() < kFewest) return std::nullopt;
  const Rigid3 start = motion_between(from, to);
  return register_rigidly(moving, fixed, start, {.start_turn = 0.0}).fixed_from_moving;
}

}  // namespace palmar
