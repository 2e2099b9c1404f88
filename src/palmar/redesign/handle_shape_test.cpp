// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/primitives.h"

namespace palmar::redesign {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

double area_of_section(const HandleFeatures& features, double z) {
  constexpr int kPoints = 4000;
  double twice = 0.0;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector2d a = section_point(features, {}, z, static_cast<double>(i) / kPoints);
    const Eigen::Vector2d b = section_point(features, {}, z, (i + 1.0) / kPoints);
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

HandsOnHandle hands_at(const Vec3& place) {
  HandsOnHandle hands;
  hands.place = place;
  hands.thumb_side = Vec3::UnitZ();
  hands.palm = Vec3::UnitY();
  hands.thumb = place + Vec3(20.0, 0.0, 30.0);
  return hands;
}

HandleBody body_of(const product::Product& product, const Vec3& place = Vec3::Zero()) {
  return measure_handle(product, product::find_parts(product).parts.at(0), hands_at(place));
}

product::Product bar(const geometry::TriangleMesh& mesh, const std::string& name) {
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  return product::make_product(name, mesh, unit, name);
}

TEST(HandleFeatures, SectionsHaveTheAreasOfSuperellipses) {
  EXPECT_NEAR(area_of_section({.width = 30.0, .depth = 40.0}, 0.0), pi * 15.0 * 20.0, 1e-2);
  // |x|^4 + |y|^4 = 1 encloses 3.708149... (Gamma(1/4)^2 / (2 sqrt pi)).
  const double squircle = std::pow(std::tgamma(0.25), 2) / (2.0 * std::sqrt(pi));
  EXPECT_NEAR(area_of_section({.width = 20.0, .depth = 20.0, .squareness = 2.0 / 3.0}, 0.0),
              100.0 * squircle, 1e-2);
}

TEST(HandleFeatures, ChangeTheHandleAsTheirNamesSay) {
  const HandleFeatures plain{.width = 30.0, .depth = 40.0};
  const auto width_at = [](const HandleFeatures& f, double z) {
    return (section_point(f, {}, z, 0.0) - section_point(f, {}, z, 0.5)).norm();
  };
  HandleFeatures f = plain;
  f.taper = 5.0;
  EXPECT_NEAR(width_at(f, 40.0), 28.0, 1e-9);
  EXPECT_NEAR(width_at(f, -40.0), 32.0, 1e-9);
  f = plain;
  f.swell = 4.0;
  EXPECT_NEAR(width_at(f, 0.0), 34.0, 1e-9);
  EXPECT_NEAR(width_at(f, 64.0), 30.0, 1e-9);  // 0.8 of a hand of 80 mm away
  f = plain;
  f.waist = 4.0;
  EXPECT_NEAR(width_at(f, 0.36 * 80.0), 26.0, 1e-9);
  f = plain;
  f.palm_swell = 3.0;
  EXPECT_NEAR(section_point(f, {}, 0.0, 0.25).y(), 23.0, 1e-9);
  EXPECT_NEAR(section_point(f, {}, 0.0, 0.75).y(), -20.0, 1e-9);
  f = plain;
  f.finger_swell = 3.0;
  EXPECT_NEAR(section_point(f, {}, 0.0, 0.75).y(), -23.0, 1e-9);
  f = plain;
  f.turn = pi / 2;
  EXPECT_NEAR((section_point(f, {}, 0.0, 0.0) - Eigen::Vector2d(0.0, 15.0)).norm(), 0.0, 1e-9);
  f = plain;
  f.egg = 0.2;  // x stretched by 1 + 0.2 y / b
  const Eigen::Vector2d up = section_point(f, {}, 0.0, 0.125);
  const Eigen::Vector2d down = section_point(f, {}, 0.0, 0.875);
  const double share = std::sqrt(0.5);
  EXPECT_NEAR(up.x(), 15.0 * share * (1.0 + 0.2 * share), 1e-9);
  EXPECT_NEAR(down.x(), 15.0 * share * (1.0 - 0.2 * share), 1e-9);
  f = plain;
  f.thumb_rest = 2.0;
  const HandleHands hands{.breadth = 80.0, .thumb_at = 30.0, .thumb_phi = 0.0};
  EXPECT_NEAR(section_point(f, hands, 30.0, 0.0).x(), 13.0, 1e-9);
  EXPECT_NEAR(section_point(f, hands, 0.0, 0.0).x(), 15.0, 1e-9);
  f = plain;
  f.finger_grooves = 2.0;  // fingers of 20 mm: their middles are 10 and 30 mm from the hand's
  for (const double finger : {-30.0, -10.0, 10.0, 30.0}) {
    EXPECT_NEAR(section_point(f, hands, finger, 0.75).y(), -18.0, 1e-9) << finger;
    EXPECT_NEAR(section_point(f, hands, finger, 0.25).y(), 20.0, 1e-9) << finger;
  }
  for (const double between : {-55.0, -40.0, -20.0, 0.0, 20.0, 40.0, 55.0}) {
    EXPECT_NEAR(section_point(f, hands, between, 0.75).y(), -20.0, 1e-9) << between;
  }
}

TEST(HandleFeatures, UnknownNamesAndValuesOutOfRangeAreNamed) {
  EXPECT_THAT([] { handle_feature("widt"); },
              ThrowsMessage<UsageError>(HasSubstr("did you mean width?")));
  EXPECT_THAT([] { check(HandleFeatures{.width = 3.0}); },
              ThrowsMessage<UsageError>(HasSubstr("width is 3 mm; 12 to 90 are allowed")));
}

/// A round bar about z whose profile goes through (radius, z), closed by flat ends.
product::Product turned(const std::vector<Eigen::Vector2d>& profile) {
  constexpr int kRound = 180;
  geometry::TriangleMesh mesh;
  for (const Eigen::Vector2d& at : profile) {
    for (int i = 0; i < kRound; ++i) {
      const double phi = 2.0 * pi * i / kRound;
      mesh.vertices.emplace_back(at.x() * std::cos(phi), at.x() * std::sin(phi), at.y());
    }
  }
  const int low = mesh.vertex_count(), high = low + 1, last = low - kRound;
  mesh.vertices.emplace_back(0.0, 0.0, profile.front().y());
  mesh.vertices.emplace_back(0.0, 0.0, profile.back().y());
  for (int i = 0; i < kRound; ++i) {
    const int next = (i + 1) % kRound;
    for (int here = 0; here < last; here += kRound) {
      mesh.triangles.push_back({here + i, here + next, here + kRound + next});
      mesh.triangles.push_back({here + i, here + kRound + next, here + kRound + i});
    }
    mesh.triangles.push_back({low, next, i});
    mesh.triangles.push_back({high, last + i, last + next});
  }
  return bar(mesh, "turned");
}

TEST(HandleBody, TheRoundingOfOneEndOfAFlaredFootIsSeen) {
  // From 15 mm at the top to 20 mm at the foot; the foot's edge rounded with 3 mm, the top sharp.
  std::vector<Eigen::Vector2d> profile;
  const auto side = [](double z) { return 20.0 - 5.0 * (z + 60.0) / 120.0; };
  for (int k = 0; k <= 12; ++k) {
    const double a = 0.5 * pi * k / 12;
    profile.emplace_back(side(-57.0) - 3.0 * (1.0 - std::sin(a)),
                         -60.0 + 3.0 * (1.0 - std::cos(a)));
  }
  for (double z = -56.0; z <= 60.0; z += 1.0) profile.emplace_back(side(z), z);
  const HandleBody body = body_of(turned(profile));
  EXPECT_NEAR(body.end_radius, 3.0, 0.3);
  // What is kept there is the foot without its rounding, which the shape makes itself: rounded
  // twice, its profile would have a wave.
  const HandleShape shape{.body = body, .kept_ends = {20.0, 0.0}};
  for (const double z : {-59.5, -58.0, -57.0, -55.0}) {
    EXPECT_NEAR(shape.radius_before(z, 0.0), side(z), 0.25) << z;
  }
}

TEST(HandleBody, ACylinderIsFoundAsWhatItIs) {
  product::CylinderProductOptions options;
  options.diameter = 45.0;
  options.length = 130.0;
  const HandleBody body = body_of(product::make_cylinder_product(options), Vec3(0, 0, 10.0));
  EXPECT_TRUE(body.is_whole);
  EXPECT_NEAR(body.bottom, -75.0, 0.01);
  EXPECT_NEAR(body.top, 55.0, 0.01);
  EXPECT_NEAR(body.end_radius, 0.0, 0.01);
  const FittedFeatures fitted = fit_features(body);
  EXPECT_NEAR(fitted.features.width, 45.0, 0.05);
  EXPECT_NEAR(fitted.features.depth, 45.0, 0.05);
  EXPECT_NEAR(fitted.features.squareness, 0.0, 0.02);
  EXPECT_NEAR(fitted.features.taper, 0.0, 0.01);
  EXPECT_LT(fitted.rms, 0.05);
}

TEST(HandleBody, APrismIsMeasuredAlongItsSidesHoweverTheHandIsTurned) {
  product::PrismProductOptions options;
  options.width = 30.0;
  options.depth = 40.0;
  options.length = 130.0;
  options.fillet_radius = 3.0;
  const product::Product product = product::make_prism_product(options);
  HandsOnHandle hands = hands_at(Vec3::Zero());
  for (const double turned : {0.0, 0.3, -0.3}) {
    hands.palm = Vec3(-std::sin(turned), std::cos(turned), 0.0);
    const FittedFeatures fitted =
        fit_features(measure_handle(product, product::find_parts(product).parts.at(0), hands));
    EXPECT_NEAR(fitted.features.width, 30.0, 0.15) << turned;
    EXPECT_NEAR(fitted.features.depth, 40.0, 0.15) << turned;
    EXPECT_NEAR(fitted.features.turn, -turned, 0.02) << turned;
    EXPECT_GT(fitted.features.squareness, 0.9) << turned;
  }
}

TEST(HandleBody, SectionsOfALeaningHandleAreParallelToItsEnds) {
  product::CylinderProductOptions options;
  options.diameter = 36.0;
  options.length = 110.0;
  geometry::TriangleMesh mesh = product::make_cylinder_product(options).mesh;
  for (Vec3& x : mesh.vertices) x.y() += 0.3 * x.z();
  const HandleBody body = body_of(bar(mesh, "leaning"));
  ASSERT_TRUE(body.is_whole);
  EXPECT_NEAR((body.product_from_handle.rotation * Vec3::UnitZ()).z(), 1.0, 1e-6);
  EXPECT_NEAR(body.centre_at(50.0).y() - body.centre_at(-50.0).y(), 30.0, 0.05);
  const FittedFeatures fitted = fit_features(body);
  EXPECT_NEAR(fitted.features.width, 36.0, 0.1);
  EXPECT_NEAR(fitted.features.depth, 36.0, 0.1);
}

TEST(HandleBody, WhatIsNoBarIsRefusedByName) {
  product::PlaneProductOptions options;
  options.width = 120.0;
  options.depth = 80.0;
  options.thickness = 6.0;
  const product::Product product = product::make_plane_product(options);
  EXPECT_THAT([&] { body_of(product); },
              ThrowsMessage<UsageError>(HasSubstr("is held by its plate; a bar")));
}

TEST(HandleShape, AnEllipticBarIsClosedAndHasItsVolume) {
  product::CylinderProductOptions options;
  options.diameter = 40.0;
  options.length = 120.0;
  HandleShape shape{.body = body_of(product::make_cylinder_product(options))};
  shape.features = {.width = 30.0, .depth = 44.0};
  const geometry::TriangleMesh sharp = handle_mesh(shape);
  EXPECT_TRUE(geometry::examine_topology(sharp).is_closed);
  const double volume = pi * 15.0 * 22.0 * 120.0;
  EXPECT_NEAR(geometry::signed_volume(sharp), volume, 2e-3 * volume);
  // Rounded with r over an angle w: the sections near both ends shrink (Steiner), to first order by
  // perimeter r^2 (2 sin w - w - sin(2 w) / 2); the perimeter by Ramanujan.
  shape.end_radius = 3.0;
  const double h = std::pow((22.0 - 15.0) / 37.0, 2);
  const double perimeter = pi * 37.0 * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
  EXPECT_NEAR(
      geometry::signed_volume(sharp) - geometry::signed_volume(handle_mesh(shape)),
      perimeter * 9.0 * (2.0 * std::sin(kEndAngle) - kEndAngle - 0.5 * std::sin(2.0 * kEndAngle)),
      30.0);
  const ShapeChange change = shape_change(shape);
  EXPECT_NEAR(change.largest, 5.0, 0.1);  // 20 to 15 mm
  EXPECT_NEAR(change.volume_ratio, 15.0 * 22.0 / 400.0, 5e-3);
  EXPECT_NEAR(change.smallest_radius, 15.0 * 15.0 / 22.0, 0.3);  // of an ellipse: a^2 / b
}

TEST(HandleShape, APartRunsIntoItsProductWhereItEnds) {
  product::CylinderProductOptions options;
  options.diameter = 40.0;
  options.length = 160.0;
  const product::Product product = product::make_cylinder_product(options);
  HandleShape shape{.body = body_of(product)};
  shape.body.is_whole = false;
  shape.body.run_out = 14.0;
  shape.body.is_free = {false, false};
  shape.body.bottom = -60.0;
  shape.body.top = 60.0;
  shape.features = {.width = 34.0, .depth = 34.0};
  const geometry::TriangleMesh moved = moved_mesh(product.mesh, shape);
  EXPECT_TRUE(geometry::examine_topology(moved).is_closed);
  for (const Vec3& x : moved.vertices) {
    const double r = x.head<2>().norm();
    if (std::abs(x.z()) > 79.9) continue;  // the flat ends
    if (std::abs(x.z()) > 60.0) {
      EXPECT_NEAR(r, 20.0, 0.02);
    }
    if (std::abs(x.z()) < 46.0) {
      EXPECT_NEAR(r, 17.0, 0.02);
    }
  }
}

TEST(HandleShape, APartOfLongTrianglesMovesAsWell) {
  // A bar of 24 walls from end to end, two triangles each.
  constexpr int kWalls = 24;
  geometry::TriangleMesh bar;
  for (const double z : {-80.0, 80.0}) {
    for (int k = 0; k < kWalls; ++k) {
      const double phi = 2.0 * pi * k / kWalls;
      bar.vertices.emplace_back(15.0 * std::cos(phi), 15.0 * std::sin(phi), z);
    }
    bar.vertices.emplace_back(0.0, 0.0, z);
  }
  for (int k = 0; k < kWalls; ++k) {
    const int next = (k + 1) % kWalls, above = kWalls + 1;
    bar.triangles.push_back({k, next, next + above});
    bar.triangles.push_back({k, next + above, k + above});
    bar.triangles.push_back({kWalls, next, k});
    bar.triangles.push_back({kWalls + above, k + above, next + above});
  }
  product::CylinderProductOptions options;
  options.diameter = 30.0;
  options.length = 160.0;
  HandleShape shape{.body = body_of(product::make_cylinder_product(options))};
  shape.body.is_whole = false;
  shape.body.run_out = 14.0;
  shape.body.is_free = {false, false};
  shape.body.bottom = -60.0;
  shape.body.top = 60.0;
  shape.features = {.width = 40.0, .depth = 40.0};
  ASSERT_TRUE(geometry::examine_topology(bar).is_closed);
  const geometry::TriangleMesh moved = moved_mesh(bar, shape);
  EXPECT_TRUE(geometry::examine_topology(moved).is_closed);
  int middle = 0;
  for (const Vec3& x : moved.vertices) {
    if (std::abs(x.z()) > 45.0) continue;
    ++middle;
    EXPECT_NEAR(x.head<2>().norm(), 20.0, 0.05);
  }
  EXPECT_GT(middle, 100);
}

TEST(HandleShape, WhatLiesInABoxStaysAsItIs) {
  const product::Product prism =
      product::make_prism_product({.width = 30, .depth = 40, .length = 130});
  HandleShape shape{.body = body_of(prism), .features = {.width = 38.0, .depth = 48.0}};
  // The side that looks to +x, from 10 mm below the top.
  shape.kept_boxes = {Box3(Vec3(10.0, -30.0, 55.0), Vec3(30.0, 30.0, 66.0))};
  const geometry::Rigid3 to_handle = shape.body.product_from_handle.inverse();
  const auto radius_towards = [&](const Vec3& way, double z) {
    const Vec3 p = to_handle * Vec3(0.0, 0.0, z);
    const Vec3 d = to_handle.rotation * way;
    return shape.radius_at(p.z(), std::atan2(d.y(), d.x()));
  };
  EXPECT_NEAR(radius_towards(Vec3::UnitX(), 60.0), 15.0, 0.05);   // within the box
  EXPECT_NEAR(radius_towards(Vec3::UnitX(), 40.0), 19.0, 0.05);   // 15 mm below it
  EXPECT_NEAR(radius_towards(-Vec3::UnitX(), 60.0), 19.0, 0.05);  // 25 mm beside it
  const double between = radius_towards(Vec3::UnitX(), 48.0);     // half way
  EXPECT_NEAR(between, 17.0, 0.05);
}

/// Outlines of a bar of one elliptic section, half axes a and b, 100 mm long.
HandleOutlines elliptic_outlines(double a, double b) {
  HandleOutlines outlines{.z = {-50.0, 0.0, 50.0}, .columns = 720, .radius = {}};
  std::vector<double> radius;
  for (int k = 0; k < outlines.columns; ++k) {
    const double phi = 2.0 * pi * k / outlines.columns;
    radius.push_back(a * b / std::hypot(b * std::cos(phi), a * std::sin(phi)));
  }
  outlines.radius.assign(3, radius);
  return outlines;
}

TEST(OutlineGrid, PartsAnOutlineEvenly) {
  const HandleOutlines outlines = elliptic_outlines(20.0, 10.0);
  const OutlineGrid grid = outline_grid(outlines, 2.0);
  // Ramanujan's perimeter: 96.88 mm.
  EXPECT_EQ(grid.directions.size(), 56u);
  EXPECT_EQ(grid.directions.front(), 0.0);
  const auto point = [&](std::size_t k) {
    const double phi = k < grid.directions.size() ? grid.directions[k] : 2.0 * pi;
    const double r = outlines.at(0.0, phi);
    return Eigen::Vector2d(r * std::cos(phi), r * std::sin(phi));
  };
  for (std::size_t k = 0; k < grid.directions.size(); ++k) {
    EXPECT_NEAR((point(k + 1) - point(k)).norm(), 96.88 / 56.0, 0.01) << k;
  }
  // A quarter of the directions in every quarter.
  for (std::size_t quarter = 1; quarter < 4; ++quarter) {
    EXPECT_NEAR(grid.directions[14 * quarter], 0.5 * pi * static_cast<double>(quarter), 1e-3);
  }
}

TEST(OutlineGrid, IsFollowedInPlaceOfFeatures) {
  HandleShape shape;
  shape.body.bottom = -50.0;
  shape.body.top = 50.0;
  shape.body.is_whole = true;
  shape.body.outlines = elliptic_outlines(20.0, 10.0);
  for (Eigen::Vector2d& one : shape.body.centre) one.setZero();
  shape.features = {.width = 80.0, .depth = 80.0};
  shape.follows = outline_grid(shape.body.outlines, 2.0);
  EXPECT_TRUE(shape.keeps());
  EXPECT_EQ(rows_for(shape).columns, 56);
  for (int k = 0; k < 90; ++k) {
    const Eigen::Vector2d at = shape.side_point(12.0, k / 90.0);
    EXPECT_NEAR(std::pow(at.x() / 20.0, 2) + std::pow(at.y() / 10.0, 2), 1.0, 1e-3) << k;
  }
  // The ends of an ellipse's long axis have the radius of curvature b^2 / a.
  shape.follows = outline_grid(shape.body.outlines, 1.0);
  EXPECT_NEAR(tightest_at_ends(shape), 5.0, 0.15);
}

}  // namespace
}  // namespace palmar::redesign
