// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/packed_field.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::report {
namespace {

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string packed(size, '\0');
  const int status =
      compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()), 9);
  if (status != Z_OK)
    throw Error("report: zlib can't compress " + std::to_string(bytes.size()) + " bytes");
  packed.resize(size);
  return formats::base64(packed);
}

// Small numbers of either sign as small numbers: 0, -1, 1, -2 -> 0, 1, 2, 3.
std::uint16_t zigzag(std::uint16_t difference) {
  const auto value = static_cast<std::int16_t>(difference);
  return static_cast<std::uint16_t>((static_cast<std::uint16_t>(value) << 1) ^
                                    static_cast<std::uint16_t>(value >> 15));
}

}  // namespace

std::string packed_positions(std::span<const Vec3> places) {
  Box3 box;
  for (const Vec3& v : places) box.extend(v);
  const Vec3 low = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
  const double longest = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  const double step = std::max(kPositionStep, longest / 65535.0);
  std::string bytes;
  bytes.reserve(6 * places.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::string fine;
    fine.reserve(places.size());
    std::uint16_t before = 0;
    for (const Vec3& v : places) {
      const auto now = static_cast<std::uint16_t>(std::lround((v[axis] - low[axis]) / step));
      const std::uint16_t code = zigzag(static_cast<std::uint16_t>(now - before));
      bytes += static_cast<char>(code >> 8);
      fine += static_cast<char>(code & 0xff);
      before = now;
    }
    bytes += fine;
  }
  return "{\"low\":[" + exact_number(low.x()) + "," + exact_number(low.y()) + "," +
         exact_number(low.z()) + "],\"step\":" + exact_number(step) + ",\"data\":\"" +
         deflated(bytes) + "\"}";
}

std::string packed_triangles(std::span<const Triangle> triangles) {
  std::vector<int> corners;
  corners.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) corners.insert(corners.end(), t.begin(), t.end());
  return packed_numbers(corners);
}

std::string packed_numbers(std::span<const int> numbers) {
  std::string bytes;
  bytes.reserve(4 * numbers.size());
  std::uint32_t before = 0;
  for (const int number : numbers) {
    const std::uint32_t difference = static_cast<std::uint32_t>(number) - before;
    for (int shift = 0; shift < 32; shift += 8) {
      bytes += static_cast<char>(difference >> shift & 0xffU);
    }
    before = static_cast<std::uint32_t>(number);
  }
  return deflated(bytes);
}

std::string packed_shares(std::span<const double> values, double upper) {
  std::string bytes;
  bytes.reserve(values.size());
  for (const double value : values) {
    const double share = std::isfinite(value) ? std::clamp(value / upper, 0.0, 1.0) : 0.0;
    bytes += static_cast<char>(std::lround(255.0 * share));
  }
  return deflated(bytes);
}

}  // namespace palmar::report
