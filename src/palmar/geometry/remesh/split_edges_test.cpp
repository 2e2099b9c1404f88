// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/split_edges.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

/// A box of 60 x 40 x 1 mm: twelve triangles, needles on its rim.
TriangleMesh plate() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(60.0 * (i & 1), 40.0 * (i >> 1 & 1), 1.0 * (i >> 2));
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

TEST(SplitLongEdges, LeavesNoLongEdgeAndTheSameSurface) {
  const TriangleMesh mesh = plate();
  for (const double edge : {30.0, 3.0, 1.2}) {
    const TriangleMesh fine = split_long_edges(mesh, edge);
    EXPECT_LE(edge_lengths(fine).longest, edge) << edge;
    EXPECT_NEAR(surface_area(fine), 2.0 * (60 * 40 + 60 + 40), 1e-6) << edge;  // mm^2
    EXPECT_NEAR(signed_volume(fine), 60.0 * 40.0, 1e-6) << edge;               // mm^3
    EXPECT_NO_THROW(require_closed_manifold(fine, "plate")) << edge;
    for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(fine.vertices[v], mesh.vertices[v]);
  }
}

TEST(SplitLongEdges, DoesNotMakeMoreTrianglesThanTheAreaAsksFor) {
  // Triangles with edges from edge / 2 to edge have at least about a tenth of edge^2.
  const TriangleMesh fine = split_long_edges(plate(), 3.0);
  EXPECT_LT(fine.triangle_count(), surface_area(fine) / (0.1 * 9.0));
}

TEST(SplitLongEdges, KnowsTheParentOfEveryTriangle) {
  const TriangleMesh mesh = plate();
  const SplitMesh split = split_with_parents(mesh, 3.0);
  ASSERT_EQ(split.parent.size(), split.mesh.triangles.size());
  std::vector<double> area(mesh.triangles.size(), 0.0);
  const auto normal = [](const TriangleMesh& m, std::size_t i) -> Vec3 {
    const Triangle& t = m.triangles[i];
    return 0.5 * (m.vertices[t[1]] - m.vertices[t[0]]).cross(m.vertices[t[2]] - m.vertices[t[0]]);
  };
  for (std::size_t i = 0; i < split.parent.size(); ++i) {
    const auto parent = static_cast<std::size_t>(split.parent[i]);
    const Vec3 n = normal(split.mesh, i), above = normal(mesh, parent);
    area[parent] += n.norm();
    EXPECT_GT(n.normalized().dot(above.normalized()), 1.0 - 1e-9);
    const Vec3& on_it = mesh.vertices[mesh.triangles[parent][0]];
    EXPECT_NEAR((split.mesh.vertices[split.mesh.triangles[i][0]] - on_it).dot(above.normalized()),
                0.0, 1e-9);
  }
  // The parts of a triangle are together as large as it is.
  for (std::size_t i = 0; i < area.size(); ++i) EXPECT_NEAR(area[i], normal(mesh, i).norm(), 1e-6);
}

TEST(SplitLongEdges, ShortEdgesStay) {
  const TriangleMesh mesh = plate();
  const TriangleMesh same = split_long_edges(mesh, 80.0);
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_TRUE(split_long_edges({}, 3.0).vertices.empty());
}

TEST(SplitLongEdges, RefinesOnlyWhereChosen) {
  const auto is_left = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::min({a.x(), b.x(), c.x()}) < 10.0;
  };
  const TriangleMesh fine = split_long_edges(plate(), 2.0, is_left);
  EXPECT_NO_THROW(require_closed_manifold(fine, "plate"));
  int long_ones = 0;
  for (const Triangle& t : fine.triangles) {
    const Vec3 &a = fine.vertices[t[0]], &b = fine.vertices[t[1]], &c = fine.vertices[t[2]];
    const double longest = std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()});
    if (is_left(a, b, c)) {
      EXPECT_LE(longest, 2.0);
    } else if (longest > 2.0) {
      ++long_ones;
    }
  }
  EXPECT_GT(long_ones, 0);
}

TEST(SplitLongEdges, NamesWhatItCannotUse) {
  try {
    split_long_edges(plate(), 0.0);
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "split edges: edge length is 0 mm; 0.1 to 1000 mm is required");
  }
  TriangleMesh broken = plate();
  broken.triangles[3][1] = 8;
  try {
    split_long_edges(broken, 3.0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "split edges: triangle 3 names vertex 8 of 8");
  }
}

}  // namespace
}  // namespace palmar::geometry
