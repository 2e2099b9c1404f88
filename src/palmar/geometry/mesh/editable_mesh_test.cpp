// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/editable_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

// What must hold between the arrays of a 2-manifold mesh.
void expect_sound(const EditableMesh& mesh) {
  for (int h = 0; h < mesh.half_edge_capacity(); ++h) {
    if (!mesh.has_half_edge(h)) continue;
    ASSERT_TRUE(mesh.has_vertex(mesh.start(h)));
    const int g = mesh.twin(h);
    if (g < 0) continue;
    ASSERT_TRUE(mesh.has_half_edge(g));
    ASSERT_EQ(mesh.twin(g), h);
    ASSERT_EQ(mesh.start(g), mesh.end(h));
    ASSERT_EQ(mesh.end(g), mesh.start(h));
  }
  for (int v = 0; v < mesh.vertex_capacity(); ++v) {
    if (!mesh.has_vertex(v)) continue;
    const int first = mesh.outgoing(v);
    ASSERT_TRUE(mesh.has_half_edge(first));
    ASSERT_EQ(mesh.start(first), v);
    // A border vertex' own half-edge must be the one on the border: a full turn would end there.
    int steps = 0;
    for (int h = first; h >= 0;) {
      ASSERT_LT(++steps, 1000);
      h = mesh.turn(h);
      if (h == first) break;
      if (h < 0) {
        ASSERT_TRUE(mesh.is_border_vertex(v));
      }
    }
  }
}

void expect_same_kind(const TopologyReport& report, const TopologyReport& original) {
  EXPECT_EQ(report.euler_number, original.euler_number);
  EXPECT_EQ(report.boundary_loops, original.boundary_loops);
  EXPECT_EQ(report.components, original.components);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_TRUE(report.is_oriented);
}

TEST(EditableMesh, StaysSoundUnderRandomOperations) {
  const std::vector<TriangleMesh> meshes{
      make_icosphere(1.0, 0),
      make_icosphere(1.0, 2),
      make_torus(3.0, 1.0, 7, 5),
      make_grid_patch(5, 4, 1.0),
      make_box({1, 1, 1}),
      make_cylinder({.radius = 1, .length = 2, .segments = 6, .rings = 2, .is_capped = false})};
  for (size_t m = 0; m < meshes.size(); ++m) {
    std::mt19937 random(static_cast<unsigned>(m) + 11);
    const TopologyReport original = examine_topology(meshes[m]);
    EditableMesh mesh(meshes[m]);
    int done = 0;
    for (int step = 0; step < 3000; ++step) {
      const int h = static_cast<int>(random() % static_cast<unsigned>(mesh.half_edge_capacity()));
      if (!mesh.has_half_edge(h)) continue;
      switch (random() % 5) {
        case 0:
          mesh.split(h, 0.5 * (mesh.position(mesh.start(h)) + mesh.position(mesh.end(h))));
          ++done;
          break;
        case 1:
        case 2:
          done += mesh.collapse(h);
          break;
        default:
          done += mesh.flip(h);
      }
      if (step % 50 == 0) {
        expect_sound(mesh);
        if (testing::Test::HasFatalFailure()) return;
        expect_same_kind(examine_topology(mesh.compacted().mesh), original);
      }
    }
    EXPECT_GT(done, 100);
    expect_sound(mesh);
    expect_same_kind(examine_topology(mesh.compacted().mesh), original);
  }
}

TEST(EditableMesh, CollapsesASphereNoFurtherThanATetrahedron) {
  EditableMesh mesh(make_icosphere(1.0, 2));
  for (bool changes = true; changes;) {
    changes = false;
    for (int h = 0; h < mesh.half_edge_capacity(); ++h) {
      if (mesh.has_half_edge(h) && mesh.collapse(h)) changes = true;
    }
  }
  const TopologyReport report = examine_topology(mesh.compacted().mesh);
  EXPECT_EQ(report.used_vertices, 4);
  EXPECT_EQ(report.triangles, 4);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
}

TEST(EditableMesh, RefusesACollapseThatWouldPinchATorus) {
  // Three segments round the tube: its circumference is a loop of three edges that bounds nothing.
  EditableMesh mesh(make_torus(3.0, 1.0, 8, 3));
  int refused = 0;
  for (int h = 0; h < mesh.half_edge_capacity(); ++h) {
    const bool is_round_tube = mesh.start(h) / 3 == mesh.end(h) / 3;
    if (!is_round_tube) continue;
    EXPECT_FALSE(mesh.can_collapse(h));
    ++refused;
  }
  EXPECT_EQ(refused, 2 * 8 * 3);
}

TEST(EditableMesh, FlippingTwiceTurnsTheEdgeRound) {
  const TriangleMesh original = make_icosphere(1.0, 1);
  EditableMesh mesh(original);
  const int a = mesh.start(10), b = mesh.end(10), c = mesh.apex(10), d = mesh.apex(mesh.twin(10));
  ASSERT_TRUE(mesh.flip(10));
  EXPECT_EQ(mesh.start(10), c);
  EXPECT_EQ(mesh.end(10), d);
  ASSERT_TRUE(mesh.flip(10));
  EXPECT_EQ(mesh.start(10), b);
  EXPECT_EQ(mesh.end(10), a);
  expect_sound(mesh);
}

TEST(EditableMesh, NeverMovesABorder) {
  EditableMesh mesh(make_grid_patch(3, 3, 1.0));
  for (int h = 0; h < mesh.half_edge_capacity(); ++h) {
    if (!mesh.has_half_edge(h)) continue;
    if (mesh.twin(h) < 0) {
      EXPECT_FALSE(mesh.can_flip(h));
      EXPECT_FALSE(mesh.can_collapse(h));
    }
    if (mesh.is_border_vertex(mesh.start(h))) {
      EXPECT_FALSE(mesh.can_collapse(h));
    }
  }
}

TEST(EditableMesh, SplitPutsAVertexOfFourNeighboursOnTheEdge) {
  EditableMesh mesh(make_icosphere(1.0, 0));
  const int v = mesh.split(0, Vec3(1, 2, 3));
  EXPECT_EQ(mesh.valence(v), 4);
  EXPECT_EQ(mesh.position(v), Vec3(1, 2, 3));
  EXPECT_EQ(examine_topology(mesh.compacted().mesh).triangles, 22);
  EditableMesh patch(make_grid_patch(1, 1, 1.0));
  const int w = patch.split(0, Vec3(0.5, 0, 0));
  EXPECT_EQ(patch.valence(w), 3);
  EXPECT_TRUE(patch.is_border_vertex(w));
}

TEST(EditableMesh, RefusesNonManifoldInput) {
  TriangleMesh fan;
  for (int i = 0; i < 5; ++i) fan.vertices.emplace_back(i, i * i, 0);
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_THROW(EditableMesh{fan}, InputError);
  fan.triangles = {{0, 1, 2}, {0, 3, 4}};  // bow tie
  EXPECT_THROW(EditableMesh{fan}, InputError);
  EXPECT_NO_THROW(EditableMesh{TriangleMesh{}});
}

}  // namespace
}  // namespace palmar::geometry
