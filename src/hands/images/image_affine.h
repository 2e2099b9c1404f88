// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <string>
#include <string_view>
#include <vector>

#include "hands/imaging/volume.h"

namespace palmar::images {

/// Sets spacing, axes and origin from the steps of i, j, k and the first voxel's place (columns,
/// mm, patient frame). Throws InputError that begins with `name` if they are no right-angled grid.
void set_affine(imaging::VolumeGrid& grid, const Eigen::Matrix<double, 3, 4>& affine,
                const std::string& name);

enum class StoredType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
std::size_t size_of(StoredType type);

/// How a file's values are written: value = slope stored + intercept.
struct StoredValues {
  StoredType type = StoredType::kFloat32;
  std::endian order = std::endian::little;
  double slope = 1.0, intercept = 0.0;
};

/// grid.count() values. Throws InputError that begins with `name` if bytes are missing or a value
/// isn't finite.
std::vector<float> decode_values(std::string_view bytes, const imaging::VolumeGrid& grid,
                                 const StoredValues& stored, const std::string& name);

}  // namespace palmar::images
