// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/image_edge.h"

#include <algorithm>
#include <limits>

#include "palmar/geometry/distance/closest_point.h"

namespace palmar::capture {
namespace {

bool is_at_edge(const Vec3& voxel, const imaging::VolumeGrid& grid) {
  for (int a = 0; a < 3; ++a) {
    const double last = grid.size[a] - 1.0;
    if (voxel[a] < 1.0 || voxel[a] > last - 1.0) return true;
  }
  return false;
}

}  // namespace

void mark_cut_fingers(ScanSurfaces& surfaces, const imaging::VolumeGrid& grid) {
  std::vector<geometry::ClosestPointQuery> bones;
  for (const ScannedBone& bone : surfaces.bones) bones.emplace_back(bone.mesh);
  for (const Vec3& vertex : surfaces.skin.vertices) {
    if (!is_at_edge(grid.to_voxel(vertex), grid)) continue;
    double least = std::numeric_limits<double>::infinity();
    std::size_t nearest = bones.size();
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const auto at = bones[b].closest(vertex, least);
      if (!at) continue;
      least = at->distance;
      nearest = b;
    }
    if (nearest < bones.size()) surfaces.bones[nearest].is_cut = true;
  }
}

std::vector<std::string> cut_bones_of_fingers(const ScanSurfaces& surfaces) {
  std::vector<std::string> cut;
  for (const ScannedBone& bone : surfaces.bones) {
    const bool is_of_finger = bone.name.ends_with("_phalanx") || bone.name.ends_with("_metacarpal");
    if (bone.is_cut && is_of_finger) cut.push_back(bone.name);
  }
  return cut;
}

}  // namespace palmar::capture
