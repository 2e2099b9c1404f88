// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/tessellation.h"

#include <BRepPrimAPI_MakeSphere.hxx>
#include <algorithm>
#include <map>
#include <numbers>

#include "gmock/gmock.h"
#include "palmar/cad/model/cad_test_files.h"
#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::cad {
namespace {

using ::testing::HasSubstr;

CadModel model_of(const TopoDS_Shape& shape) { return make_cad_model(shape, "part"); }

void expect_closed(const geometry::TriangleMesh& mesh) {
  const geometry::TopologyReport topology = geometry::examine_topology(mesh);
  EXPECT_TRUE(topology.is_closed);
  EXPECT_EQ(topology.non_manifold_edges, 0);
}

TEST(Tessellate, SphereIsClosedOutwardsAndWithinTheChordalError) {
  // A sphere has a seam and two poles: the places where meshes of faces come apart.
  const double radius = 30.0;
  for (const double error : {0.5, 0.05}) {
    const Tessellation result = tessellate(model_of(BRepPrimAPI_MakeSphere(radius).Shape()),
                                           {.chordal_error = error, .angle = 1.0});
    expect_closed(result.mesh);
    EXPECT_EQ(result.chordal_error, error);
    for (const Vec3& v : result.mesh.vertices) EXPECT_NEAR(v.norm(), radius, 1e-9);
    // Triangles cut corners off, so the volume is smaller; a shell of the error's thickness at most
    // (twice it, for triangles are tested along their edges).
    const double exact = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
    const double volume = geometry::signed_volume(result.mesh);
    EXPECT_LT(volume, exact);
    EXPECT_GT(volume, 4.0 / 3.0 * std::numbers::pi * std::pow(radius - 2.0 * error, 3));
  }
}

TEST(Tessellate, RoundedBoxHasItsVolumeFacesAndFillets) {
  const double r = 3.0;
  const double a = 40.0 - 2 * r, b = 30.0 - 2 * r, c = 120.0 - 2 * r;
  const Tessellation result = tessellate(model_of(rounded_box(40, 30, 120, r)));
  expect_closed(result.mesh);
  // Steiner's formula for the box of a, b, c grown by r.
  const double volume = a * b * c + 2 * r * (a * b + b * c + c * a) +
                        std::numbers::pi * r * r * (a + b + c) +
                        4.0 / 3.0 * std::numbers::pi * r * r * r;
  EXPECT_NEAR(geometry::signed_volume(result.mesh), volume, 1e-3 * volume);
  std::map<product::FaceKind, int> kinds, fillets;
  std::map<product::FaceKind, double> area;
  for (const product::ProductFace& face : result.faces.face) {
    ++kinds[face.kind];
    fillets[face.kind] += face.is_fillet;
    area[face.kind] += face.area;
    EXPECT_EQ(face.part, "part");
    EXPECT_FALSE(face.is_concave);
    EXPECT_NEAR(face.radius, face.kind == product::FaceKind::kPlane ? 0.0 : r, 1e-9);
  }
  EXPECT_EQ(kinds[product::FaceKind::kPlane], 6);
  EXPECT_EQ(kinds[product::FaceKind::kCylinder], 12);
  EXPECT_EQ(kinds[product::FaceKind::kSphere], 8);
  EXPECT_EQ(fillets[product::FaceKind::kPlane], 0);
  EXPECT_EQ(fillets[product::FaceKind::kCylinder], 12);
  EXPECT_EQ(fillets[product::FaceKind::kSphere], 8);
  EXPECT_NEAR(area[product::FaceKind::kPlane], 2 * (a * b + b * c + c * a), 1e-6);
  EXPECT_NEAR(area[product::FaceKind::kCylinder], 2 * std::numbers::pi * r * (a + b + c), 1e-6);
  EXPECT_NEAR(area[product::FaceKind::kSphere], 4 * std::numbers::pi * r * r, 1e-6);
  // Every triangle's corners lie on its face: areas by face agree.
  std::vector<double> meshed(result.faces.face.size(), 0.0);
  ASSERT_EQ(result.faces.face_of_triangle.size(), result.mesh.triangles.size());
  for (int t = 0; t < result.mesh.triangle_count(); ++t) {
    const auto& [i, j, k] = result.mesh.triangles[t];
    const auto& x = result.mesh.vertices;
    meshed[result.faces.face_of_triangle[t]] += 0.5 * (x[j] - x[i]).cross(x[k] - x[i]).norm();
  }
  for (std::size_t f = 0; f < meshed.size(); ++f) {
    EXPECT_NEAR(meshed[f], result.faces.face[f].area, 0.02 * result.faces.face[f].area) << f;
  }
  for (const product::ProductEdge& edge : result.faces.edge) {
    if (edge.length == 0.0) continue;
    EXPECT_TRUE(edge.is_smooth) << edge.number;
    double length = 0.0;
    for (std::size_t p = 1; p < edge.points.size(); ++p) {
      length += (edge.points[p] - edge.points[p - 1]).norm();
    }
    EXPECT_NEAR(length, edge.length, 0.01 * edge.length) << edge.number;
  }
}

TEST(DescribeFaces, DistinguishesOuterAndInnerEdgesOfAStep) {
  // A box with a corner cut away along its length: 12 + 6 edges of which one is hollow.
  const TopoDS_Shape step = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(40, 30, 100).Shape(),
                                            BRepPrimAPI_MakeBox(20, 15, 100).Shape())
                                .Shape();
  const product::ProductFaces faces = describe_faces(model_of(step));
  EXPECT_EQ(faces.face.size(), 8U);
  EXPECT_EQ(faces.edge.size(), 18U);
  const auto hollow = std::count_if(faces.edge.begin(), faces.edge.end(),
                                    [](const product::ProductEdge& e) { return !e.is_convex; });
  EXPECT_EQ(hollow, 1);
  for (const product::ProductEdge& edge : faces.edge) {
    EXPECT_NEAR(edge.angle, std::numbers::pi / 2, 1e-9);
    EXPECT_FALSE(edge.is_smooth);
    EXPECT_TRUE(edge.is_convex || std::abs(edge.length - 100.0) < 1e-9);
  }
}

TEST(DescribeFaces, DistinguishesAHoleFromARod) {
  const product::ProductFaces rod =
      describe_faces(model_of(BRepPrimAPI_MakeCylinder(10, 50).Shape()));
  const product::ProductFaces hole = describe_faces(
      model_of(BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(-30, -30, 0), gp_Pnt(30, 30, 50)).Shape(),
                               BRepPrimAPI_MakeCylinder(10, 50).Shape())
                   .Shape()));
  const auto cylinder = [](const product::ProductFaces& faces) {
    return *std::find_if(
        faces.face.begin(), faces.face.end(),
        [](const product::ProductFace& face) { return face.kind == product::FaceKind::kCylinder; });
  };
  EXPECT_FALSE(cylinder(rod).is_concave);
  EXPECT_TRUE(cylinder(hole).is_concave);
  EXPECT_FALSE(cylinder(rod).is_fillet);
  EXPECT_FALSE(cylinder(hole).is_fillet);
  EXPECT_NEAR(cylinder(rod).radius, 10.0, 1e-12);
}

TEST(Tessellate, MovedInstancesAndMirroredOnesFaceOutwards) {
  gp_Trsf turn, mirror;
  turn.SetRotation(gp_Ax1(gp_Pnt(3, 2, 1), gp_Dir(1, 2, 3)), 1.0);
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
  const TopoDS_Shape box = rounded_box(40, 30, 120, 3);
  const double volume = geometry::signed_volume(tessellate(model_of(box)).mesh);
  const TopoDS_Shape turned = box.Moved(TopLoc_Location(turn));
  const TopoDS_Shape mirrored = box.Moved(TopLoc_Location(mirror), Standard_False);
  for (const TopoDS_Shape& shape : {turned, mirrored}) {
    const Tessellation result = tessellate(model_of(shape));
    expect_closed(result.mesh);
    EXPECT_NEAR(geometry::signed_volume(result.mesh), volume, 1e-3 * volume);
  }
}

TEST(Tessellate, ErrorIsChosenFromSizeAndSmallestRadius) {
  const Tessellation plain = tessellate(model_of(BRepPrimAPI_MakeBox(40, 30, 120).Shape()));
  EXPECT_NEAR(plain.chordal_error, 0.06, 1e-9);
  EXPECT_THAT(plain.chordal_reason, HasSubstr("2000th"));
  const Tessellation sharp = tessellate(model_of(rounded_box(40, 30, 120, 0.5)));
  EXPECT_NEAR(sharp.chordal_error, 0.025, 1e-9);
  EXPECT_THAT(sharp.chordal_reason, HasSubstr("smallest radius of 0.5 mm"));
}

TEST(Tessellate, TooManyTrianglesAreRefusedByNumber) {
  const CadModel ball = model_of(BRepPrimAPI_MakeSphere(30).Shape());
  try {
    tessellate(ball, {.chordal_error = 1e-4, .max_triangles = 10'000});
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("up to 10000 are made"));
    EXPECT_THAT(error.what(), HasSubstr("setting \"chordal error\""));
  }
  // Without a given error it gets coarser instead.
  const Tessellation coarse = tessellate(ball, {.max_triangles = 1000});
  EXPECT_LE(coarse.mesh.triangle_count(), 1000);
  EXPECT_THAT(coarse.chordal_reason, HasSubstr("no more than 1000 triangles"));
  expect_closed(coarse.mesh);
  EXPECT_THROW(tessellate(ball, {.chordal_error = 0.0}), UsageError);
  EXPECT_THROW(tessellate(ball, {.angle = 7.0}), UsageError);
}

TEST(Tessellate, SameModelGivesTheSameTriangles) {
  const TopoDS_Shape box = rounded_box(40, 30, 120, 3);
  const Tessellation a = tessellate(model_of(box)), b = tessellate(model_of(box));
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.faces.face_of_triangle, b.faces.face_of_triangle);
}

}  // namespace
}  // namespace palmar::cad
