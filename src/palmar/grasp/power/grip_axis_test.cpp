// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/grip_axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/power/section_stack.h"

namespace palmar::grasp {
namespace {

// Bar of elliptic section about a bent or straight centre line; closed by flat caps.
struct Ring {
  Vec3 centre;
  double half_width = 10.0;      // along y
  double half_thickness = 10.0;  // along z
};

geometry::TriangleMesh bar(const std::vector<Ring>& rings) {
  constexpr int kSides = 48;
  geometry::TriangleMesh mesh;
  for (const Ring& ring : rings) {
    for (int i = 0; i < kSides; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kSides;
      mesh.vertices.push_back(ring.centre + Vec3(0.0, ring.half_width * std::cos(angle),
                                                 ring.half_thickness * std::sin(angle)));
    }
  }
  const int count = static_cast<int>(rings.size());
  for (int k = 0; k + 1 < count; ++k) {
    for (int i = 0; i < kSides; ++i) {
      const int a = k * kSides + i, b = k * kSides + (i + 1) % kSides;
      mesh.triangles.push_back({a, b, a + kSides});
      mesh.triangles.push_back({b, b + kSides, a + kSides});
    }
  }
  const int first = mesh.vertex_count();
  mesh.vertices.push_back(rings.front().centre);
  mesh.vertices.push_back(rings.back().centre);
  for (int i = 0; i < kSides; ++i) {
    const int next = (i + 1) % kSides;
    mesh.triangles.push_back({first, next, i});
    mesh.triangles.push_back({first + 1, (count - 1) * kSides + i, (count - 1) * kSides + next});
  }
  return mesh;
}

geometry::TriangleMesh straight_bar(double length, double half_width, double half_thickness) {
  std::vector<Ring> rings;
  for (double x = -0.5 * length; x <= 0.5 * length + 1e-9; x += length / 50.0) {
    rings.push_back({{x, 0.0, 0.0}, half_width, half_thickness});
  }
  return bar(rings);
}

// A handle of 130 mm with a heavy head across its +x end.
geometry::TriangleMesh hammer() {
  geometry::TriangleMesh mesh = straight_bar(130.0, 14.0, 11.0);
  const geometry::TriangleMesh head = geometry::make_box({45.0, 45.0, 110.0}, 8);
  const int shift = mesh.vertex_count();
  for (const Vec3& v : head.vertices) mesh.vertices.push_back(v + Vec3(80.0, 0.0, 15.0));
  for (const Triangle& t : head.triangles) {
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  return mesh;
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const geometry::Rigid3& motion) {
  for (Vec3& v : mesh.vertices) v = motion * v;
  return mesh;
}

TEST(SectionsAlong, SectionOfAnEllipticBarHasItsAreaGirthAndWidths) {
  const double a = 20.0, b = 12.0;
  const auto sections = sections_along(straight_bar(100.0, a, b), Vec3::UnitX(), 10.0);
  ASSERT_EQ(sections.size(), 10u);
  for (const Section& section : sections) {
    ASSERT_EQ(section.outlines.size(), 1u);
    const SectionOutline& outline = section.outlines.front();
    // A 48-sided polygon in the ellipse: area smaller by sin(2 pi / 48) / (2 pi / 48) = 0.9971.
    EXPECT_NEAR(outline.area, std::numbers::pi * a * b * 0.99715, 0.1);
    // Ramanujan's perimeter of the ellipse; the polygon is 0.07 % shorter.
    const double h = (a - b) * (a - b) / ((a + b) * (a + b));
    const double perimeter =
        std::numbers::pi * (a + b) * (1.0 + 3.0 * h / (10.0 + std::sqrt(4.0 - 3.0 * h)));
    EXPECT_NEAR(outline.girth, perimeter, 0.002 * perimeter);
    EXPECT_NEAR(outline.thickness, 2.0 * b, 0.1);
    EXPECT_NEAR(outline.width, 2.0 * a, 0.1);
    EXPECT_NEAR(std::abs(outline.wide.y()), 1.0, 1e-3);
    EXPECT_NEAR(outline.centroid.x(), section.station, 1e-9);
    EXPECT_NEAR(outline.centroid.y(), 0.0, 1e-9);
  }
}

TEST(SectionsAlong, InnerWallIsLeftOut) {
  geometry::TriangleMesh pipe = straight_bar(100.0, 30.0, 30.0);
  geometry::TriangleMesh bore = straight_bar(90.0, 25.0, 25.0);
  for (Triangle& t : bore.triangles) std::swap(t[0], t[1]);
  const int shift = pipe.vertex_count();
  pipe.vertices.insert(pipe.vertices.end(), bore.vertices.begin(), bore.vertices.end());
  for (const Triangle& t : bore.triangles) {
    pipe.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  for (const Section& section : sections_along(pipe, Vec3::UnitX(), 10.0)) {
    ASSERT_EQ(section.outlines.size(), 1u);
    EXPECT_NEAR(section.outlines.front().thickness, 60.0, 0.2);
  }
}

TEST(SectionsAlong, EmptyMeshHasNoSections) {
  EXPECT_TRUE(sections_along({}, Vec3::UnitX(), 5.0).empty());
}

TEST(FindGripSites, BarIsHeldInItsMiddleAlongItsLength) {
  const auto sites = find_grip_sites(straight_bar(140.0, 18.0, 15.0));
  ASSERT_FALSE(sites.empty());
  EXPECT_GT(std::abs(sites.front().axis.x()), 0.999);
  EXPECT_NEAR(sites.front().point.x(), 0.0, 6.0);  // half a section apart
  EXPECT_LT(sites.front().point.tail<2>().norm(), 0.2);
  EXPECT_NEAR(sites.front().thickness, 30.0, 0.2);
}

TEST(FindGripSites, HammerIsHeldByTheHandleWithTheHeadAtTheThumb) {
  const auto sites = find_grip_sites(hammer());
  ASSERT_FALSE(sites.empty());
  const GripSite& best = sites.front();
  EXPECT_GT(best.axis.x(), 0.99);
  EXPECT_LT(best.point.x(), 5.0);  // handle from -65 to 57
  EXPECT_NEAR(best.thickness, 22.0, 0.5);
  ASSERT_TRUE(best.nose.has_value());
  EXPECT_GT(best.nose->z(), 0.9);  // the head stands out towards +z
}

TEST(FindGripSites, TurningTheProductTurnsTheAnswer) {
  const geometry::Rigid3 motion{Quat(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized())),
                                Vec3(210.0, -35.0, 80.0)};
  const auto plain = find_grip_sites(hammer());
  const auto turned = find_grip_sites(moved(hammer(), motion));
  ASSERT_EQ(plain.size(), turned.size());
  ASSERT_FALSE(plain.empty());
  EXPECT_LT((motion * plain.front().point - turned.front().point).norm(), 0.01);
  EXPECT_GT((motion.rotation * plain.front().axis).dot(turned.front().axis), 1.0 - 1e-6);
}

TEST(FindGripSites, AskedAxisAndPlaceAreKept) {
  GripSearchOptions options;
  options.axis = Vec3::UnitX();
  options.at = Vec3(-20.0, 0.0, 0.0);
  const auto sites = find_grip_sites(straight_bar(200.0, 16.0, 16.0), options);
  ASSERT_FALSE(sites.empty());
  EXPECT_EQ(sites.front().axis, Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(sites.front().point, Vec3(-20.0, 0.0, 0.0));
}

TEST(FindGripSites, HandleThickerScoresWorseThanTheComfortableOne) {
  // 19.7 % of a 190 mm hand is 37 mm (Kong & Lowe 2005).
  const auto best = find_grip_sites(straight_bar(140.0, 18.7, 15.0)).front().score;
  EXPECT_GT(best, find_grip_sites(straight_bar(140.0, 50.0, 40.0)).front().score);
  EXPECT_GT(best, find_grip_sites(straight_bar(140.0, 6.0, 5.0)).front().score);
}

TEST(FindGripSites, EmptyMeshHasNoSite) { EXPECT_TRUE(find_grip_sites({}).empty()); }

}  // namespace
}  // namespace palmar::grasp
