// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/fat_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::capture {
namespace {

// A closed tube with pointed ends along a direction: a shaft.
geometry::TriangleMesh shaft(const Quat& turn) {
  constexpr int kRound = 16, kAlong = 10;
  geometry::TriangleMesh mesh;
  for (int k = 0; k <= kAlong; ++k) {
    for (int i = 0; i < kRound; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kRound;
      mesh.vertices.push_back(turn * Vec3(5.0 * std::cos(angle), 5.0 * std::sin(angle), 4.0 * k));
    }
  }
  for (int k = 0; k < kAlong; ++k) {
    for (int i = 0; i < kRound; ++i) {
      const int a = k * kRound + i, b = k * kRound + (i + 1) % kRound;
      mesh.triangles.push_back({a, b, b + kRound});
      mesh.triangles.push_back({a, b + kRound, a + kRound});
    }
  }
  const int low = mesh.vertex_count(), high = low + 1;
  mesh.vertices.push_back(turn * Vec3(0, 0, -4));
  mesh.vertices.push_back(turn * Vec3(0, 0, 4.0 * kAlong + 4));
  for (int i = 0; i < kRound; ++i) {
    const int next = (i + 1) % kRound, top = kAlong * kRound;
    mesh.triangles.push_back({low, next, i});
    mesh.triangles.push_back({high, top + i, top + next});
  }
  return mesh;
}

// Each bone's marrow ends `shift` farther along than it would: its cortex is as much thinner there.
std::vector<LayerFit> bones(const Vec3& shift, int count, double noise) {
  std::mt19937 random(7);
  std::normal_distribution<double> off(0.0, 1.0);
  std::vector<LayerFit> all(count);
  for (LayerFit& bone : all) {
    bone.mesh = shaft(Quat(off(random), off(random), off(random), off(random)).normalized());
    for (const Vec3& normal : geometry::vertex_normals(bone.mesh)) {
      bone.thickness.push_back(1.2 - kFatShiftShown * shift.dot(normal) + noise * off(random));
    }
  }
  return all;
}

TEST(FatShift, IsWhatMarrowIsOffItsBone) {
  const Vec3 shift(0.7, -0.2, 0.1);
  EXPECT_LT((fat_shift(bones(shift, 12, 0.0)) - shift).norm(), 1e-9);
  EXPECT_LT((fat_shift(bones(shift, 12, 0.2)) - shift).norm(), 0.2);
  EXPECT_LT(fat_shift(bones(Vec3::Zero(), 12, 0.2)).norm(), 0.2);
}

TEST(FatShift, FewBonesShowNothing) {
  EXPECT_EQ(fat_shift(bones(Vec3(0.7, 0, 0), 4, 0.0)), Vec3::Zero());
  EXPECT_EQ(fat_shift({}), Vec3::Zero());
}

TEST(FatShift, GoesToTheSideThatBonesShow) {
  const Vec3 stated(0, 0.8, 0);
  EXPECT_EQ(signed_fat_shift(stated, Vec3(0.5, -0.6, 0)), Vec3(0, -0.8, 0));
  EXPECT_EQ(signed_fat_shift(stated, Vec3(0, 1.5, 0)), stated);
  EXPECT_EQ(signed_fat_shift(stated, Vec3(0.9, 0.1, 0)), Vec3::Zero());
  EXPECT_EQ(signed_fat_shift(Vec3(0, 50, 0), Vec3(0, 0.8, 0)), Vec3::Zero());  // absurd
  EXPECT_EQ(signed_fat_shift(Vec3::Zero(), Vec3(1, 1, 1)), Vec3(1, 1, 1));
  EXPECT_EQ(signed_fat_shift(Vec3::Zero(), Vec3(0.1, 0.1, 0.1)), Vec3::Zero());
}

}  // namespace
}  // namespace palmar::capture
