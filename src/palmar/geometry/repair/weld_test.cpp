// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/repair/weld.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

using ::testing::ElementsAre;

// Every triangle with three vertices of its own, as in an STL file.
TriangleMesh soup_of(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const int first = soup.vertex_count();
    for (const int v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

TEST(Weld, MakesASoupTheClosedMeshItWas) {
  const TriangleMesh mesh = make_torus(20.0, 5.0, 24, 12);
  const WeldResult result = weld(soup_of(mesh));
  EXPECT_EQ(result.mesh.vertex_count(), mesh.vertex_count());
  EXPECT_EQ(result.mesh.triangle_count(), mesh.triangle_count());
  const TopologyReport report = examine_topology(result.mesh);
  EXPECT_TRUE(report.is_closed && report.is_two_manifold && report.is_oriented);
  EXPECT_EQ(report.euler_number, 0);
  EXPECT_DOUBLE_EQ(signed_volume(result.mesh), signed_volume(mesh));
}

TEST(Weld, WithinTheToleranceBringsNoisyCopiesTogether) {
  TriangleMesh soup = soup_of(make_icosphere(10.0, 3));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> noise(-1e-3, 1e-3);
  for (Vec3& v : soup.vertices) v += Vec3(noise(random), noise(random), noise(random));
  EXPECT_FALSE(examine_topology(weld(soup).mesh).is_closed);
  const WeldResult result = weld(soup, {.tolerance = 0.01});
  EXPECT_TRUE(examine_topology(result.mesh).is_closed);
  EXPECT_EQ(result.mesh.vertex_count(), 642);
  for (size_t v = 0; v < soup.vertices.size(); ++v) {
    const int to = result.new_of_old[v];
    EXPECT_LE((soup.vertices[v] - result.mesh.vertices[to]).norm(), 0.01);
  }
}

TEST(Weld, KeepsGroupsApartThatTouch) {
  // Two tetrahedra on both sides of one face, every triangle with vertices of its own.
  const std::vector<Vec3> corners = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {2, 2, 9}, {2, 2, -9}};
  TriangleMesh both;
  both.vertices = corners;
  both.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3},   // above
                    {0, 1, 2}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}};  // below
  const TriangleMesh soup = soup_of(both);
  const std::vector<int> groups = {0, 0, 0, 0, 1, 1, 1, 1};
  const WeldResult apart = weld(soup, {.tolerance = 0.1, .groups = groups});
  EXPECT_EQ(apart.mesh.vertex_count(), 8);
  EXPECT_EQ(apart.mesh.triangle_count(), 8);
  EXPECT_EQ(apart.dropped_duplicate, 0);
  EXPECT_TRUE(examine_topology(apart.mesh).is_two_manifold);
  const WeldResult together = weld(soup, {.tolerance = 0.1});
  EXPECT_EQ(together.mesh.vertex_count(), 5);
  EXPECT_EQ(together.dropped_duplicate, 1);
  EXPECT_THROW(weld(soup, {.groups = {0, 1}}), InputError);
}

TEST(Weld, DoesNotRunAlongAChain) {
  // Points 0.6 apart under a tolerance of 1: 0 takes 1; 2 is farther from 0, so it is kept,
  // takes 3.
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.vertices.emplace_back(0.6 * i, 0.0, 0.0);
  const WeldResult result = weld(mesh, {.tolerance = 1.0, .drops_unused_vertices = false});
  EXPECT_THAT(result.new_of_old, ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(result.old_of_new, ElementsAre(0, 2));
  EXPECT_EQ(result.merged_vertices, 2);
}

TEST(Weld, FindsNeighboursAcrossCellBordersAndNegativeCoordinates) {
  TriangleMesh mesh;
  mesh.vertices = {{-1e-9, -1e-9, -1e-9},
                   {1e-9, 1e-9, 1e-9},
                   {-3.0, 2.0, 1.0},
                   {-3.0 - 0.09, 2.0, 1.0},
                   {-0.0, 0.0, 0.0}};
  const WeldResult result = weld(mesh, {.tolerance = 0.1, .drops_unused_vertices = false});
  EXPECT_THAT(result.new_of_old, ElementsAre(0, 0, 1, 1, 0));
}

TEST(Weld, TreatsBothZerosAsEqual) {
  TriangleMesh mesh;
  mesh.vertices = {{0.0, 0.0, 1.0}, {-0.0, 0.0, 1.0}, {-0.0, -0.0, 1.0}};
  EXPECT_EQ(weld(mesh, {.drops_unused_vertices = false}).mesh.vertex_count(), 1);
}

TEST(Weld, DropsWhatCollapsesOrRepeatsAndCountsIt) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e-4, 0, 0}, {9, 9, 9}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 2}, {2, 0, 1}, {1, 0, 2}};
  const WeldResult result = weld(mesh, {.tolerance = 1e-3});
  EXPECT_THAT(result.mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(result.dropped_degenerate, 1);
  EXPECT_EQ(result.dropped_duplicate, 2);
  EXPECT_EQ(result.dropped_unused, 1);
  EXPECT_THAT(result.new_of_old, ElementsAre(0, 1, 2, 0, -1));
  EXPECT_THAT(result.old_triangle_of_new, ElementsAre(0));
  EXPECT_THAT(weld(mesh, {.tolerance = 1e-3, .drops_duplicates = false}).old_triangle_of_new,
              ElementsAre(0, 2, 3));
  EXPECT_EQ(weld(mesh, {.tolerance = 1e-3, .drops_duplicates = false}).mesh.triangle_count(), 3);
}

TEST(Weld, KeepsHugeAndTinyMeshes) {
  for (const double scale : {1e-9, 1e9}) {
    const TriangleMesh mesh = make_icosphere(scale, 2);
    EXPECT_EQ(weld(soup_of(mesh)).mesh.vertex_count(), mesh.vertex_count());
  }
}

TEST(Weld, OfAnEmptyMeshIsEmpty) { EXPECT_EQ(weld({}).mesh.vertex_count(), 0); }

TEST(Weld, RefusesWhatItCannotPlace) {
  TriangleMesh mesh = make_icosphere(1.0, 0);
  EXPECT_THROW(weld(mesh, {.tolerance = -1.0}), UsageError);
  EXPECT_THROW(weld(mesh, {.tolerance = std::nan("")}), UsageError);
  mesh.vertices[3].y() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(weld(mesh), InputError);
  EXPECT_THROW(weld({{Vec3::Zero()}, {{0, 0, 1}}}), InputError);
}

}  // namespace
}  // namespace palmar::geometry
