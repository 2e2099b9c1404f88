// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/imprint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/redesign/align_imprints.h"
#include "palmar/redesign/surface_diffusion.h"

namespace palmar::redesign {
namespace {

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Vec3& by) {
  for (Vec3& x : mesh.vertices) x += by;
  return mesh;
}

geometry::TriangleMesh joined(geometry::TriangleMesh a, const geometry::TriangleMesh& b) {
  const int offset = a.vertex_count();
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return a;
}

double depth_at(const Imprint& imprint, int point) {
  for (std::size_t k = 0; k < imprint.point.size(); ++k) {
    if (imprint.point[k] == point) return imprint.depth[k];
  }
  return 0.0;
}

// A block of 40 x 40 x 20 mm with its top at z = 10, asked at points off the edges of triangles.
const std::vector<Vec3> kPoints = {{1.3, 0.7, 10.0}, {8.1, 0.4, 10.0}, {15.2, 3.1, 10.0}};
const std::vector<Vec3> kUp(3, Vec3::UnitZ());

TEST(ImprintGauge, MeasuresAlongTheRayUntilItLeavesTheSkin) {
  const ImprintGauge gauge(geometry::make_box({40, 40, 20}), kPoints, kUp);
  // A box of skin whose underside lies at z = 7.
  const Imprint imprint = gauge.measure(moved(geometry::make_box({20, 20, 10}), {0, 0, 12}));
  EXPECT_EQ(imprint.point, (std::vector<int>{0, 1}));
  EXPECT_NEAR(imprint.depth[0], 3.0, 1e-4);
  EXPECT_NEAR(gauge.wall()[0], 20.0, 1e-4);
}

TEST(ImprintGauge, GoesThroughOverlappingFingersAsThroughOne) {
  const ImprintGauge gauge(geometry::make_box({40, 40, 20}), kPoints, kUp);
  const geometry::TriangleMesh fingers =
      joined(moved(geometry::make_box({20, 20, 10}), {0, 0, 13}),   // 8 to 18
             moved(geometry::make_box({22, 22, 4}), {0, 0, 7.5}));  // 5.5 to 9.5
  EXPECT_NEAR(depth_at(gauge.measure(fingers), 0), 4.5, 1e-4);
}

TEST(ImprintGauge, FingerBelowTheSurfaceThatDoesntCoverItIsNoImprint) {
  const ImprintGauge gauge(geometry::make_box({40, 40, 20}), kPoints, kUp);
  EXPECT_TRUE(gauge.measure(moved(geometry::make_box({20, 20, 4}), {0, 0, 5})).point.empty());
}

TEST(ImprintGauge, IsNotDeeperThanHalfTheWall) {
  const ImprintGauge gauge(moved(geometry::make_box({40, 40, 4}), {0, 0, 8}), kPoints, kUp);
  const geometry::TriangleMesh skin =
      moved(geometry::make_box({20, 20, 10}), {0, 0, 12});  // 3 mm deep
  EXPECT_NEAR(depth_at(gauge.measure(skin), 0), 2.0, 1e-4);
  const ImprintGauge wall_gauge(moved(geometry::make_box({40, 40, 4}), {0, 0, 8}), kPoints, kUp,
                                {.largest = 15.0, .wall_share = 1.0});
  EXPECT_NEAR(depth_at(wall_gauge.measure(skin), 0), 3.0, 1e-4);
}

TEST(ImprintGauge, SkinThatCameThroughTheWallFromBehindDoesntPressTheFarSide) {
  // The wall from z = 8 to 10; the finger comes from below and stands out by 1 mm.
  const ImprintGauge gauge(moved(geometry::make_box({40, 40, 2}), {0, 0, 9}), kPoints, kUp);
  EXPECT_TRUE(gauge.measure(moved(geometry::make_box({20, 20, 14}), {0, 0, 4})).point.empty());
}

TEST(ImprintGauge, RefusesPointsWithoutDirections) {
  EXPECT_THAT(
      [] {
        ImprintGauge(geometry::make_box({1, 1, 1}), kPoints, {});
      },
      ::testing::ThrowsMessage<UsageError>(::testing::HasSubstr("3 points, 0 directions")));
}

TEST(CombineImprints, HandsThatDontTouchCountAsZeroUnlessStatedOtherwise) {
  const std::vector<Imprint> hands = {{{0, 1}, {2.0, 4.0}}, {{1}, {1.0}}, {{}, {}}, {{1}, {1.0}}};
  EXPECT_EQ(combine_imprints(hands, 3), (std::vector<double>{0.5, 1.5, 0.0}));
  CombineOptions options;
  options.is_among_touching = true;
  EXPECT_EQ(combine_imprints(hands, 3, options), (std::vector<double>{2.0, 2.0, 0.0}));
}

TEST(CombineImprints, PercentileLiesBetweenTheHandsNextToIt) {
  const std::vector<Imprint> hands = {{{0}, {4.0}}, {{0}, {2.0}}, {{}, {}}};  // 0, 2, 4
  CombineOptions options;
  options.statistic = ImprintStatistic::kPercentile;
  for (const auto& [percentile, depth] :
       std::vector<std::pair<double, double>>{{0, 0.0}, {50, 2.0}, {75, 3.0}, {100, 4.0}}) {
    options.percentile = percentile;
    EXPECT_NEAR(combine_imprints(hands, 1, options)[0], depth, 1e-12);
  }
  options.percentile = 101.0;
  EXPECT_THROW(combine_imprints(hands, 1, options), UsageError);
}

TEST(AlignImprints, BringsShiftedHandsOntoEachOther) {
  std::vector<Vec3> points;
  std::vector<double> areas;
  for (int i = 0; i <= 200; ++i) {
    points.emplace_back(0.5 * i, 0.0, 0.0);
    areas.push_back(1.0);
  }
  // Four fingers 20 mm apart; the second hand holds 6 mm further on.
  std::vector<Imprint> hands(2);
  for (int i = 0; i <= 200; ++i) {
    for (int hand = 0; hand < 2; ++hand) {
      const double x = points[i].x() - 15.0 - 6.0 * hand;
      if (x < -5.0 || x > 65.0) continue;
      const double depth = 1.0 + std::cos(2.0 * 3.141592653589793 * x / 20.0);
      if (depth <= 0.0) continue;
      hands[hand].point.push_back(i);
      hands[hand].depth.push_back(depth);
    }
  }
  const std::vector<double> shift = align_imprints(hands, points, areas, Vec3::UnitX(), 10.0);
  EXPECT_NEAR(shift[0] - shift[1], 6.0, 0.5);  // a step is 0.25 mm
  EXPECT_NEAR(shift[0] + shift[1], 0.0, 1e-12);
}

TEST(SurfaceDiffusion, SpreadsASpotLikeAGaussian) {
  const geometry::TriangleMesh patch = geometry::make_lattice_patch(20.0, 0.5);
  std::vector<double> spot(patch.vertices.size(), 0.0);
  spot[0] = 1.0;
  const std::vector<double> result = SurfaceDiffusion(patch, 2.0).smooth(spot);
  double sum = 0.0, second = 0.0;
  for (std::size_t v = 0; v < result.size(); ++v) {
    EXPECT_GE(result[v], -1e-12);
    sum += result[v];
    second += result[v] * patch.vertices[v].x() * patch.vertices[v].x();
  }
  EXPECT_NEAR(sum, 1.0, 1e-6);
  EXPECT_NEAR(second / sum, 4.0, 0.05);  // variance along x: length squared
}

TEST(SurfaceDiffusion, KeepsConstantsAndNothingAtLengthZero) {
  const geometry::TriangleMesh ball = geometry::make_icosphere(10.0, 2);
  const std::vector<double> ones(ball.vertices.size(), 1.0);
  for (const double value : SurfaceDiffusion(ball, 5.0).smooth(ones)) EXPECT_NEAR(value, 1.0, 1e-9);
  std::vector<double> spot(ball.vertices.size(), 0.0);
  spot[3] = 2.0;
  EXPECT_EQ(SurfaceDiffusion(ball, 0.0).smooth(spot), spot);
}

}  // namespace
}  // namespace palmar::redesign
