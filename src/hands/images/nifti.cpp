// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "hands/images/dicom_slice.h"
#include "hands/images/image_affine.h"
#include "hands/images/image_formats.h"
#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"

namespace palmar::images {
namespace {

constexpr std::size_t kHeaderBytes = 348;

/// Offsets of nifti1.h.
enum Offset : std::size_t {
  kDim = 40,
  kDatatype = 70,
  kPixdim = 76,
  kVoxOffset = 108,
  kSlope = 112,
  kInter = 116,
  kUnits = 123,
  kQformCode = 252,
  kSformCode = 254,
  kQuatern = 256,
  kQoffset = 268,
  kSrow = 280,
  kMagic = 344
};

struct Header {
  std::string_view bytes;
  std::endian order = std::endian::little;
  template <typename T>
  T at(std::size_t offset, int index = 0) const {
    return formats::read_value<T>(bytes, offset + sizeof(T) * static_cast<std::size_t>(index),
                                  order);
  }
};

StoredType type_of(int code, const std::string& name) {
  switch (code) {
    case 2:
      return StoredType::kUint8;
    case 256:
      return StoredType::kInt8;
    case 4:
      return StoredType::kInt16;
    case 512:
      return StoredType::kUint16;
    case 8:
      return StoredType::kInt32;
    case 768:
      return StoredType::kUint32;
    case 16:
      return StoredType::kFloat32;
    case 64:
      return StoredType::kFloat64;
    case 128:
    case 2304:
      throw InputError(name + ": is a colour image; grey values are required");
    default:
      throw InputError(fmt::format("{}: values of NIfTI type {} aren't read", name, code));
  }
}

/// Columns: steps of i, j, k and the first voxel's place, in NIfTI's frame (x right, y front).
Eigen::Matrix<double, 3, 4> affine_of(const Header& header, ImageFile& file) {
  Eigen::Matrix<double, 3, 4> affine;
  if (header.at<std::int16_t>(kSformCode) > 0) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 4; ++c) affine(r, c) = header.at<float>(kSrow, 4 * r + c);
    }
    return affine;
  }
  const Vec3 step(header.at<float>(kPixdim, 1), header.at<float>(kPixdim, 2),
                  header.at<float>(kPixdim, 3));
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Vec3 origin = Vec3::Zero();
  if (header.at<std::int16_t>(kQformCode) > 0) {
    const Vec3 v(header.at<float>(kQuatern), header.at<float>(kQuatern, 1),
                 header.at<float>(kQuatern, 2));
    const double w = std::sqrt(std::max(0.0, 1.0 - v.squaredNorm()));
    axes = Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized().toRotationMatrix();
    if (header.at<float>(kPixdim) < 0.0F) axes.col(2) = -axes.col(2);  // qfac
    for (int a = 0; a < 3; ++a) origin[a] = header.at<float>(kQoffset, a);
  } else {
    file.notes.push_back("the file doesn't say how the image is oriented in the patient");
  }
  affine << axes * step.asDiagonal(), origin;
  return affine;
}

template <typename T>
void put(std::string& bytes, std::size_t offset, T value) {
  std::string raw;
  formats::append_value(raw, value);
  bytes.replace(offset, raw.size(), raw);
}

}  // namespace

ImageFile read_nifti(std::string_view bytes, const std::string& name) {
  const bool is_packed = bytes.starts_with("\x1f\x8b");
  const std::string head =
      is_packed ? gunzip(bytes, kHeaderBytes, name) : std::string(bytes.substr(0, kHeaderBytes));
  if (head.size() < kHeaderBytes || head.substr(kMagic, 2) != "n+") {
    throw InputError(
        fmt::format("{}: is no NIfTI-1 image in one file{}", name,
                    head.size() >= 8 && head.substr(4, 2) == "n+" ? " (NIfTI-2 isn't read)" : ""));
  }
  Header header{head};
  if (header.at<std::int32_t>(0) != static_cast<std::int32_t>(kHeaderBytes)) {
    header.order = std::endian::big;
    if (header.at<std::int32_t>(0) != static_cast<std::int32_t>(kHeaderBytes)) {
      throw InputError(fmt::format("{}: byte 0: the header's size isn't 348", name));
    }
  }
  const int dimensions = header.at<std::int16_t>(kDim);
  if (dimensions < 3 || dimensions > 7) {
    throw InputError(fmt::format("{}: byte 40: {} dimensions; 3 are required", name, dimensions));
  }
  for (int d = 4; d <= dimensions; ++d) {
    if (header.at<std::int16_t>(kDim, d) > 1) {
      throw InputError(fmt::format("{}: holds {} images in dimension {}; one is required", name,
                                   header.at<std::int16_t>(kDim, d), d));
    }
  }
  ImageFile file;
  file.description = std::filesystem::path(name).filename().string();
  imaging::VolumeGrid& grid = file.image.grid;
  for (int a = 0; a < 3; ++a) {
    grid.size[static_cast<std::size_t>(a)] = header.at<std::int16_t>(kDim, a + 1);
  }
  check_image_size(name, grid.size[0], grid.size[1], grid.size[2]);

  Eigen::Matrix<double, 3, 4> affine = affine_of(header, file);
  const int unit = header.at<std::uint8_t>(kUnits) & 7;
  if (unit == 1) affine *= 1000.0;  // m
  if (unit == 3) affine *= 0.001;   // micrometres
  if (unit == 0) file.notes.push_back("the file names no unit of length; mm is assumed");
  affine.topRows<2>() *= -1.0;
  set_affine(grid, affine, name);

  StoredValues values;
  values.type = type_of(header.at<std::int16_t>(kDatatype), name);
  values.order = header.order;
  const float slope = header.at<float>(kSlope);
  if (slope != 0.0F) {
    values.slope = slope;
    values.intercept = header.at<float>(kInter);
  }
  const double start = header.at<float>(kVoxOffset);
  if (!(start >= 348.0 && start < 1e9)) {
    throw InputError(fmt::format("{}: byte 108: values begin at byte {:g}", name, start));
  }
  const auto offset = static_cast<std::size_t>(start);
  const std::size_t needed = offset + grid.count() * size_of(values.type);
  const std::string unpacked = is_packed ? gunzip(bytes, needed, name) : std::string();
  const std::string_view all = is_packed ? std::string_view(unpacked) : bytes;
  file.image.value = decode_values(all.size() > offset ? all.substr(offset) : std::string_view(),
                                   grid, values, name);
  return file;
}

std::string nifti_bytes(const imaging::Volume& image, bool compress) {
  const imaging::VolumeGrid& grid = image.grid;
  std::string bytes(352, '\0');
  put(bytes, 0, std::int32_t{348});
  put(bytes, kDim, std::int16_t{3});
  for (std::size_t a = 0; a < 7; ++a) {
    put(bytes, kDim + 2 * (a + 1), static_cast<std::int16_t>(a < 3 ? grid.size[a] : 1));
  }
  put(bytes, kDatatype, std::int16_t{16});
  put(bytes, kDatatype + 2, std::int16_t{32});
  Eigen::Matrix3d axes = grid.axes;
  axes.topRows<2>() *= -1.0;
  Vec3 origin = grid.origin;
  origin.head<2>() *= -1.0;
  const double handed = axes.determinant() < 0.0 ? -1.0 : 1.0;
  put(bytes, kPixdim, static_cast<float>(handed));
  for (int a = 0; a < 3; ++a) {
    put(bytes, kPixdim + 4 * static_cast<std::size_t>(a + 1), static_cast<float>(grid.spacing[a]));
  }
  put(bytes, kVoxOffset, 352.0F);
  put(bytes, kSlope, 1.0F);
  put(bytes, kUnits, std::uint8_t{2});
  put(bytes, kQformCode, std::int16_t{1});
  put(bytes, kSformCode, std::int16_t{1});
  Eigen::Matrix3d rotation = axes;
  rotation.col(2) *= handed;
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  for (int a = 0; a < 3; ++a) {
    const auto offset = 4 * static_cast<std::size_t>(a);
    put(bytes, kQuatern + offset, static_cast<float>(q.vec()[a]));
    put(bytes, kQoffset + offset, static_cast<float>(origin[a]));
    for (int c = 0; c < 4; ++c) {
      const double value = c < 3 ? axes(a, c) * grid.spacing[c] : origin[a];
      put(bytes, kSrow + 4 * static_cast<std::size_t>(4 * a + c), static_cast<float>(value));
    }
  }
  bytes.replace(kMagic, 4, std::string_view("n+1\0", 4));
  for (const float value : image.value) formats::append_value(bytes, value);
  return compress ? gzip(bytes) : bytes;
}

}  // namespace palmar::images
