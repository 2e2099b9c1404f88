// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/image_affine.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"

namespace palmar::images {

void set_affine(imaging::VolumeGrid& grid, const Eigen::Matrix<double, 3, 4>& affine,
                const std::string& name) {
  if (!affine.allFinite()) throw InputError(name + ": its place in space holds NaN or infinity");
  for (int a = 0; a < 3; ++a) {
    const double step = affine.col(a).norm();
    if (!(step >= 0.01 && step <= 100.0)) {
      throw InputError(
          fmt::format("{}: voxels are {:g} mm apart along {}; 0.01 to 100 mm are allowed", name,
                      step, "ijk"[a]));
    }
    grid.spacing[a] = step;
    grid.axes.col(a) = affine.col(a) / step;
  }
  const Eigen::Matrix3d product = grid.axes.transpose() * grid.axes;
  const double skew = (product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (skew > 1e-3) {  // cosine; floats in files leave 1e-6
    throw InputError(fmt::format("{}: axes aren't square, by {:.2f} degrees", name,
                                 std::asin(std::min(1.0, skew)) * 180.0 / std::acos(-1.0)));
  }
  // Square to rounding; k keeps its side.
  const double handed = grid.axes.determinant() < 0.0 ? -1.0 : 1.0;
  grid.axes.col(0).normalize();
  grid.axes.col(1) =
      (grid.axes.col(1) - grid.axes.col(0).dot(grid.axes.col(1)) * grid.axes.col(0)).normalized();
  grid.axes.col(2) = handed * grid.axes.col(0).cross(grid.axes.col(1));
  grid.origin = affine.col(3);
  if (grid.origin.cwiseAbs().maxCoeff() > 1e5) {
    throw InputError(fmt::format("{}: its first voxel is {:g} mm away from the origin", name,
                                 grid.origin.norm()));
  }
}

std::size_t size_of(StoredType type) {
  switch (type) {
    case StoredType::kInt8:
    case StoredType::kUint8:
      return 1;
    case StoredType::kInt16:
    case StoredType::kUint16:
      return 2;
    case StoredType::kFloat64:
      return 8;
    default:
      return 4;
  }
}

namespace {

template <typename T>
std::vector<float> decode(std::string_view bytes, std::size_t count, const StoredValues& stored) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = static_cast<float>(stored.slope * static_cast<double>(formats::read_value<T>(
                                                      bytes, i * sizeof(T), stored.order)) +
                                   stored.intercept);
  }
  return values;
}

std::vector<float> decode(std::string_view bytes, std::size_t count, const StoredValues& stored) {
  switch (stored.type) {
    case StoredType::kInt8:
      return decode<std::int8_t>(bytes, count, stored);
    case StoredType::kUint8:
      return decode<std::uint8_t>(bytes, count, stored);
    case StoredType::kInt16:
      return decode<std::int16_t>(bytes, count, stored);
    case StoredType::kUint16:
      return decode<std::uint16_t>(bytes, count, stored);
    case StoredType::kInt32:
      return decode<std::int32_t>(bytes, count, stored);
    case StoredType::kUint32:
      return decode<std::uint32_t>(bytes, count, stored);
    case StoredType::kFloat64:
      return decode<double>(bytes, count, stored);
    default:
      return decode<float>(bytes, count, stored);
  }
}

}  // namespace

std::vector<float> decode_values(std::string_view bytes, const imaging::VolumeGrid& grid,
                                 const StoredValues& stored, const std::string& name) {
  const std::size_t needed = grid.count() * size_of(stored.type);
  if (bytes.size() < needed) {
    throw InputError(fmt::format("{}: is cut off: {} x {} x {} voxels need {} bytes, {} are there",
                                 name, grid.size[0], grid.size[1], grid.size[2], needed,
                                 bytes.size()));
  }
  std::vector<float> values = decode(bytes, grid.count(), stored);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(values[i])) continue;
    const auto width = static_cast<std::size_t>(grid.size[0]);
    const auto height = static_cast<std::size_t>(grid.size[1]);
    throw InputError(fmt::format("{}: the value of voxel ({}, {}, {}) is {}", name, i % width,
                                 i / width % height, i / width / height, values[i]));
  }
  return values;
}

}  // namespace palmar::images
