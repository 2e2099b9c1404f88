// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/picture/packed_field.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace palmar::report {
namespace {

/// What a browser does: base64, then zlib.
std::string unpacked(const std::string& text, std::size_t size) {
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xffU);
  }
  std::string result(size, '\0');
  uLongf length = size;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(result.data()), &length,
                       reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  EXPECT_EQ(length, size);
  return result;
}

unsigned byte_at(const std::string& bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

TEST(PackedPositions, ComeBackWithinHalfAStep) {
  std::vector<Vec3> places;
  for (int i = 0; i < 200; ++i) {
    places.emplace_back(90.0 * std::sin(0.3 * i), -150.0 + 1.7 * i, 40.0 * std::cos(1.9 * i));
  }
  const auto json = nlohmann::json::parse(packed_positions(places));
  const double step = json.at("step");
  EXPECT_DOUBLE_EQ(step, kPositionStep);
  const std::string bytes = unpacked(json.at("data"), 6 * places.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    unsigned now = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t high = 2 * axis * places.size() + i;
      const unsigned code = byte_at(bytes, high) << 8 | byte_at(bytes, high + places.size());
      const int difference = static_cast<int>(code >> 1) ^ -static_cast<int>(code & 1U);
      now = (now + static_cast<unsigned>(difference)) & 0xffffU;
      const double value = json.at("low").at(axis).get<double>() + step * now;
      EXPECT_NEAR(value, places[i][static_cast<Eigen::Index>(axis)], 0.5 * step + 1e-9);
    }
  }
}

TEST(PackedPositions, LargeMeshesTakeLargerSteps) {
  const std::vector<Vec3> places = {Vec3::Zero(), Vec3(3000.0, 0.0, 0.0)};
  const auto json = nlohmann::json::parse(packed_positions(places));
  EXPECT_DOUBLE_EQ(json.at("step"), 3000.0 / 65535.0);  // mm
  EXPECT_NO_THROW(packed_positions({}));
}

TEST(PackedShares, AreHeldBetweenNothingAndTheScalesEnd) {
  const std::vector<double> values = {0.0, 0.35, 0.7, 9.0, -1.0, std::nan("")};
  const std::string bytes = unpacked(packed_shares(values, 0.7), values.size());
  const unsigned expected[] = {0, 128, 255, 255, 0, 0};
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(byte_at(bytes, i), expected[i]) << i;
}

TEST(PackedTriangles, AreDifferencesBetweenCorners) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {70000, 2, 1}};
  const std::string bytes = unpacked(packed_triangles(triangles), 24);
  int now = 0;
  for (std::size_t k = 0; k < 6; ++k) {
    std::uint32_t difference = 0;
    for (std::size_t b = 4; b-- > 0;) difference = difference << 8 | byte_at(bytes, 4 * k + b);
    now += static_cast<int>(difference);
    EXPECT_EQ(now, triangles[k / 3][k % 3]);
  }
}

}  // namespace
}  // namespace palmar::report
