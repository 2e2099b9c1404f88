// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/reference_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace palmar::capture {
namespace {

// An ellipsoid with its half axes along x, y and z.
geometry::TriangleMesh ellipsoid(const Vec3& half) {
  constexpr int kRound = 24, kDown = 12;
  geometry::TriangleMesh mesh;
  for (int k = 0; k <= kDown; ++k) {
    for (int i = 0; i < kRound; ++i) {
      const double down = std::numbers::pi * k / kDown, turn = 2.0 * std::numbers::pi * i / kRound;
      const Vec3 p(std::sin(down) * std::cos(turn), std::sin(down) * std::sin(turn),
                   std::cos(down));
      mesh.vertices.push_back(p.cwiseProduct(half));
    }
  }
  for (int k = 0; k < kDown; ++k) {
    for (int i = 0; i < kRound; ++i) {
      const int a = k * kRound + i, b = k * kRound + (i + 1) % kRound;
      if (k > 0) mesh.triangles.push_back({a, a + kRound, b});
      if (k + 1 < kDown) mesh.triangles.push_back({b, a + kRound, b + kRound});
    }
  }
  return mesh;
}

TEST(EndsOf, ALongBoneHasItsOwnAxis) {
  // The next bone is bent away by 50 degrees.
  const auto ends = ends_of(ellipsoid({20.0, 5.0, 4.0}), Vec3(10.0, 12.0, 0.0));
  EXPECT_LT((ends[0] - Vec3(-20, 0, 0)).norm(), 0.1);
  EXPECT_LT((ends[1] - Vec3(20, 0, 0)).norm(), 0.1);
}

// Of a distal phalanx often only the tuft is found, which is broader than long.
TEST(EndsOf, ABroadOneThatOfItsFinger) {
  const auto ends = ends_of(ellipsoid({6.0, 4.5, 3.0}), Vec3(3.0, 20.0, 1.0));
  EXPECT_LT((ends[0] - Vec3(0, -4.5, 0)).norm(), 0.1);
  EXPECT_LT((ends[1] - Vec3(0, 4.5, 0)).norm(), 0.1);
}

}  // namespace
}  // namespace palmar::capture
