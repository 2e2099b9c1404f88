// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_frame.h"

#include <gtest/gtest.h>

#include <bit>

namespace palmar::server {
namespace {

/// Reads numbers one after the other, the lowest byte first.
class FrameReader {
 public:
  explicit FrameReader(const std::string& bytes) : bytes_(bytes) {}
  std::uint32_t u8() { return static_cast<unsigned char>(bytes_.at(at_++)); }
  std::uint32_t u16() {
    const std::uint32_t low = u8();
    return low | u8() << 8U;
  }
  std::uint32_t u32() {
    const std::uint32_t low = u16();
    return low | u16() << 16U;
  }
  double f32() { return std::bit_cast<float>(u32()); }
  double f64() {
    const std::uint64_t low = u32();
    return std::bit_cast<double>(low | static_cast<std::uint64_t>(u32()) << 32U);
  }
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

void expect_head(FrameReader& in, FrameKind kind, std::uint32_t request, std::uint32_t number) {
  EXPECT_EQ(in.u32(), 0x314d4c50U);  // "PLM1", the first letter first
  EXPECT_EQ(in.u32(), static_cast<std::uint32_t>(kind));
  EXPECT_EQ(in.u32(), request);
  EXPECT_EQ(in.u32(), number);
}

TEST(LiveFrame, FieldReadsBackWithinItsSteps) {
  contact::ContactResult contact;
  contact.status = contact::ContactStatus::kSolved;
  contact.deformed = {Vec3(10, 20, 30), Vec3(110, -20.5, 31.25), Vec3(60, 0.123, 30)};
  contact.pressure = {0.0, 0.25, 0.1};
  contact.total.force = 12.5;
  contact.total.area = 300.0;
  contact.total.peak_pressure = 0.25;
  contact.regions.resize(1);
  contact.regions[0].region = hand::Region::kThenar;
  contact.regions[0].force = 12.5;
  LiveField field;
  field.contact = &contact;
  const contact::MovingFootprint::Loaded on_product{{4, 70000}, {0.2, 0.05}};
  field.on_product = &on_product;
  field.grip_force = 8.0;
  field.posture[hand::Dof::kIndexPipFlexion] = 0.5;
  field.product_from_hand = geometry::Rigid3::about_axis(Vec3::UnitZ(), Vec3(5, 0, 0), 0.3);
  const std::string bytes = field_frame(field, {FrameKind::kMoving, 77, 3});

  FrameReader in(bytes);
  expect_head(in, FrameKind::kMoving, 77, 3);
  Quat q;
  q.w() = in.f64();
  q.x() = in.f64();
  q.y() = in.f64();
  q.z() = in.f64();
  EXPECT_EQ(q.coeffs(), field.product_from_hand.rotation.coeffs());
  for (int k = 0; k < 3; ++k) EXPECT_EQ(in.f64(), field.product_from_hand.translation[k]);
  EXPECT_EQ(in.f32(), 8.0);
  for (const double value : {12.5, 300.0, 0.25, 0.0, 0.0}) EXPECT_EQ(in.f32(), value);
  EXPECT_EQ(in.u32(), static_cast<std::uint32_t>(contact::ContactStatus::kSolved));
  for (int d = 0; d < hand::kDofCount; ++d) {
    const double angle = in.f32();
    EXPECT_NEAR(angle, d == static_cast<int>(hand::Dof::kIndexPipFlexion) ? 28.6479 : 0.0,
                1e-4);  // deg
  }
  Vec3 low;
  for (int k = 0; k < 3; ++k) low[k] = in.f32();
  const double step = in.f32();
  const double pressure_step = in.f32();
  ASSERT_EQ(in.u32(), 1U);
  EXPECT_EQ(in.f32(), static_cast<double>(hand::Region::kThenar));
  EXPECT_EQ(in.f32(), 12.5);
  for (int k = 0; k < 4; ++k) in.f32();
  ASSERT_EQ(in.u32(), 3U);
  const geometry::Rigid3 hand_from_product = field.product_from_hand.inverse();
  for (const Vec3& place : contact.deformed) {
    Vec3 read;
    for (int k = 0; k < 3; ++k) read[k] = low[k] + step * in.u16();
    EXPECT_LT((read - hand_from_product * place).cwiseAbs().maxCoeff(), 0.5 * step + 1e-4);  // mm
  }
  for (const double pressure : contact.pressure) {
    EXPECT_NEAR(in.u16() * pressure_step, pressure, 0.5 * pressure_step + 1e-7);  // MPa
  }
  ASSERT_EQ(in.u32(), 2U);
  EXPECT_EQ(in.u32(), 4U);
  EXPECT_EQ(in.u32(), 70000U);
  for (const double pressure : on_product.pressure) {
    EXPECT_NEAR(in.u16() * pressure_step, pressure, 0.5 * pressure_step + 1e-7);
  }
  EXPECT_TRUE(in.is_at_end());
}

TEST(LiveFrame, HandWithoutContactIsShownAsItIsPosed) {
  const std::vector<Vec3> skin = {Vec3(0, 0, 0), Vec3(400, 10, 20)};
  LiveField field;
  field.posed_skin = &skin;
  const std::string bytes = field_frame(field, {FrameKind::kPreview, 1, 2});
  // 400 mm don't fit into 65535 steps of 0.005 mm: larger ones.
  EXPECT_EQ(bytes.size(), 16U + 56U + 24U + 4U + 92U + 16U + 4U + 4U + 4U + 2U * 8U + 4U);
  FrameReader in(bytes);
  expect_head(in, FrameKind::kPreview, 1, 2);
  for (int k = 0; k < 14 + 6 + 1 + 23 + 3; ++k) in.u32();
  EXPECT_NEAR(in.f32(), 400.0 / 65535.0, 1e-8);
}

TEST(LiveFrame, MeshesKeepVerticesAndTriangles) {
  contact::ProductFootprint footprint;
  footprint.surface.vertices = {Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(7, 8, 9)};
  footprint.surface.triangles = {{0, 2, 1}};
  footprint.pressure = {0.5, 0.0, 0.25};
  const std::string bytes = footprint_frame(footprint, 9);
  FrameReader in(bytes);
  expect_head(in, FrameKind::kFootprint, 9, 0);
  EXPECT_EQ(in.u32(), 3U);
  EXPECT_EQ(in.u32(), 1U);
  for (int k = 1; k <= 9; ++k) EXPECT_EQ(in.f32(), k);
  for (const std::uint32_t corner : {0U, 2U, 1U}) EXPECT_EQ(in.u32(), corner);
  for (const double pressure : {0.5, 0.0, 0.25}) EXPECT_EQ(in.f32(), pressure);
  EXPECT_TRUE(in.is_at_end());
}

}  // namespace
}  // namespace palmar::server
