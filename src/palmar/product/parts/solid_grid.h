// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::product {

struct SolidGridOptions {
  double closing = 6.0;  ///< mm; what a ball of this radius can't enter counts as solid
  int voxels = 250000;   ///< about, in the whole grid
  double finest = 0.8;   ///< mm; smallest voxel
};

/// Where the grid's frame stands in the product's. Its axes are orthonormal; of a mirrored product
/// they are mirrored, too, so they may be left-handed.
struct GridFrame {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 origin = Vec3::Zero();  ///< mm

  Vec3 operator*(const Vec3& in_grid) const { return origin + axes * in_grid; }
  Vec3 to_grid(const Vec3& in_product) const { return axes.transpose() * (in_product - origin); }
};

/// A product as voxels in a frame of its own: the principal directions that its surface faces,
/// about the middle of its box there. The axes point to where the surface reaches farther (third
/// moment), so a product that is moved, turned or mirrored has the same voxels in the same order,
/// but for rounding.
struct SolidGrid {
  GridFrame product_from_grid;
  double spacing = 1.0;                 ///< mm
  std::array<int, 3> size = {0, 0, 0};  ///< voxels; i runs fastest. The border is always air.
  std::vector<std::uint8_t> is_solid;
  std::vector<float> depth;  ///< mm from a voxel's centre to the surface; 0 in air
  std::vector<float> air;    ///< mm from a voxel's centre to the nearest solid one; 0 in the solid

  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) * (j + static_cast<std::size_t>(size[1]) * k);
  }
  std::array<int, 3> voxel(std::size_t index) const {
    const auto n = static_cast<int>(index);
    return {n % size[0], n / size[0] % size[1], n / size[0] / size[1]};
  }
  /// Centre of a voxel in the grid's frame, mm.
  Vec3 centre(std::size_t index) const;
  /// `depth` between voxel centres, trilinear; point in the grid's frame.
  double depth_at(const Vec3& point) const;
};

/// Fills what a hand takes for solid: the inside by the sign of the crossings along three axes
/// (majority), thin walls, gaps and tunnels narrower than a finger (`closing`), voids, and the
/// pockets of dishes, cups and tubes: what the outline of a slice encloses and what is open on one
/// side only or on little of its surface. The opening of a handle is open on two wide sides and
/// stays. Works on open and
/// crossing meshes. A mesh without triangles gives an empty grid.
SolidGrid make_solid_grid(const geometry::TriangleMesh& mesh, const SolidGridOptions& options = {});

}  // namespace palmar::product
