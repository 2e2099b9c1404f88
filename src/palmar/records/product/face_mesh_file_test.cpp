// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/face_mesh_file.h"

#include <limits>
#include <random>

#include "gmock/gmock.h"
#include "palmar/core/error.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

/// A tetrahedron of two faces.
FaceMesh small_mesh() {
  FaceMesh mesh;
  mesh.mesh.vertices = {{0, 0, 0}, {10, 0, 0}, {0, 20, 0}, {0, 0, 0.1}};
  mesh.mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  product::ProductFace floor;
  floor.number = 1;
  floor.name = "Boden ü";
  floor.part = "drill / handle";
  floor.kind = product::FaceKind::kPlane;
  floor.area = 100.0;
  floor.colour = {1.0F, 0.5F, 0.0F};
  product::ProductFace roof;
  roof.number = 2;
  roof.kind = product::FaceKind::kTorus;
  roof.radius = 3.0;
  roof.is_concave = roof.is_fillet = true;
  mesh.faces.face = {floor, roof};
  product::ProductEdge edge;
  edge.number = 1;
  edge.faces = {0, 1};
  edge.is_convex = true;
  edge.angle = 1.5;
  edge.length = 10.0;
  edge.points = {{0, 0, 0}, {10, 0, 0}};
  product::ProductEdge free;
  free.number = 2;
  free.faces = {1, -1};
  mesh.faces.edge = {edge, free};
  mesh.faces.face_of_triangle = {0, 1, 1, 1};
  return mesh;
}

std::string face_mesh_message(const std::string& bytes) {
  try {
    face_mesh_from_bytes(bytes, "mesh.bin");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no InputError";
}

TEST(FaceMeshFile, ReadsBackWhatWasWritten) {
  const FaceMesh mesh = small_mesh();
  const std::string bytes = face_mesh_bytes(mesh);
  const FaceMesh back = face_mesh_from_bytes(bytes, "mesh.bin");
  EXPECT_EQ(face_mesh_bytes(back), bytes);
  EXPECT_EQ(back.mesh.vertices, mesh.mesh.vertices);
  EXPECT_EQ(back.mesh.triangles, mesh.mesh.triangles);
  EXPECT_EQ(back.faces.face_of_triangle, mesh.faces.face_of_triangle);
  EXPECT_EQ(back.faces.face[0].name, "Boden ü");
  EXPECT_EQ(back.faces.face[0].part, "drill / handle");
  EXPECT_EQ(back.faces.face[0].colour, mesh.faces.face[0].colour);
  EXPECT_EQ(back.faces.face[1].kind, product::FaceKind::kTorus);
  EXPECT_EQ(back.faces.face[1].radius, 3.0);
  EXPECT_TRUE(back.faces.face[1].is_fillet && back.faces.face[1].is_concave);
  EXPECT_EQ(back.faces.edge[0].points, mesh.faces.edge[0].points);
  EXPECT_EQ(back.faces.edge[1].faces, (std::array<int, 2>{1, -1}));
}

TEST(FaceMeshFile, MeshWithoutFacesIsOne) {
  FaceMesh mesh = small_mesh();
  mesh.faces = {};
  EXPECT_TRUE(face_mesh_from_bytes(face_mesh_bytes(mesh), "m").faces.face.empty());
}

TEST(FaceMeshFile, EveryCutAndEveryChangedByteIsFound) {
  const std::string bytes = face_mesh_bytes(small_mesh());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THAT(face_mesh_message(bytes.substr(0, size)), HasSubstr("mesh.bin is damaged")) << size;
  }
  for (std::size_t place = 0; place < bytes.size(); ++place) {
    std::string changed = bytes;
    changed[place] = static_cast<char>(changed[place] ^ 0x10);
    EXPECT_THAT(face_mesh_message(changed), HasSubstr("mesh.bin is damaged")) << place;
  }
  EXPECT_THAT(face_mesh_message(bytes + "x"), HasSubstr("mesh.bin is damaged"));
}

TEST(FaceMeshFile, WhatCannotBeIsRefusedThoughItsChecksumIsRight) {
  const auto refused = [](auto change) {
    FaceMesh mesh = small_mesh();
    change(mesh);
    return face_mesh_message(face_mesh_bytes(mesh));
  };
  EXPECT_THAT(refused([](FaceMesh& m) { m.mesh.triangles[0][1] = 4; }), HasSubstr("out of range"));
  EXPECT_THAT(refused([](FaceMesh& m) { m.mesh.triangles[0][1] = -1; }), HasSubstr("no corner"));
  EXPECT_THAT(refused([](FaceMesh& m) {
                m.mesh.vertices[2].y() = std::numeric_limits<double>::quiet_NaN();
              }),
              HasSubstr("not finite"));
  EXPECT_THAT(refused([](FaceMesh& m) { m.faces.face_of_triangle[3] = 2; }),
              HasSubstr("out of range"));
  EXPECT_THAT(refused([](FaceMesh& m) { m.faces.face_of_triangle[3] = -1; }), HasSubstr("no face"));
  EXPECT_THAT(refused([](FaceMesh& m) { m.faces.face_of_triangle.pop_back(); }),
              HasSubstr("3 triangles have a face; there are 4"));
  EXPECT_THAT(refused([](FaceMesh& m) { m.faces.edge[0].faces[0] = 9; }),
              HasSubstr("out of range"));
  EXPECT_THAT(
      refused([](FaceMesh& m) { m.faces.face[0].kind = static_cast<product::FaceKind>(17); }),
      HasSubstr("kind is unknown"));
  EXPECT_THAT(refused([](FaceMesh& m) { (*m.faces.face[0].colour)[1] = 7.0F; }),
              HasSubstr("colour"));
}

}  // namespace
}  // namespace palmar::records
