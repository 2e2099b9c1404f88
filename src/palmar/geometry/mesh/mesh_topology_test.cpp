// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/mesh_topology.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TriangleMesh with_vertices(int count, std::vector<Triangle> triangles) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) mesh.vertices.emplace_back(i, i * i, i * i * i);
  mesh.triangles = std::move(triangles);
  return mesh;
}

const std::vector<Triangle> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

TEST(BuildTopology, TetrahedronHasSixEdgesEachSharedByTwo) {
  const TriangleMesh mesh = with_vertices(4, kTetrahedron);
  const MeshTopology topology = build_topology(mesh);
  EXPECT_THAT(topology.edge, ElementsAre(std::array{0, 1}, std::array{0, 2}, std::array{0, 3},
                                         std::array{1, 2}, std::array{1, 3}, std::array{2, 3}));
  EXPECT_THAT(topology.edge_use, ElementsAre(2, 2, 2, 2, 2, 2));
  for (size_t h = 0; h < 12; ++h) {
    const auto twin = static_cast<std::size_t>(topology.twin[h]);
    EXPECT_EQ(topology.twin[twin], static_cast<int>(h));
    EXPECT_EQ(mesh.triangles[h / 3][h % 3], mesh.triangles[twin / 3][(twin + 1) % 3]);
    EXPECT_EQ(topology.edge_of[h], topology.edge_of[twin]);
  }
  for (int v = 0; v < 4; ++v) {
    for (const int h : topology.outgoing(v)) {
      EXPECT_EQ(mesh.triangles[h / 3][h % 3], v);
    }
    EXPECT_EQ(topology.outgoing(v).size(), 3U);
  }
}

TEST(BuildTopology, RefusesACornerOutsideTheVertexList) {
  try {
    build_topology(with_vertices(3, {{0, 1, 2}, {0, 1, 3}}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "mesh: triangle 1 names vertex 3; there are 3 vertices");
  }
  EXPECT_THROW(build_topology(with_vertices(3, {{0, -1, 2}})), InputError);
}

TEST(ExamineTopology, OfAnEmptyMeshIsNeitherClosedNorManifold) {
  const TopologyReport report = examine_topology(TriangleMesh{});
  EXPECT_FALSE(report.is_closed);
  EXPECT_FALSE(report.is_two_manifold);
  EXPECT_EQ(report.components, 0);
  EXPECT_EQ(report.euler_number, 0);
}

TEST(ExamineTopology, SingleTriangleIsAnOpenDisc) {
  const TopologyReport report = examine_topology(with_vertices(5, {{0, 1, 2}}));
  EXPECT_EQ(report.used_vertices, 3);
  EXPECT_EQ(report.boundary_edges, 3);
  EXPECT_EQ(report.boundary_loops, 1);
  EXPECT_EQ(report.euler_number, 1);
  EXPECT_TRUE(report.is_two_manifold);
  EXPECT_TRUE(report.is_oriented);
  EXPECT_FALSE(report.is_closed);
}

TEST(ExamineTopology, FanOfThreeTrianglesAtOneEdgeIsNonManifold) {
  const TriangleMesh mesh = with_vertices(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const MeshTopology topology = build_topology(mesh);
  const TopologyReport report = examine_topology(mesh, topology);
  EXPECT_THAT(non_manifold_edges(topology), ElementsAre(std::array{0, 1}));
  EXPECT_THAT(non_manifold_vertices(mesh, topology), ElementsAre(0, 1));
  EXPECT_EQ(report.boundary_edges, 6);
  EXPECT_FALSE(report.is_two_manifold);
  EXPECT_FALSE(report.is_oriented);
}

TEST(ExamineTopology, BowTieVertexIsNonManifoldThoughEveryEdgeIsFine) {
  const TriangleMesh open = with_vertices(5, {{0, 1, 2}, {0, 3, 4}});
  EXPECT_THAT(non_manifold_vertices(open, build_topology(open)), ElementsAre(0));
  // Two tetrahedra tip to tip: closed, but not 2-manifold.
  TriangleMesh closed = with_vertices(7, kTetrahedron);
  for (const Triangle& t : kTetrahedron) {
    Triangle other;
    for (size_t k = 0; k < 3; ++k) other[k] = t[k] == 0 ? 0 : t[k] + 3;
    closed.triangles.push_back(other);
  }
  const TopologyReport report = examine_topology(closed);
  EXPECT_TRUE(report.is_closed);
  EXPECT_EQ(report.non_manifold_edges, 0);
  EXPECT_EQ(report.non_manifold_vertices, 1);
  EXPECT_FALSE(report.is_two_manifold);
  EXPECT_EQ(report.components, 1);
}

TEST(ExamineTopology, FlippedTriangleDisagreesAtItsThreeEdges) {
  TriangleMesh mesh = make_icosphere(1.0, 1);
  std::swap(mesh.triangles[7][0], mesh.triangles[7][1]);
  const TopologyReport report = examine_topology(mesh);
  EXPECT_EQ(report.inconsistent_edges, 3);
  EXPECT_FALSE(report.is_oriented);
  EXPECT_TRUE(report.is_two_manifold);
}

TEST(ExamineTopology, CollapsedTriangleTakesNoPart) {
  TriangleMesh mesh = with_vertices(4, kTetrahedron);
  mesh.triangles.push_back({2, 2, 3});
  const TopologyReport report = examine_topology(mesh);
  EXPECT_EQ(report.collapsed_triangles, 1);
  EXPECT_EQ(report.triangles, 4);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_FALSE(report.is_two_manifold);
}

TEST(ExamineTopology, CountsComponentsAndHandles) {
  TriangleMesh mesh = make_torus(3.0, 1.0, 12, 8);
  const TriangleMesh sphere = make_icosphere(1.0, 1);
  const int shift = mesh.vertex_count();
  mesh.vertices.insert(mesh.vertices.end(), sphere.vertices.begin(), sphere.vertices.end());
  for (const Triangle& t : sphere.triangles) {
    mesh.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  }
  const TopologyReport report = examine_topology(mesh);
  EXPECT_EQ(report.components, 2);
  EXPECT_EQ(report.euler_number, 0 + 2);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
  const auto component = triangle_components(mesh, build_topology(mesh));
  EXPECT_EQ(component.front(), 0);
  EXPECT_EQ(component.back(), 1);
}

TEST(VertexNeighbours, AreAscendingAndMutual) {
  const TriangleMesh mesh = make_icosphere(1.0, 2);
  const auto neighbours = vertex_neighbours(build_topology(mesh));
  int fives = 0;
  for (size_t v = 0; v < neighbours.size(); ++v) {
    EXPECT_TRUE(std::is_sorted(neighbours[v].begin(), neighbours[v].end()));
    fives += neighbours[v].size() == 5;
    for (const int n : neighbours[v]) {
      EXPECT_THAT(neighbours[n], ::testing::Contains(static_cast<int>(v)));
    }
  }
  EXPECT_EQ(fives, 12);  // an icosphere has twelve vertices of five neighbours, else six
}

TEST(RequireClosedManifold, NamesTheObjectAndItsFault) {
  EXPECT_NO_THROW(require_closed_manifold(make_icosphere(1.0, 0), "ball"));
  const auto message_of = [](const TriangleMesh& mesh) {
    try {
      require_closed_manifold(mesh, "hand skin");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  TriangleMesh mesh = make_icosphere(1.0, 1);
  mesh.triangles.pop_back();
  EXPECT_THAT(message_of(mesh), HasSubstr("hand skin: 3 edges are on 1 open borders"));
  EXPECT_THAT(message_of({}), HasSubstr("no triangles"));
}

}  // namespace
}  // namespace palmar::geometry
