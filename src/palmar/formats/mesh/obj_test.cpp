// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

MeshFile obj(const std::string& text) { return parse_obj(text, "x.obj"); }
std::string obj_error(const std::string& text) {
  return message_of<InputError>([&] { parse_obj(text, "x.obj"); });
}

TEST(Obj, TextReadsBackExactly) {
  geometry::TriangleMesh mesh = box_mesh({1.0 / 3.0, std::numbers::pi, 1e-7});
  const MeshFile file = obj(format_obj(mesh));
  EXPECT_EQ(file.mesh.vertices, mesh.vertices);
  EXPECT_EQ(file.mesh.triangles, mesh.triangles);
  EXPECT_FALSE(file.unit.has_value());
}

TEST(Obj, AllFormsOfFaceCornersNameTheSameVertices) {
  for (const char* face : {"f 1 2 3", "f 1/7 2/8 3/9", "f 1//7 2//8 3//9", "f 1/2/3 2/2/3 3/2/3",
                           "f -3 -2 -1", "f -3/-1/-1 -2/-1/-1 -1/-1/-1", "\tf  1\t2 3  "}) {
    EXPECT_THAT(obj(std::string(kThree) + face + "\n").mesh.triangles,
                ElementsAre(Triangle{0, 1, 2}))
        << face;
  }
}

TEST(Obj, NegativeIndicesCountBackFromTheFaceNotFromTheEnd) {
  const MeshFile file = obj(std::string(kThree) + "f -3 -2 -1\nv 0 0 5\nf -4 -1 -2\n");
  EXPECT_THAT(file.mesh.triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 3, 2}));
}

TEST(Obj, ContinuedLinesCommentsAndAnyLineEndsAreRead) {
  for (const std::string eol : {"\n", "\r\n", "\r"}) {
    std::string text = "# made by hand\nmtllib a.mtl\no part\nv 0 0 \\\n 0\nv 1 0 0 # right\n";
    text += "v 0 1 0 0.5 0.5 0.5\nvn 0 0 1\nvt 0 0\nusemtl x\ns off\nf 1 \\\n2 \\\n3";
    std::string with_eol;
    for (const char c : text) with_eol += c == '\n' ? eol : std::string(1, c);
    const MeshFile file = obj(with_eol);
    EXPECT_THAT(file.mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
    EXPECT_TRUE(file.notes.empty());
  }
}

TEST(Obj, ConcavePolygonsAreSplitInside) {
  // An L of area 3, and a comb with three teeth of 1 x 2 on a 5 x 1 back: area 11. A fan would
  // cover more.
  const MeshFile ell = obj("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 3 4 5 6 1 2\n");
  EXPECT_EQ(ell.mesh.triangle_count(), 4);
  EXPECT_DOUBLE_EQ(surface_area(ell.mesh), 3.0);
  const MeshFile comb = obj(
      "v 0 0 0\nv 5 0 0\nv 5 0 3\nv 4 0 3\nv 4 0 1\nv 3 0 1\nv 3 0 3\nv 2 0 3\nv 2 0 1\nv 1 0 1\n"
      "v 1 0 3\nv 0 0 3\nf 1 2 3 4 5 6 7 8 9 10 11 12\n");
  EXPECT_EQ(comb.mesh.triangle_count(), 10);
  EXPECT_DOUBLE_EQ(surface_area(comb.mesh), 11.0);
  EXPECT_TRUE(comb.notes.empty());
}

TEST(Obj, SplittingKeepsTheSenseOfThePolygon) {
  // The comb's outline is clockwise seen from +y, so every triangle's normal must be -y.
  const MeshFile comb =
      obj("v 0 0 0\nv 5 0 0\nv 5 0 3\nv 4 0 3\nv 4 0 1\nv 3 0 1\nv 3 0 3\nv 0 0 3\nf 1 2 3 4 5 6 7 "
          "8\n");
  for (const Triangle& t : comb.mesh.triangles) {
    const auto& v = comb.mesh.vertices;
    const Vec3 a = v[static_cast<std::size_t>(t[0])];
    const Vec3 n =
        (v[static_cast<std::size_t>(t[1])] - a).cross(v[static_cast<std::size_t>(t[2])] - a);
    EXPECT_LE(n.y(), 0.0);
  }
}

TEST(Obj, ABigPolygonIsAClosedCircle) {
  // 2 000 corners: area n/2 sin(2 pi / n).
  std::string text;
  std::string face = "f";
  constexpr int n = 2000;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / n;
    text += "v " + std::to_string(100.0 * std::cos(angle)) + " " +
            std::to_string(100.0 * std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  const MeshFile file = obj(text + face + "\n");
  EXPECT_EQ(file.mesh.triangle_count(), n - 2);
  // Six decimals in the text: 1e-6 mm x 628 mm girth.
  EXPECT_NEAR(surface_area(file.mesh), 1e4 * n / 2.0 * std::sin(2.0 * std::numbers::pi / n), 1e-3);
}

TEST(Obj, ASelfCrossingPolygonEndsWithAllItsTriangles) {
  const MeshFile star = obj("v 0 3 0\nv 2 -3 0\nv -3 1 0\nv 3 1 0\nv -2 -3 0\nf 1 2 3 4 5\n");
  EXPECT_EQ(star.mesh.triangle_count(), 3);
}

TEST(Obj, ErrorsNameFileAndLine) {
  EXPECT_EQ(obj_error("v 0 0\n"), "x.obj:1: vertex 1: z is missing; a number is required");
  EXPECT_EQ(obj_error("v 0 0 0\nv 1 0,5 0\n"),
            "x.obj:2: vertex 2: y is \"0,5\"; a number is required");
  EXPECT_EQ(obj_error(std::string(kThree) + "\nf 1 2 4\n"),
            "x.obj:5: face names vertex 4; 3 vertices come before it");
  EXPECT_EQ(obj_error(std::string(kThree) + "f 0 1 2\n"),
            "x.obj:4: face names vertex 0; 3 vertices come before it");
  EXPECT_EQ(obj_error(std::string(kThree) + "f -4 1 2\n"),
            "x.obj:4: face names vertex -4; 3 vertices come before it");
  EXPECT_EQ(obj_error(std::string(kThree) + "f a b c\n"),
            "x.obj:4: face corner \"a\"; a vertex number is required");
  EXPECT_EQ(obj_error("v 0 0 0\nv inf 0 0\n"),
            "x.obj:2: vertex 2: x is inf; a finite number is required");
  EXPECT_EQ(obj_error("v 0 0 0\nv 0 -1e30 0\n"),
            "x.obj:2: vertex 2: y is -1e+30; a size up to 1e12 is allowed");
}

TEST(Obj, VerticesWithoutFacesAreRefused) {
  EXPECT_EQ(obj_error(kThree), "x.obj: holds 3 vertices but no faces; a surface mesh is required");
  EXPECT_EQ(obj_error(std::string(kThree) + "l 1 2 3\np 1\n"),
            "x.obj: holds 3 vertices but no faces; a surface mesh is required");
}

TEST(Obj, OtherTextIsRefused) {
  EXPECT_THAT(obj_error("Dear reader,\nthis is a letter.\n"),
              HasSubstr("is no OBJ: line 1 starts with \"Dear\""));
  EXPECT_THAT(obj_error(std::string("\x01\x02\x00", 3)), HasSubstr("are not text"));
}

TEST(Obj, WhatIsSkippedIsCounted) {
  const MeshFile file =
      obj(std::string(kThree) + "v 9 9 9\nf 1 2\nf 1 2 3\nnonsense 1\nf 1 1 2\ncurv 0 1 1 2\n");
  EXPECT_EQ(file.mesh.triangle_count(), 1);
  EXPECT_EQ(file.mesh.vertex_count(), 3);
  EXPECT_THAT(file.notes, ElementsAre("1 faces with fewer than 3 corners skipped",
                                      "1 statements of free-form curves and surfaces skipped",
                                      "1 unknown statements skipped, the first in line 7",
                                      "1 triangles with two equal corners dropped",
                                      "1 vertices that belong to no triangle dropped"));
}

}  // namespace
}  // namespace palmar::formats
