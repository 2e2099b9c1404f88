// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/product_faces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/product/gloved.h"
#include "palmar/product/intake/check.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/primitives.h"

namespace palmar::product {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const UnitDecision kMm{geometry::LengthUnit::kMillimetre, UnitSource::kUser, ""};
const UnitDecision kInches{geometry::LengthUnit::kInch, UnitSource::kUser, ""};

double triangle_area(const geometry::TriangleMesh& mesh, int t) {
  const Triangle& k = mesh.triangles[t];
  return 0.5 * (mesh.vertices[k[1]] - mesh.vertices[k[0]])
                   .cross(mesh.vertices[k[2]] - mesh.vertices[k[0]])
                   .norm();
}

std::vector<double> meshed_areas(const Product& product) {
  std::vector<double> areas(product.faces->face.size(), 0.0);
  for (int t = 0; t < product.mesh.triangle_count(); ++t) {
    areas[product.faces->face_of_triangle[t]] += triangle_area(product.mesh, t);
  }
  return areas;
}

std::vector<std::string> names(const Product& product) {
  std::vector<std::string> all;
  for (const ProductFace& face : product.faces->face) all.push_back(face.name);
  return all;
}

/// The product's mesh as a file could hold it: no shared vertices, in inches, every third triangle
/// turned round, after every fifth one a needle without area on the same face.
geometry::TriangleMesh soup_of(const Product& product, ProductFaces& faces) {
  geometry::TriangleMesh soup;
  faces = scaled(*product.faces, 1.0 / 25.4);
  faces.face_of_triangle.clear();
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c, int face) {
    const int first = soup.vertex_count();
    for (const Vec3& x : {a, b, c}) soup.vertices.push_back(x / 25.4);
    soup.triangles.push_back({first, first + 1, first + 2});
    faces.face_of_triangle.push_back(face);
  };
  for (int t = 0; t < product.mesh.triangle_count(); ++t) {
    const Triangle& k = product.mesh.triangles[t];
    const Vec3 &a = product.mesh.vertices[k[0]], &b = product.mesh.vertices[k[1]],
               &c = product.mesh.vertices[k[2]];
    const int face = product.faces->face_of_triangle[t];
    if (t % 3 == 0) {
      add(a, c, b, face);
    } else {
      add(a, b, c, face);
    }
    if (t % 5 == 0) add(a, b, b, face);
  }
  return soup;
}

TEST(PrimitiveFaces, OfThePrismAreItsSidesFilletsAndEnds) {
  const Product prism = make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 3, .fineness = {}});
  ASSERT_NE(prism.faces, nullptr);
  EXPECT_NO_THROW(check_faces(*prism.faces, prism.mesh.triangle_count(), "prism"));
  EXPECT_THAT(names(prism), ElementsAre("right", "back", "left", "front", "fillet 1", "fillet 2",
                                        "fillet 3", "fillet 4", "bottom", "top"));
  // Closed forms, mm^2; the mesh stays within 0.01 mm of arcs of 3 mm.
  const double fillet = 0.5 * std::numbers::pi * 3.0 * 150.0;
  const double end = 40.0 * 30.0 - (4.0 - std::numbers::pi) * 9.0;
  const std::vector<double> expected = {24.0 * 150, 34.0 * 150, 24.0 * 150, 34.0 * 150, fillet,
                                        fillet,     fillet,     fillet,     end,        end};
  const std::vector<double> meshed = meshed_areas(prism);
  for (std::size_t f = 0; f < expected.size(); ++f) {
    EXPECT_NEAR(prism.faces->face[f].area, expected[f], 1e-9) << f;
    EXPECT_NEAR(meshed[f], expected[f], 0.005 * expected[f]) << f;
  }
  EXPECT_EQ(title_of(prism.faces->face[4]), "face 5 \"fillet 1\" (fillet r 3)");
  EXPECT_EQ(title_of(prism.faces->face[0]), "face 1 \"right\" (plane)");
}

TEST(PrimitiveFaces, TrianglesLieOnTheirFaces) {
  const Product prism = make_prism_product({});  // 40 x 30 x 150 mm, r 5 mm
  for (int t = 0; t < prism.mesh.triangle_count(); ++t) {
    const int face = prism.faces->face_of_triangle[t];
    for (const int v : prism.mesh.triangles[t]) {
      const Vec3& x = prism.mesh.vertices[v];
      const std::string& name = prism.faces->face[face].name;
      const double off = name == "right"      ? x.x() - 20.0
                         : name == "back"     ? x.y() - 15.0
                         : name == "left"     ? x.x() + 20.0
                         : name == "front"    ? x.y() + 15.0
                         : name == "bottom"   ? x.z() + 75.0
                         : name == "top"      ? x.z() - 75.0
                         : name == "fillet 3" ? std::hypot(x.x() + 15.0, x.y() + 10.0) - 5.0
                                              : 0.0;
      EXPECT_NEAR(off, 0.0, 1e-9) << name;
    }
  }
}

TEST(PrimitiveFaces, EdgesAreThoseOfTheSolid) {
  const Product sharp = make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 0, .fineness = {}});
  EXPECT_THAT(names(sharp), ElementsAre("right", "back", "left", "front", "bottom", "top"));
  ASSERT_EQ(sharp.faces->edge.size(), 12U);
  double length = 0.0;
  for (const ProductEdge& edge : sharp.faces->edge) {
    EXPECT_TRUE(edge.is_convex);
    EXPECT_FALSE(edge.is_smooth);
    EXPECT_NEAR(edge.angle, 0.5 * std::numbers::pi, 1e-9);
    EXPECT_NE(edge.faces[0], edge.faces[1]);
    double along = 0.0;
    for (std::size_t i = 1; i < edge.points.size(); ++i) {
      along += (edge.points[i] - edge.points[i - 1]).norm();
    }
    EXPECT_NEAR(along, edge.length, 1e-9);
    length += edge.length;
  }
  EXPECT_NEAR(length, 4.0 * (40 + 30 + 150), 1e-9);  // mm

  const Product round = make_prism_product({});
  int smooth = 0;
  for (const ProductEdge& edge : round.faces->edge) smooth += edge.is_smooth ? 1 : 0;
  EXPECT_EQ(smooth, 8);
  EXPECT_EQ(round.faces->edge.size(), 24U);

  const Product can = make_cylinder_product({});
  EXPECT_THAT(names(can), ElementsAre("side", "bottom", "top"));
  ASSERT_EQ(can.faces->edge.size(), 2U);
  EXPECT_NEAR(can.faces->edge[0].length, std::numbers::pi * 48.0, 1e-9);
}

TEST(PrimitiveFaces, SidesThatFilletsTakeAwayAreLeftOut) {
  // A stadium: its depth is two radii.
  const Product stadium = make_prism_product(
      {.width = 40, .depth = 30, .length = 100, .fillet_radius = 15, .fineness = {}});
  EXPECT_THAT(names(stadium), ElementsAre("back", "front", "fillet 1", "fillet 2", "fillet 3",
                                          "fillet 4", "bottom", "top"));
  double meshed = 0.0, listed = 0.0;
  for (const double area : meshed_areas(stadium)) meshed += area;
  for (const ProductFace& face : stadium.faces->face) listed += face.area;
  EXPECT_NEAR(meshed, listed, 0.002 * listed);
}

TEST(ProductFaces, FollowAMeshThroughUnitWeldAndOrientation) {
  const Product prism = make_prism_product({});
  ProductFaces faces;
  const geometry::TriangleMesh soup = soup_of(prism, faces);
  const Product read = make_product("prism", soup, kInches, "prism.step", &faces);
  ASSERT_NE(read.faces, nullptr);
  EXPECT_NO_THROW(check_faces(*read.faces, read.mesh.triangle_count(), "read"));
  EXPECT_EQ(read.mesh.triangle_count(), prism.mesh.triangle_count());
  EXPECT_EQ(read.faces->face_of_triangle, prism.faces->face_of_triangle);
  const std::vector<double> meshed = meshed_areas(read), before = meshed_areas(prism);
  for (std::size_t f = 0; f < meshed.size(); ++f) {
    EXPECT_NEAR(meshed[f], before[f], 1e-3) << f;
    EXPECT_NEAR(read.faces->face[f].area, prism.faces->face[f].area, 1e-6);
    EXPECT_NEAR(read.faces->face[f].radius, prism.faces->face[f].radius, 1e-9);
    EXPECT_EQ(read.faces->face[f].number, static_cast<int>(f) + 1);
  }
  for (std::size_t e = 0; e < read.faces->edge.size(); ++e) {
    EXPECT_NEAR(read.faces->edge[e].length, prism.faces->edge[e].length, 1e-9);
    EXPECT_TRUE(
        read.faces->edge[e].points.back().isApprox(prism.faces->edge[e].points.back(), 1e-9));
  }
  // A glove covers the same faces.
  EXPECT_EQ(gloved(read, 2.0).faces, read.faces);
  EXPECT_EQ(make_product("prism", soup, kInches, "prism.stl").faces, nullptr);
}

TEST(ProductFaces, BordersAreWhereFacesMeet) {
  const Product sharp = make_prism_product(
      {.width = 40, .depth = 30, .length = 150, .fillet_radius = 0, .fineness = {}});
  double length = 0.0;
  for (const auto& [a, b] : border_edges(sharp.mesh, sharp.faces->face_of_triangle)) {
    length += (sharp.mesh.vertices[a] - sharp.mesh.vertices[b]).norm();
  }
  EXPECT_NEAR(length, 4.0 * (40 + 30 + 150), 1e-6);  // mm
  const Product can = make_cylinder_product({});
  length = 0.0;
  for (const auto& [a, b] : border_edges(can.mesh, can.faces->face_of_triangle)) {
    length += (can.mesh.vertices[a] - can.mesh.vertices[b]).norm();
  }
  EXPECT_NEAR(length, 2.0 * std::numbers::pi * 48.0, 0.5);  // chords of two circles
}

TEST(ProductFaces, OfBodiesThatTouchKeepTheirTriangles) {
  // Two bars of 40 x 30 mm on top of each other: the faces between them lie on each other.
  const Product prism = make_prism_product({.width = 40, .depth = 30, .length = 60});
  ProductFaces faces = *prism.faces;
  geometry::TriangleMesh mesh = prism.mesh;
  const auto count = static_cast<int>(faces.face.size());
  const int vertices = mesh.vertex_count();
  for (int f = 0; f < count; ++f) {
    faces.face[static_cast<std::size_t>(f)].part = "lower";
    ProductFace upper = faces.face[static_cast<std::size_t>(f)];
    upper.part = "upper";
    upper.number += count;
    faces.face.push_back(upper);
  }
  for (const Vec3& x : prism.mesh.vertices) mesh.vertices.push_back(x + Vec3(0.0, 0.0, 60.0));
  for (int t = 0; t < prism.mesh.triangle_count(); ++t) {
    Triangle triangle = prism.mesh.triangles[t];
    for (int& v : triangle) v += vertices;
    mesh.triangles.push_back(triangle);
    faces.face_of_triangle.push_back(faces.face_of_triangle[t] + count);
  }
  const Product both = make_product("bars", mesh, kMm, "bars.step", &faces);
  EXPECT_EQ(both.mesh.triangle_count(), mesh.triangle_count());
  EXPECT_THAT(both.notes, testing::Not(testing::Contains(HasSubstr("too small"))));
  const std::vector<double> areas = meshed_areas(both), one = meshed_areas(prism);
  for (int f = 0; f < 2 * count; ++f) EXPECT_NEAR(areas[f], one[f % count], 1e-6) << f;
  const ProductCheck check = check_product(both);
  EXPECT_TRUE(check.is_closed);
  EXPECT_EQ(check.parts, 2);
  EXPECT_EQ(check.non_manifold_edges, 0);
  EXPECT_EQ(check.duplicate_triangles, 0);
}

TEST(ProductFaces, ReportWhichFaceIsTooSmallToBeKept) {
  const Product prism = make_prism_product({});
  ProductFaces faces = *prism.faces;
  geometry::TriangleMesh mesh = prism.mesh;
  ProductFace sliver;
  sliver.number = 11;
  sliver.name = "sliver";
  faces.face.push_back(sliver);
  mesh.triangles.push_back({0, 1, 1});
  faces.face_of_triangle.push_back(10);
  const Product read = make_product("prism", mesh, kMm, "prism.step", &faces);
  ASSERT_EQ(read.faces->face.size(), 11U);  // numbers stay those of the file
  EXPECT_THAT(read.notes,
              testing::Contains(HasSubstr("face 11 \"sliver\" (freeform) is too small")));
}

TEST(ProductFaces, ThatDoNotFitTheMeshAreRefused) {
  const Product prism = make_prism_product({});
  const auto message = [&](const auto& spoil) -> std::string {
    ProductFaces faces = *prism.faces;
    spoil(faces);
    try {
      make_product("prism", prism.mesh, kMm, "prism.step", &faces);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_THAT(message([](ProductFaces& f) { f.face_of_triangle.pop_back(); }),
              HasSubstr("prism.step: "));
  EXPECT_EQ(message([](ProductFaces& f) { f.face_of_triangle[7] = 10; }),
            "prism.step: triangle 7 names face 10; 10 faces exist");
  EXPECT_EQ(message([](ProductFaces& f) { f.face_of_triangle[0] = -1; }),
            "prism.step: triangle 0 names face -1; 10 faces exist");
  EXPECT_EQ(message([](ProductFaces& f) {
              f.edge[2].faces = {0, 12};
            }),
            "prism.step: edge 2 names face 12; 10 faces exist");
}

}  // namespace
}  // namespace palmar::product
