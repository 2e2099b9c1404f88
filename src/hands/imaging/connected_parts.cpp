// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/connected_parts.h"

#include <algorithm>
#include <array>
#include <string>

#include "palmar/core/error.h"

namespace palmar::imaging {
namespace {

/// Joined labels; the smaller one wins.
class JoinedLabels {
 public:
  std::int32_t make() {
    parent_.push_back(static_cast<std::int32_t>(parent_.size()));
    return parent_.back();
  }
  std::int32_t root(std::int32_t label) {
    while (parent(label) != label) {
      parent_[label] = parent(parent(label));
      label = parent(label);
    }
    return label;
  }
  void join(std::int32_t a, std::int32_t b) {
    a = root(a);
    b = root(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }
  std::size_t count() const { return parent_.size(); }

 private:
  std::int32_t parent(std::int32_t label) const { return parent_[label]; }
  std::vector<std::int32_t> parent_;
};

}  // namespace

int ConnectedParts::largest() const {
  if (voxels.empty()) return -1;
  return static_cast<int>(std::max_element(voxels.begin(), voxels.end()) - voxels.begin());
}

ConnectedParts connected_parts(const VolumeGrid& grid, const VoxelMask& mask,
                               Neighbourhood neighbourhood) {
  if (mask.size() != grid.count()) {
    throw UsageError("mask has " + std::to_string(mask.size()) + " values, the grid " +
                     std::to_string(grid.count()) + " voxels");
  }
  // Neighbours that come before a voxel.
  std::vector<std::array<int, 3>> before;
  for (int k = -1; k <= 0; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (k == 0 && (j > 0 || (j == 0 && i >= 0))) continue;
        const int steps = (k != 0) + (j != 0) + (i != 0);
        if (neighbourhood == Neighbourhood::kFaces && steps > 1) continue;
        before.push_back({i, j, k});
      }
    }
  }
  ConnectedParts parts;
  parts.part.assign(mask.size(), -1);
  JoinedLabels labels;
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        if (mask[v] == 0) continue;
        std::int32_t label = -1;
        for (const auto& [di, dj, dk] : before) {
          const int x = i + di, y = j + dj, z = k + dk;
          if (x < 0 || y < 0 || z < 0 || x >= grid.size[0] || y >= grid.size[1]) continue;
          const std::int32_t other = parts.part[grid.at(x, y, z)];
          if (other < 0) continue;
          if (label < 0) {
            label = other;
          } else if (label != other) {
            labels.join(label, other);
          }
        }
        parts.part[v] = label >= 0 ? label : labels.make();
      }
    }
  }
  std::vector<std::int32_t> number(labels.count(), -1);
  for (std::int32_t& label : parts.part) {
    if (label < 0) continue;
    std::int32_t& n = number[labels.root(label)];
    if (n < 0) {
      n = static_cast<std::int32_t>(parts.voxels.size());
      parts.voxels.push_back(0);
    }
    label = n;
    ++parts.voxels[n];
  }
  return parts;
}

VoxelMask mask_of(const ConnectedParts& parts, int part) {
  VoxelMask mask(parts.part.size());
  for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = parts.part[v] == part ? 1 : 0;
  return mask;
}

}  // namespace palmar::imaging
