// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/intake/contact_body.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/product/intake/make_product.h"

namespace palmar::product {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

/// Surface of revolution about z through the points (radius, height) of a closed outline that runs
/// clockwise in the half plane seen with the axis at the left; points on the axis become one
/// vertex.
geometry::TriangleMesh turned(const std::vector<Eigen::Vector2d>& outline, int around = 64) {
  geometry::TriangleMesh mesh;
  std::vector<std::vector<int>> ring;
  for (const Eigen::Vector2d& p : outline) {
    std::vector<int> one;
    for (int k = 0; k < around; ++k) {
      if (p.x() == 0.0 && k > 0) {
        one.push_back(one.front());
        continue;
      }
      const double a = 2.0 * std::numbers::pi * k / around;
      one.push_back(mesh.vertex_count());
      mesh.vertices.emplace_back(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
    }
    ring.push_back(one);
  }
  const auto add = [&](int a, int b, int c) {
    if (a != b && b != c && a != c) mesh.triangles.push_back({a, b, c});
  };
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const std::size_t j = (i + 1) % ring.size();
    for (std::size_t k = 0; k < static_cast<std::size_t>(around); ++k) {
      const std::size_t l = (k + 1) % static_cast<std::size_t>(around);
      add(ring[i][k], ring[i][l], ring[j][l]);
      add(ring[i][k], ring[j][l], ring[j][k]);
    }
  }
  return mesh;
}

/// Points from a to b, b left out.
void line(std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
          int steps) {
  for (int i = 0; i < steps; ++i) outline.push_back(a + (b - a) * i / steps);
}

geometry::TriangleMesh tube(double outer, double inner, double length) {
  const double h = 0.5 * length;
  std::vector<Eigen::Vector2d> outline;
  line(outline, {outer, -h}, {outer, h}, 40);
  line(outline, {outer, h}, {inner, h}, 2);
  line(outline, {inner, h}, {inner, -h}, 40);
  line(outline, {inner, -h}, {outer, -h}, 2);
  return turned(outline);
}

/// A cup, open at the top.
geometry::TriangleMesh cup(double outer, double wall, double height) {
  std::vector<Eigen::Vector2d> outline;
  line(outline, {0.0, 0.0}, {outer, 0.0}, 12);
  line(outline, {outer, 0.0}, {outer, height}, 30);
  line(outline, {outer, height}, {outer - wall, height}, 2);
  line(outline, {outer - wall, height}, {outer - wall, wall}, 30);
  line(outline, {outer - wall, wall}, {0.0, wall}, 12);
  outline.emplace_back(0.0, wall);
  return turned(outline);
}

double depth_at(const Product& product, const Vec3& point) {
  std::vector<geometry::DistanceSample> sample(1);
  product.distance->sample(std::vector<Vec3>{point}, 100.0, sample);
  return -sample[0].distance;
}

Product product_of(const geometry::TriangleMesh& mesh) {
  return make_product("p", mesh, {geometry::LengthUnit::kMillimetre, UnitSource::kMade, ""},
                      "test");
}

TEST(ContactBody, OfATubeIsDeepWhereTheTubeIsHollow) {
  const geometry::TriangleMesh mesh = tube(20.0, 18.0, 130.0);
  ASSERT_GT(geometry::signed_volume(mesh), 0.0);
  const ContactBody body = contact_body(mesh);
  EXPECT_GT(body.dropped, 0);
  EXPECT_NEAR(body.thinnest_wall, 2.0, 0.01);
  EXPECT_TRUE(geometry::examine_topology(body.mesh).is_closed);

  const Product product = product_of(mesh);
  EXPECT_THAT(product.notes, Contains(HasSubstr("the thinnest 2.0 mm")));
  for (const double depth : {0.5, 1.5, 4.0, 9.0}) {
    EXPECT_NEAR(depth_at(product, {20.0 - depth, 0.0, 3.0}), depth, 0.05) << depth;
  }
  EXPECT_LT(depth_at(product, {21.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(product.mesh.triangle_count(), mesh.triangle_count());  // shown as it is
}

TEST(ContactBody, OfAHiddenCavityIsTheOuterShell) {
  geometry::TriangleMesh mesh = tube(20.0, 0.0, 100.0);
  std::vector<Eigen::Vector2d> outline;
  line(outline, {0.0, -50.0}, {20.0, -50.0}, 8);
  line(outline, {20.0, -50.0}, {20.0, 50.0}, 30);
  line(outline, {20.0, 50.0}, {0.0, 50.0}, 8);
  outline.emplace_back(0.0, 50.0);
  mesh = turned(outline);
  const double volume = geometry::signed_volume(mesh);
  geometry::TriangleMesh inside = turned(outline);
  const int offset = mesh.vertex_count();
  for (const Vec3& v : inside.vertices) mesh.vertices.push_back(0.9 * v);
  for (const Triangle& t : inside.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[2] + offset, t[1] + offset});
  }
  const ContactBody body = contact_body(mesh);
  EXPECT_NEAR(geometry::signed_volume(body.mesh), volume, 1e-6 * volume);
}

TEST(ContactBody, OfACupIsFilledToTheRim) {
  const Product product = product_of(cup(40.0, 3.0, 95.0));
  EXPECT_NEAR(depth_at(product, {36.0, 0.0, 30.0}), 4.0, 0.05);  // beyond the wall
  EXPECT_NEAR(depth_at(product, {33.0, 0.0, 85.0}), 7.0, 0.1);   // beyond it near the rim
  EXPECT_LT(depth_at(product, {30.0, 0.0, 97.0}), 0.0);          // above the mouth
  EXPECT_NEAR(depth_at(product, {38.5, 0.0, 85.0}), 1.5, 0.05);  // in the rim
}

TEST(ContactBody, OfSolidsAndRingsIsTheProductItself) {
  // A solid, a ring that a finger goes through, a plate, and a solid with a deep narrow groove.
  std::vector<Eigen::Vector2d> grooved;
  line(grooved, {0.0, -50.0}, {20.0, -50.0}, 8);
  line(grooved, {20.0, -50.0}, {20.0, -1.0}, 20);
  line(grooved, {20.0, -1.0}, {12.0, -1.0}, 6);
  line(grooved, {12.0, -1.0}, {12.0, 1.0}, 2);
  line(grooved, {12.0, 1.0}, {20.0, 1.0}, 6);
  line(grooved, {20.0, 1.0}, {20.0, 50.0}, 20);
  line(grooved, {20.0, 50.0}, {0.0, 50.0}, 8);
  grooved.emplace_back(0.0, 50.0);
  for (const geometry::TriangleMesh& mesh : {turned(grooved), tube(16.0, 12.5, 12.0)}) {
    const ContactBody body = contact_body(mesh);
    EXPECT_EQ(body.dropped, 0);
    EXPECT_EQ(body.mesh.triangles, mesh.triangles);
    EXPECT_THAT(product_of(mesh).notes, Not(Contains(HasSubstr("cavity"))));
  }
}

/// A plate of `columns` by `rows` square cells, each with a round hole through it; its middle is
/// the origin, z across it.
geometry::TriangleMesh perforated_plate(int columns, int rows, double cell, double hole,
                                        double thickness) {
  constexpr int kAround = 16;
  geometry::TriangleMesh mesh;
  const auto quad = [&](const std::array<Vec3, 4>& corners) {
    const int first = mesh.vertex_count();
    for (const Vec3& x : corners) mesh.vertices.push_back(x);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  for (int i = 0; i < columns; ++i) {
    for (int j = 0; j < rows; ++j) {
      const Vec3 centre((i + 0.5 - 0.5 * columns) * cell, (j + 0.5 - 0.5 * rows) * cell, 0.0);
      for (int k = 0; k < kAround; ++k) {
        const auto at = [&](int step, bool is_hole, double z) -> Vec3 {
          const double angle = 2.0 * std::numbers::pi * step / kAround;
          const Vec3 way(std::cos(angle), std::sin(angle), 0.0);
          const double r = is_hole ? 0.5 * hole : 0.5 * cell / way.cwiseAbs().maxCoeff();
          return centre + r * way + Vec3(0.0, 0.0, z);
        };
        const double top = 0.5 * thickness;
        quad({at(k, true, top), at(k, false, top), at(k + 1, false, top), at(k + 1, true, top)});
        quad(
            {at(k, false, -top), at(k, true, -top), at(k + 1, true, -top), at(k + 1, false, -top)});
        quad({at(k, true, -top), at(k, true, top), at(k + 1, true, top), at(k + 1, true, -top)});
        const double beyond = 0.25 * cell;
        const Vec3 middle = 0.5 * (at(k, false, 0.0) + at(k + 1, false, 0.0));
        const bool is_outer = std::abs(middle.x()) > 0.5 * columns * cell - beyond * 1e-3 ||
                              std::abs(middle.y()) > 0.5 * rows * cell - beyond * 1e-3;
        if (!is_outer) continue;
        quad(
            {at(k, false, top), at(k, false, -top), at(k + 1, false, -top), at(k + 1, false, top)});
      }
    }
  }
  return mesh;
}

TEST(ContactBody, HolesThroughAPlateAreNoCavity) {
  const Product plate = product_of(perforated_plate(20, 15, 12.0, 8.0, 16.0));  // 300 holes
  ASSERT_TRUE(geometry::examine_topology(plate.mesh).is_closed);
  EXPECT_EQ(geometry::examine_topology(plate.mesh).euler_number, 2 - 2 * 300);
  EXPECT_THAT(plate.notes, Not(Contains(HasSubstr("cavity"))));
  // The outermost lie behind walls of 2 mm; flats of a circle of 8 mm with 16 corners are 7.8 mm
  // apart.
  EXPECT_THAT(plate.notes, Contains(HasSubstr("holes or slots of about 7.")));
}

TEST(ContactBody, SaysWhatItsOptionsAllow) {
  ContactBodyOptions options;
  options.thin_wall = 0.0;
  EXPECT_THROW(options.check(), UsageError);
  options = {};
  options.cavity_sky = 1.0;
  EXPECT_THROW(options.check(), UsageError);
}

}  // namespace
}  // namespace palmar::product
