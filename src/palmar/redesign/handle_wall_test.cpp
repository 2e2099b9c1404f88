// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_wall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/product/intake/make_product.h"

namespace palmar::redesign {
namespace {

using std::numbers::pi;

/// A pipe about z from z = -60 to 60 mm: elliptic outside, round inside from -40 to 40 mm about (x,
/// 0), closed there.
product::Product pipe(double width, double depth, double inner_radius, double x) {
  constexpr int kRound = 240;
  geometry::TriangleMesh mesh;
  const auto add_drum = [&](double half, double a, double b, double at, bool is_inward) {
    constexpr int kRings = 60;
    const int first = mesh.vertex_count();
    for (int j = 0; j <= kRings; ++j) {
      for (int i = 0; i < kRound; ++i) {
        const double phi = 2.0 * pi * i / kRound;
        mesh.vertices.emplace_back(at + a * std::cos(phi), b * std::sin(phi),
                                   -half + 2.0 * half * j / kRings);
      }
    }
    const int low = mesh.vertex_count(), high = low + 1;
    mesh.vertices.emplace_back(at, 0.0, -half);
    mesh.vertices.emplace_back(at, 0.0, half);
    const auto add = [&](int p, int q, int r) {
      mesh.triangles.push_back(is_inward ? Triangle{p, r, q} : Triangle{p, q, r});
    };
    for (int i = 0; i < kRound; ++i) {
      const int next = (i + 1) % kRound;
      for (int j = 0; j < kRings; ++j) {
        const int here = first + j * kRound, above = here + kRound;
        add(here + i, here + next, above + next);
        add(here + i, above + next, above + i);
      }
      add(low, first + next, first + i);
      add(high, first + kRings * kRound + i, first + kRings * kRound + next);
    }
  };
  add_drum(60.0, 0.5 * width, 0.5 * depth, 0.0, false);
  add_drum(40.0, inner_radius, inner_radius, x, true);
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  return product::make_product("pipe", mesh, unit, "pipe");
}

HandleShape shape_on(const product::Product& product, const HandleFeatures& features) {
  HandsOnHandle hands;
  hands.palm = Vec3::UnitY();
  hands.thumb = Vec3(20.0, 0.0, 30.0);
  return {.body = measure_handle(product, product::find_parts(product).parts.at(0), hands),
          .features = features};
}

TEST(HandleWall, OfAPipeIsTheGapBetweenItsRadii) {
  // The hollow's axis is 4 mm off that of the outside: 18 - 10 - 4 mm on one side.
  const HandleShape shape = shape_on(pipe(36.0, 36.0, 10.0, 4.0), {.width = 36.0, .depth = 36.0});
  EXPECT_NEAR(thinnest_wall(shape.body).value(), 4.0, 0.05);
  EXPECT_NEAR(thinnest_wall(shape).value(), 4.0, 0.05);
}

TEST(HandleWall, IsMeasuredAcrossTheSurfaceAndNegativeInsideTheHollow) {
  const product::Product product = pipe(40.0, 40.0, 12.0, 0.0);
  // An ellipse of half axes 20 and 15 round a circle of 12: nearest at the ends of the short axis.
  EXPECT_NEAR(thinnest_wall(shape_on(product, {.width = 40.0, .depth = 30.0})).value(), 3.0, 0.05);
  // One of 20 and 11 cuts 1 mm into it.
  EXPECT_NEAR(thinnest_wall(shape_on(product, {.width = 40.0, .depth = 22.0})).value(), -1.0, 0.05);
  // Beside a circle that is off by 5 mm along its long axis: min of |p - c| over the ellipse
  // (20 cos t, 15 sin t), less the radius.
  double nearest = 1e9;
  for (double t = 0.0; t < 2.0 * pi; t += 1e-4) {
    nearest = std::min(nearest, std::hypot(20.0 * std::cos(t) - 5.0, 15.0 * std::sin(t)) - 12.0);
  }
  EXPECT_NEAR(
      thinnest_wall(shape_on(pipe(40.0, 40.0, 12.0, 5.0), {.width = 40.0, .depth = 30.0})).value(),
      nearest, 0.06);
}

TEST(HandleWall, ASolidHandleHasNone) {
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  geometry::TriangleMesh solid = pipe(36.0, 36.0, 10.0, 0.0).mesh;
  // Without the inner drum, whose vertices come second.
  const auto half = static_cast<int>(solid.vertices.size() / 2);
  std::erase_if(solid.triangles, [&](const Triangle& t) { return t[0] >= half; });
  solid.vertices.resize(static_cast<std::size_t>(half));
  const HandleShape shape =
      shape_on(product::make_product("bar", solid, unit, "bar"), {.width = 36.0, .depth = 36.0});
  EXPECT_TRUE(shape.body.hollow.z.empty());
  EXPECT_FALSE(thinnest_wall(shape).has_value());
}

}  // namespace
}  // namespace palmar::redesign
