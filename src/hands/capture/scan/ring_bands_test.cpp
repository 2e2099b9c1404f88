// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/ring_bands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/enum_index.h"

namespace palmar::capture {
namespace {

constexpr int kRound = 60, kAlong = 60;

/// A finger of 8 mm radius along y, from its joint at the origin to the next one at y = 30 mm.
geometry::TriangleMesh finger() {
  geometry::TriangleMesh mesh;
  for (int k = 0; k <= kAlong; ++k) {
    for (int j = 0; j < kRound; ++j) {
      const double t = 2.0 * std::numbers::pi * j / kRound;
      mesh.vertices.emplace_back(8.0 * std::cos(t), 0.5 * k, 8.0 * std::sin(t));
    }
  }
  for (int k = 0; k < kAlong; ++k) {
    for (int j = 0; j < kRound; ++j) {
      const int a = k * kRound + j, b = k * kRound + (j + 1) % kRound;
      mesh.triangles.push_back({a, a + kRound, b});
      mesh.triangles.push_back({b, a + kRound, b + kRound});
    }
  }
  return mesh;
}

hand::Skeleton skeleton() {
  hand::Skeleton result;
  for (hand::Joint& joint : result.joints) joint.centre = Vec3(200.0, 0.0, 0.0);
  for (Vec3& tip : result.fingertips) tip = Vec3(200.0, 20.0, 0.0);
  const auto put = [&](hand::JointId id, const Vec3& at) {
    result.joints[index_of(id)].centre = at;
  };
  put(hand::JointId::kRingMcp, Vec3::Zero());
  put(hand::JointId::kRingPip, Vec3(0.0, 30.0, 0.0));
  put(hand::JointId::kRingDip, Vec3(0.0, 50.0, 0.0));
  return result;
}

/// Vertices between two places along the finger, over a share of its round.
std::vector<int> patch(double from, double to, double share) {
  std::vector<int> list;
  for (int k = 0; k <= kAlong; ++k) {
    for (int j = 0; j < share * kRound; ++j) {
      if (0.5 * k >= from && 0.5 * k <= to) list.push_back(k * kRound + j);
    }
  }
  return list;
}

TEST(RingBands, ARingGoesRoundAFinger) {
  const geometry::Rigid3 anywhere{Quat(0.5, 0.5, -0.5, 0.5), Vec3(100.0, -40.0, 7.0)};
  geometry::TriangleMesh scan = finger();
  for (Vec3& v : scan.vertices) v = anywhere * v;
  SkinMarks marks;
  marks.other_colour = {patch(10.0, 14.0, 1.0), patch(20.0, 24.0, 0.6), patch(27.0, 27.2, 1.0)};
  const auto rings = find_rings(scan, marks, anywhere.inverse(), skeleton());
  ASSERT_EQ(rings.size(), 1U);  // half way round is a plaster, a thin line is a line
  EXPECT_EQ(rings[0].segment, hand::Segment::kRingProximal);
  EXPECT_NEAR(rings[0].width, 4.0, 0.51);
  const geometry::TriangleMesh rest = without_rings(scan, rings, 1.2);
  for (const Triangle& t : rest.triangles) {
    for (const int v : t) {
      const double y = (anywhere.inverse() * scan.vertices[v]).y();
      EXPECT_TRUE(y < 9.0 || y > 15.0) << y;
    }
  }
  // Rows of 0.5 mm from 8.5 to 15.5 mm are gone: 14 of 60.
  EXPECT_EQ(rest.triangle_count(), scan.triangle_count() * 46 / 60);
}

TEST(RingBands, NoneWithoutAnotherColour) {
  EXPECT_TRUE(find_rings(finger(), {}, {}, skeleton()).empty());
  EXPECT_EQ(without_rings(finger(), {}).triangle_count(), finger().triangle_count());
}

}  // namespace
}  // namespace palmar::capture
