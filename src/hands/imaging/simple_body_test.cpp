// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/imaging/simple_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "hands/imaging/iso_surface.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::imaging {
namespace {

template <typename F>
Volume drawn(int n, double spacing, const F& f) {
  Volume image;
  image.grid.size = {n, n, n};
  image.grid.spacing = Vec3::Constant(spacing);
  image.grid.origin = Vec3::Constant(-0.5 * spacing * (n - 1));
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        image.value.push_back(static_cast<float>(f(image.grid.to_patient(Vec3(i, j, k)))));
      }
    }
  }
  return image;
}

/// Signal falls from 1 inside of a tube round a closed curve to 0 outside, half at its wall.
template <typename Curve>
Volume tube(int n, double radius, const Curve& curve) {
  return drawn(n, 1.0, [&](const Vec3& p) {
    double least = 1e9;
    for (int s = 0; s < 150; ++s) {
      least = std::min(least, (p - curve(2.0 * std::numbers::pi * s / 150.0)).norm());
    }
    return std::clamp(0.5 + (radius - least), 0.0, 1.0);
  });
}

geometry::TopologyReport topology_of(const Volume& image) {
  return geometry::examine_topology(iso_surface(image, 0.5));
}

// Whatever surrounds a voxel: flipping it keeps Euler number and number of pieces of the surface
// if it is simple. The surface is that of marching cubes, which knows nothing of simple points.
TEST(SimpleBody, FlippingASimpleVoxelKeepsTheTopologyOfTheSurface) {
  std::mt19937 random(7);
  int simple = 0, changed = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    std::uint32_t around = 0;
    // Sparse and dense surroundings alike.
    const std::uint32_t share = 1 + random() % 7;
    for (int n = 0; n < 27; ++n) around |= random() % 8 < share ? 1U << n : 0U;
    Volume image;
    image.grid.size = {5, 5, 5};
    image.value.assign(125, 0.0F);
    for (int n = 0; n < 27; ++n) {
      if (n == 13) continue;
      image.value[image.grid.at(1 + n % 3, 1 + n / 3 % 3, 1 + n / 9)] =
          ((around >> n) & 1U) != 0 ? 1.0F : 0.0F;
    }
    const geometry::TopologyReport without = topology_of(image);
    image.value[image.grid.at(2, 2, 2)] = 1.0F;
    const geometry::TopologyReport with = topology_of(image);
    const bool is_same =
        with.euler_number == without.euler_number && with.components == without.components;
    if (is_simple(around)) {
      ++simple;
      EXPECT_TRUE(is_same) << around;
    } else if (!is_same) {
      ++changed;
    }
  }
  EXPECT_GT(simple, 100);
  EXPECT_GT(changed, 100);
}

TEST(SimpleBody, IsolatedAndEnclosedVoxelsArentSimple) {
  EXPECT_FALSE(is_simple(0));
  EXPECT_FALSE(is_simple((1U << 27) - 1));
  EXPECT_TRUE(is_simple(1U << 12));                // at the end of a row
  EXPECT_FALSE(is_simple(1U << 12 | 1U << 14));    // between two
  EXPECT_FALSE(is_simple(1U << 0));                // a corner only: 6 neighbours connect
  EXPECT_FALSE(is_simple(0b111101111U << 9 | 0));  // in a ring: a hole would be closed
}

TEST(SimpleBody, RingIsCutWhereItIsThinnest) {
  const auto circle = [](double t) -> Vec3 { return 14.0 * Vec3(std::cos(t), std::sin(t), 0.0); };
  // Thinner where x is largest.
  const Volume ring = drawn(44, 1.0, [&](const Vec3& p) {
    const double radius = 4.5 - 1.5 * std::max(0.0, p.x() / 14.0);
    const double away = (p - circle(std::atan2(p.y(), p.x()))).norm();
    return std::clamp(0.5 + radius - away, 0.0, 1.0);
  });
  ASSERT_EQ(topology_of(ring).euler_number, 0);
  const SimpleSurface surface = simple_surface(ring, 0.5, 1.0);
  EXPECT_EQ(surface.handles, 1);
  const geometry::TopologyReport report = geometry::examine_topology(surface.mesh);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_EQ(report.components, 1);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold);
  // A film of one voxel is missing.
  EXPECT_NEAR(
      geometry::signed_volume(surface.mesh) / geometry::signed_volume(iso_surface(ring, 0.5)), 1.0,
      0.02);
  const VoxelMask body = [&] {
    VoxelMask mask(ring.value.size());
    for (std::size_t v = 0; v < mask.size(); ++v) mask[v] = ring.value[v] > 0.5F ? 1 : 0;
    return simple_body(ring.grid, mask, distance_transform(ring.grid, [&] {
                         VoxelMask outside = mask;
                         for (auto& v : outside) v = v == 0 ? 1 : 0;
                         return outside;
                       }()));
  }();
  for (std::size_t v = 0; v < body.size(); ++v) {
    if (ring.value[v] > 0.5F && body[v] == 0) {
      const int i = static_cast<int>(v % 44);
      EXPECT_GT(i, 30) << "cut at voxel " << v;
    }
  }
}

TEST(SimpleBody, KnotBecomesASphereToo) {
  const auto trefoil = [](double t) -> Vec3 {
    return 5.0 * Vec3(std::sin(t) + 2.0 * std::sin(2.0 * t), std::cos(t) - 2.0 * std::cos(2.0 * t),
                      -std::sin(3.0 * t));
  };
  const Volume knot = tube(40, 2.6, trefoil);
  ASSERT_EQ(topology_of(knot).euler_number, 0);
  const SimpleSurface surface = simple_surface(knot, 0.5, 1.0);
  EXPECT_EQ(surface.handles, 1);
  EXPECT_EQ(geometry::examine_topology(surface.mesh).euler_number, 2);
  EXPECT_GT(geometry::signed_volume(surface.mesh),
            0.97 * geometry::signed_volume(iso_surface(knot, 0.5)));
}

TEST(SimpleBody, NoiseLeavesASphereAndBubblesAreFilled) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.45, 0.45);
  const Volume ball = drawn(30, 1.0, [&](const Vec3& p) {
    const double r = p.norm();
    return r < 3.0 ? 0.0 : std::clamp(0.5 + 0.3 * (11.0 - r), 0.0, 1.0) + noise(random);
  });
  const SimpleSurface surface = simple_surface(ball, 0.5, 1.0);
  const geometry::TopologyReport report = geometry::examine_topology(surface.mesh);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_EQ(report.components, 1);
  EXPECT_NEAR(geometry::signed_volume(surface.mesh), 4.0 / 3.0 * std::numbers::pi * 1331.0, 300.0);
}

TEST(SimpleBody, EmptyMaskAndWrongCountsAreReported) {
  VolumeGrid grid;
  grid.size = {2, 2, 2};
  EXPECT_EQ(simple_body(grid, VoxelMask(8, 0), std::vector<float>(8)), VoxelMask(8, 0));
  EXPECT_TRUE(simple_surface({grid, std::vector<float>(8, 0.0F)}, 0.5, 1.0).mesh.triangles.empty());
  EXPECT_THROW(simple_body(grid, VoxelMask(7, 0), std::vector<float>(8)), UsageError);
  EXPECT_THROW(simple_body(grid, VoxelMask(8, 0), std::vector<float>(7)), UsageError);
}

}  // namespace
}  // namespace palmar::imaging
