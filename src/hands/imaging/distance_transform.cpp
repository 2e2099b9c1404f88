// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/distance_transform.h"

#include <cmath>
#include <limits>
#include <string>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::imaging {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// One line of the transform: out(q) = min over p of (spacing (q - p))^2 + f(p).
class ParabolaEnvelope {
 public:
  explicit ParabolaEnvelope(std::size_t length) : foot_(length), from_(length + 1) {}

  template <typename Read, typename Write>
  void run(std::size_t length, double spacing, const Read& read, const Write& write) {
    const double weight = spacing * spacing;
    std::size_t count = 0;
    for (std::size_t q = 0; q < length; ++q) {
      const double height = read(q);
      if (height == kInfinite) continue;
      double start = -kInfinite;
      while (count > 0) {
        const auto p = static_cast<double>(foot_[count - 1]), at = static_cast<double>(q);
        start = (height - read(foot_[count - 1]) + weight * (at * at - p * p)) /
                (2.0 * weight * (at - p));
        if (start > from_[count - 1]) break;
        --count;
        start = -kInfinite;
      }
      foot_[count] = q;
      from_[count] = start;
      ++count;
    }
    if (count == 0) return;
    values_.resize(length);
    std::size_t k = 0;
    for (std::size_t q = 0; q < length; ++q) {
      while (k + 1 < count && from_[k + 1] < static_cast<double>(q)) ++k;
      const double steps = static_cast<double>(q) - static_cast<double>(foot_[k]);
      values_[q] = weight * steps * steps + read(foot_[k]);
    }
    for (std::size_t q = 0; q < length; ++q) write(q, values_[q]);
  }

 private:
  std::vector<std::size_t> foot_;
  std::vector<double> from_, values_;
};

void check_size(const VolumeGrid& grid, const VoxelMask& mask) {
  if (mask.size() != grid.count()) {
    throw UsageError("mask has " + std::to_string(mask.size()) + " values, the grid " +
                     std::to_string(grid.count()) + " voxels");
  }
}

VoxelMask inverse(const VoxelMask& mask) {
  VoxelMask other(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) other[v] = mask[v] == 0 ? 1 : 0;
  return other;
}

}  // namespace

std::vector<float> distance_transform(const VolumeGrid& grid, const VoxelMask& mask) {
  check_size(grid, mask);
  std::vector<float> square(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) {
    square[v] = mask[v] != 0 ? 0.0F : std::numeric_limits<float>::infinity();
  }
  const std::array<std::size_t, 3> size = {static_cast<std::size_t>(grid.size[0]),
                                           static_cast<std::size_t>(grid.size[1]),
                                           static_cast<std::size_t>(grid.size[2])};
  const std::array<std::size_t, 3> stride = {1, size[0], size[0] * size[1]};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // One task per line of the slower of the two other axes.
    const std::size_t fast = axis == 0 ? 1 : 0, slow = axis == 2 ? 1 : 2;
    parallel_for(static_cast<int>(size[slow]), [&](int task) {
      ParabolaEnvelope envelope(size[axis]);
      for (std::size_t n = 0; n < size[fast]; ++n) {
        const std::size_t base = static_cast<std::size_t>(task) * stride[slow] + n * stride[fast];
        envelope.run(
            size[axis], grid.spacing[static_cast<Eigen::Index>(axis)],
            [&](std::size_t q) { return static_cast<double>(square[base + q * stride[axis]]); },
            [&](std::size_t q, double d) {
              square[base + q * stride[axis]] = static_cast<float>(d);
            });
      }
    });
  }
  for (float& d : square) d = std::sqrt(d);
  return square;
}

VoxelMask dilated(const VolumeGrid& grid, const VoxelMask& mask, double radius) {
  const std::vector<float> distance = distance_transform(grid, mask);
  VoxelMask grown(mask.size());
  for (std::size_t v = 0; v < mask.size(); ++v) {
    grown[v] = static_cast<double>(distance[v]) <= radius ? 1 : 0;
  }
  return grown;
}

VoxelMask eroded(const VolumeGrid& grid, const VoxelMask& mask, double radius) {
  check_size(grid, mask);
  return inverse(dilated(grid, inverse(mask), radius));
}

VoxelMask opened(const VolumeGrid& grid, const VoxelMask& mask, double radius) {
  return dilated(grid, eroded(grid, mask, radius), radius);
}

VoxelMask closed(const VolumeGrid& grid, const VoxelMask& mask, double radius) {
  return eroded(grid, dilated(grid, mask, radius), radius);
}

}  // namespace palmar::imaging
