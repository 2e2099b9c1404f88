// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/pressed_shape.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/self_intersection.h"
#include "palmar/hand/mirror.h"
#include "palmar/product/primitives.h"
#include "palmar/redesign/press_limits.h"

namespace palmar::redesign {
namespace {

constexpr double kRadius = 12.0;  // of the ball, mm: about a thumb's
constexpr double kDepth = 3.0;    // mm, to which the ball reaches into the plate

/// Plate of 60 x 60 x `thickness` whose top is z = 0, sharp edges.
product::Product plate(double thickness = 20.0) {
  product::Product product = product::make_prism_product(
      {.width = 60, .depth = 60, .length = thickness, .fillet_radius = 0});
  for (Vec3& x : product.mesh.vertices) x.z() -= 0.5 * thickness;
  product.distance = std::make_shared<const geometry::MeshDistance>(product.mesh);
  return product;
}

geometry::TriangleMesh ball_at(const Vec3& centre) {
  geometry::TriangleMesh ball = geometry::make_icosphere(kRadius, 5);
  for (Vec3& x : ball.vertices) x += centre;
  return ball;
}
/// Reaches kDepth into the plate's top at (x, y).
geometry::TriangleMesh ball_on_top(double x = 0.0, double y = 0.0) {
  return ball_at({x, y, kRadius - kDepth});
}

/// Nothing between the skin and the shape: no smoothing, no limit in reach.
PressedShapeOptions plain(double share) {
  PressedShapeOptions options;
  options.share = share;
  options.smoothing = 0.0;
  options.depth_limit = 20.0;
  options.wall = 0.0;
  options.edge_length = 1.0;
  return options;
}

double cap_volume(double depth) {
  return std::numbers::pi * depth * depth * (3.0 * kRadius - depth) / 3.0;
}

PressedShape press(const product::Product& product,
                   const std::vector<geometry::TriangleMesh>& skins,
                   const PressedShapeOptions& options) {
  return press_shape(product, skins, options);
}

TEST(PressShape, ZeroShareLeavesTheProduct) {
  const product::Product product = plate();
  const PressedShape shape = press(product, {ball_on_top()}, plain(0.0));
  EXPECT_EQ(shape.mesh.vertices, shape.before);
  EXPECT_EQ(shape.removed_volume, 0.0);
  EXPECT_EQ(shape.deepest, 0.0);
  EXPECT_NEAR(geometry::signed_volume(shape.mesh), geometry::signed_volume(product.mesh), 1e-6);
}

TEST(PressShape, HandThatTouchesNothingLeavesTheProductTriangleByTriangle) {
  const product::Product product = plate();
  const PressedShape shape = press(product, {ball_at({0, 0, 100})}, plain(1.0));
  EXPECT_EQ(shape.mesh.vertices, product.mesh.vertices);
  EXPECT_EQ(shape.mesh.triangles, product.mesh.triangles);
}

TEST(PressShape, BallLeavesItsCap) {
  const product::Product product = plate();
  const PressedShape shape = press(product, {ball_on_top()}, plain(1.0));
  for (std::size_t v = 0; v < shape.before.size(); ++v) {
    const Vec3& x = shape.before[v];
    if (x.z() != 0.0) continue;
    const double r = std::hypot(x.x(), x.y());
    const double cap =
        r < kRadius ? std::sqrt(kRadius * kRadius - r * r) - (kRadius - kDepth) : 0.0;
    // Facets of the ball lie up to 0.015 mm within it.
    EXPECT_NEAR(shape.depth[v], std::max(0.0, cap), 0.03) << x.transpose();
  }
  EXPECT_NEAR(shape.removed_volume / cap_volume(kDepth), 1.0, 0.02);
  EXPECT_NEAR(shape.deepest, kDepth, 0.03);
  EXPECT_NEAR(geometry::signed_volume(product.mesh) - geometry::signed_volume(shape.mesh),
              shape.removed_volume, 1e-6);
  EXPECT_NEAR(shape.thinnest_wall, 20.0 - kDepth, 0.03);
}

TEST(PressShape, ShareScalesTheCap) {
  const PressedShape half = press(plate(), {ball_on_top()}, plain(0.5));
  EXPECT_NEAR(half.removed_volume / (0.5 * cap_volume(kDepth)), 1.0, 0.02);
  EXPECT_NEAR(half.deepest, 0.5 * kDepth, 0.03);
}

TEST(PressShape, SmoothingRoundsTheRimAndKeepsAboutTheVolume) {
  PressedShapeOptions options = plain(1.0);
  options.smoothing = 1.5;
  options.rim_width = 8.0;
  const PressedShape shape = press(plate(), {ball_on_top()}, options);
  // Diffusion keeps the volume; rounding the rim takes a little more.
  EXPECT_NEAR(shape.removed_volume / cap_volume(kDepth), 1.0, 0.08);
  EXPECT_LT(shape.deepest, kDepth);
  EXPECT_GT(shape.deepest, 0.8 * kDepth);
  // No kink: neighbouring triangles of the top meet at less than the ball's rim does (41 degrees).
  double steepest = 0.0;
  const std::vector<Vec3> normals = geometry::triangle_normals(shape.mesh);
  const geometry::MeshTopology topology = geometry::build_topology(shape.mesh);
  for (std::size_t h = 0; h < topology.twin.size(); ++h) {
    if (topology.twin[h] < 0) continue;
    const auto t = h / 3;
    const auto u = topology.twin[h] / 3;
    if (normals[t].z() < 0.5 || normals[u].z() < 0.5) continue;
    steepest = std::max(steepest, std::acos(std::clamp(normals[t].dot(normals[u]), -1.0, 1.0)));
  }
  EXPECT_LT(steepest, 0.25);
}

TEST(PressShape, AtASharpEdgeTheSurfaceComesToLieOnTheSkin) {
  const product::Product product = plate(40.0);
  // Touches the edge x = 30, z = 0 from outside, at 45 degrees.
  const Vec3 centre = Vec3(30, 0, 0) + (kRadius - 3.0) * Vec3(1, 0, 1).normalized();
  const PressedShape shape = press(product, {ball_at(centre)}, plain(1.0));
  int pressed = 0;
  for (std::size_t v = 0; v < shape.before.size(); ++v) {
    if (shape.depth[v] <= 0.0) continue;
    ++pressed;
    EXPECT_NEAR((shape.mesh.vertices[v] - centre).norm(), kRadius, 0.03);
  }
  EXPECT_GT(pressed, 50);
  EXPECT_TRUE(geometry::find_self_crossings(shape.mesh).empty());
}

TEST(PressShape, DepthLimitHolds) {
  PressedShapeOptions options = plain(1.0);
  options.depth_limit = 1.5;
  const PressedShape shape = press(plate(), {ball_on_top()}, options);
  EXPECT_LE(shape.deepest, 1.5);
  EXPECT_GT(shape.deepest, 1.4);
  EXPECT_GT(shape.limited_by_depth, 50.0);
}

TEST(PressShape, WallRemains) {
  PressedShapeOptions options = plain(1.0);
  options.wall = 3.0;
  // From both sides of a plate of 6 mm, 3 mm each.
  const PressedShape shape =
      press(plate(6.0), {ball_on_top(), ball_at({0, 0, -6.0 - kRadius + kDepth})}, options);
  EXPECT_GE(shape.thinnest_wall, 3.0 - 1e-3);
  EXPECT_GT(shape.limited_by_wall, 0.0);
  EXPECT_GT(shape.deepest, 0.5);
}

TEST(PressShape, WallThatIsTooThinAlreadyStays) {
  PressedShapeOptions options = plain(1.0);
  options.wall = 7.0;
  const PressedShape shape = press(plate(6.0), {ball_on_top()}, options);
  EXPECT_EQ(shape.deepest, 0.0);
}

TEST(PressShape, KeptBoxStaysAsItIs) {
  PressedShapeOptions options = plain(1.0);
  options.keep_out.boxes = {Box3(Vec3(0.3, -40, -30), Vec3(40, 40, 1))};
  const PressedShape shape = press(plate(), {ball_on_top()}, options);
  for (std::size_t v = 0; v < shape.before.size(); ++v) {
    if (shape.before[v].x() >= 0.3) {
      EXPECT_EQ(shape.mesh.vertices[v], shape.before[v]);
    }
  }
  EXPECT_GT(shape.deepest, 0.5);
  EXPECT_GT(shape.limited_by_keep_out, 50.0);
}

TEST(PressShape, KeptFaceStaysAsItIsAndFacesFollowTheTriangles) {
  const product::Product prism =
      product::make_prism_product({.width = 35, .depth = 35, .length = 60, .fillet_radius = 3});
  ASSERT_TRUE(prism.faces);
  // On the fillet between right (+x) and back (+y).
  const Vec3 centre = Vec3(17.5, 17.5, 0) + 0.6 * kRadius * Vec3(1, 1, 0).normalized();
  PressedShapeOptions options = plain(1.0);
  options.keep_out.names = {"right"};
  options.keep_out.blend = 2.0;
  const PressedShape shape = press(prism, {ball_at(centre)}, options);
  EXPECT_GT(shape.deepest, 0.5);
  const product::Product pressed = pressed_product(prism, shape, "pressed");
  ASSERT_TRUE(pressed.faces);
  ASSERT_EQ(pressed.faces->face_of_triangle.size(), pressed.mesh.triangles.size());
  for (std::size_t t = 0; t < pressed.mesh.triangles.size(); ++t) {
    const int face = pressed.faces->face_of_triangle[t];
    ASSERT_GE(face, 0);
    if (pressed.faces->face[face].name != "right") continue;
    for (const int v : pressed.mesh.triangles[t]) {
      EXPECT_EQ(shape.depth[v], 0.0);
      EXPECT_NEAR(shape.mesh.vertices[v].x(), 17.5, 1e-9);
    }
  }
}

TEST(PressShape, MirroredHandAndProductGiveTheMirroredShape) {
  const product::Product product = plate(40.0);
  const geometry::TriangleMesh hand = ball_at({29.0, 3.0, 7.0});
  const auto mirrored = [](geometry::TriangleMesh mesh) {
    for (Vec3& x : mesh.vertices) x.x() = -x.x();
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
  };
  product::Product other = product;
  other.mesh = mirrored(product.mesh);
  other.distance = std::make_shared<const geometry::MeshDistance>(other.mesh);
  other.faces = nullptr;
  PressedShapeOptions options = plain(0.7);
  options.smoothing = 2.0;
  const PressedShape a = press(product, {hand}, options);
  const PressedShape b = press(other, {mirrored(hand)}, options);
  // Triangles, 1 mm long, are others there; imprint and smoothing see the surface through them.
  const geometry::MeshDistance surface(b.mesh);
  for (const Vec3& x : a.mesh.vertices) {
    EXPECT_LT(std::abs(surface.at({-x.x(), x.y(), x.z()}).distance), 0.05);
  }
  EXPECT_NEAR(b.removed_volume / a.removed_volume, 1.0, 0.005);
  EXPECT_NEAR(b.deepest, a.deepest, 0.01);
}

TEST(PressShape, StaysClosedAndWholeAndNeverGrows) {
  const product::Product product = plate(30.0);
  PressedShapeOptions options;
  options.share = 1.0;
  options.wall = 1.0;
  // Into a corner, where three faces meet.
  const PressedShape shape = press(product, {ball_at({32, 32, 1}), ball_on_top(5, 5)}, options);
  EXPECT_GT(shape.deepest, 2.0);
  EXPECT_TRUE(geometry::examine_topology(shape.mesh).is_closed);
  EXPECT_TRUE(geometry::examine_topology(shape.mesh).is_oriented);
  EXPECT_TRUE(geometry::find_self_crossings(shape.mesh).empty());
  EXPECT_LT(geometry::signed_volume(shape.mesh), geometry::signed_volume(product.mesh));
  for (std::size_t v = 0; v < shape.depth.size(); ++v) {
    EXPECT_GE(shape.depth[v], 0.0);
    EXPECT_LE(product.distance->at(shape.mesh.vertices[v]).distance, 1e-6);
  }
}

TEST(PressShape, OrderOfHandsAndThreadsDontMatter) {
  const product::Product product = plate();
  const std::vector<geometry::TriangleMesh> hands = {ball_on_top(), ball_on_top(4, 1),
                                                     ball_on_top(-3, 7)};
  const std::vector<geometry::TriangleMesh> turned = {hands[2], hands[0], hands[1]};
  PressedShapeOptions options;
  options.align_along = Vec3::UnitX();
  set_thread_count(1);
  const PressedShape one = press(product, hands, options);
  set_thread_count(4);
  const PressedShape four = press(product, turned, options);
  set_thread_count(0);
  EXPECT_EQ(one.mesh.vertices, four.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, four.mesh.triangles);
  EXPECT_EQ(one.shift[0], four.shift[1]);
}

TEST(PressShape, ElsewhereTheSurfaceStaysAndOfAScanItsTriangles) {
  const product::Product cad = plate();
  product::Product scan = cad;
  scan.faces = nullptr;
  // The imprint, what its smoothing and its rim need, and marks 2 mm apart.
  const auto is_elsewhere = [](const Vec3& x) {
    return std::hypot(x.x() - 20, x.y() - 20) > 30.0 || x.z() < -15.0;
  };
  for (const product::Product* product :
       std::initializer_list<const product::Product*>{&cad, &scan}) {
    const PressedShape shape = press(*product, {ball_on_top(20, 20)}, {});
    const geometry::MeshDistance before(product->mesh), after(shape.mesh);
    std::set<std::array<double, 3>> there;
    int elsewhere = 0;
    for (const Vec3& x : shape.mesh.vertices) {
      there.insert({x.x(), x.y(), x.z()});
      if (!is_elsewhere(x)) continue;
      EXPECT_NEAR(before.at(x).distance, 0.0, 1e-9);
      ++elsewhere;
    }
    EXPECT_GT(elsewhere, 4);
    for (const Vec3& x : product->mesh.vertices) {
      if (!is_elsewhere(x)) continue;
      EXPECT_NEAR(after.at(x).distance, 0.0, 1e-9);
      EXPECT_TRUE(product == &cad || there.count({x.x(), x.y(), x.z()}) > 0) << x.transpose();
    }
  }
}

TEST(PressShape, RefusesWhatCantBe) {
  const product::Product product = plate();
  PressedShapeOptions options;
  options.share = 1.2;
  EXPECT_THAT([&] { press(product, {ball_on_top()}, options); },
              ::testing::ThrowsMessage<UsageError>(
                  ::testing::HasSubstr("setting \"share\" is 1.2; 0 to 1")));
  EXPECT_THAT([&] { press(product, {}, {}); },
              ::testing::ThrowsMessage<UsageError>(::testing::HasSubstr("no hands")));
  options = {};
  options.keep_out.faces = {99};
  EXPECT_THAT([&] { press(product, {ball_on_top()}, options); },
              ::testing::ThrowsMessage<UsageError>(::testing::HasSubstr("no face 99")));
  product::Product bare = product;
  bare.faces = nullptr;
  EXPECT_THAT([&] { press(bare, {ball_on_top()}, options); },
              ::testing::ThrowsMessage<UsageError>(::testing::HasSubstr("without faces of CAD")));
}

TEST(HeldBelow, HasNoKinkAndNeverReachesTheLimit) {
  double last = 0.0, last_slope = 1.0;
  for (double d = 0.01; d < 20.0; d += 0.01) {
    const double held = held_below(d, 2.0);
    const double slope = (held - last) / 0.01;
    EXPECT_LE(held, 2.0);
    EXPECT_LE(held, d + 1e-12);
    EXPECT_GE(slope, -1e-9);
    EXPECT_LT(std::abs(slope - last_slope), 0.03);
    last = held;
    last_slope = slope;
  }
  EXPECT_EQ(held_below(1.5, 2.0), 1.5);
  EXPECT_EQ(held_below(1.0, 0.0), 0.0);
}

}  // namespace
}  // namespace palmar::redesign
