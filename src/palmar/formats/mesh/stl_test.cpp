// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/stl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::HasSubstr;

std::string stl_error(std::string_view bytes) {
  return message_of<InputError>([&] { parse_stl(bytes, "x.stl"); });
}

/// One facet as text, with the given words for its first corner.
std::string ascii(const std::string& first_corner = "0 0 0") {
  return "solid part\n facet normal 0 0 1\n  outer loop\n   vertex " + first_corner +
         "\n   vertex 1 0 0\n   vertex 0 1 0\n  endloop\n endfacet\nendsolid part\n";
}

TEST(Stl, ABoxKeepsShapeAndItsCornersAreMerged) {
  const MeshFile file = parse_stl(format_stl(box_mesh({20, 30, 40})), "x.stl");
  EXPECT_EQ(file.format, "binary STL");
  EXPECT_FALSE(file.unit.has_value()) << "STL carries no unit";
  EXPECT_EQ(file.mesh.vertex_count(), 8);  // 36 corners in the file
  EXPECT_EQ(file.mesh.triangle_count(), 12);
  EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 24000.0);
  EXPECT_DOUBLE_EQ(surface_area(file.mesh), 5200.0);
  EXPECT_TRUE(file.notes.empty());
}

TEST(Stl, BinaryLayoutIsThatOfTheSpecification) {
  const std::string bytes = format_stl(box_mesh({1, 1, 1}));
  ASSERT_EQ(bytes.size(), 84u + 12u * 50u);
  EXPECT_EQ(read_value<std::uint32_t>(bytes, 80), 12u);
  // First triangle (0, 2, 1) lies in z = 0: outward normal -z, second corner (0, 1, 0).
  EXPECT_EQ(read_value<float>(bytes, 84 + 8), -1.0f);
  EXPECT_EQ(read_value<float>(bytes, 84 + 12 + 12 + 4), 1.0f);
}

TEST(Stl, ABinaryFileMayStartWithSolid) {
  std::string bytes = format_stl(box_mesh({1, 1, 1}));
  bytes.replace(0, 9, "solid abc");
  EXPECT_EQ(parse_stl(bytes, "x.stl").mesh.triangle_count(), 12);
  EXPECT_TRUE(is_stl(bytes));
  bytes.resize(bytes.size() - 7);
  EXPECT_THAT(stl_error(bytes), HasSubstr("684 bytes expected for 12 triangles, got 677"));
}

TEST(Stl, TruncatedBinaryNamesBytesExpectedAndGot) {
  const std::string bytes = format_stl(box_mesh({1, 1, 1}));
  EXPECT_EQ(stl_error(bytes.substr(0, 300)),
            "x.stl: is truncated (or no STL): 684 bytes expected for 12 triangles, got 300");
  // The header alone is text; "Palmar" is no ASCII STL.
  EXPECT_THAT(stl_error(std::string(40, '\0')),
              HasSubstr("a binary STL has at least 84 bytes, got 40"));
}

TEST(Stl, BytesBehindTheLastTriangleAreNoted) {
  const MeshFile file = parse_stl(format_stl(box_mesh({1, 1, 1})) + "tail", "x.stl");
  EXPECT_EQ(file.mesh.triangle_count(), 12);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0], "4 bytes behind the last triangle ignored");
}

TEST(Stl, NonFiniteCoordinatesNameFacetAndValue) {
  for (const auto& [value, text] : {std::pair{std::numeric_limits<float>::quiet_NaN(), "nan"},
                                    std::pair{-std::numeric_limits<float>::infinity(), "-inf"}}) {
    std::string bytes = format_stl(box_mesh({1, 1, 1}));
    std::memcpy(bytes.data() + 84 + 50 * 3 + 12 + 12 + 4, &value, 4);
    EXPECT_EQ(stl_error(bytes), "x.stl: facet 4, corner 2: y is " + std::string(text) +
                                    "; a finite number is required");
  }
  EXPECT_EQ(stl_error(ascii("0 nan 0")), "x.stl:4: facet 1: y is nan; a finite number is required");
  EXPECT_THAT(stl_error(ascii("1e20 0 0")), HasSubstr("x is 1e+20; a size up to 1e12 is allowed"));
}

TEST(Stl, AsciiReadsWithAnyCaseSpacingAndLineEnds) {
  for (const std::string eol : {"\n", "\r\n", "\r"}) {
    std::string text;
    for (const char c : ascii("+1.5e1 -2.25 3")) text += c == '\n' ? eol : std::string(1, c);
    const MeshFile file = parse_stl(text, "x.stl");
    EXPECT_EQ(file.format, "ASCII STL");
    ASSERT_EQ(file.mesh.triangle_count(), 1);
    EXPECT_EQ(file.mesh.vertices[0], Vec3(15.0, -2.25, 3.0));
  }
  const MeshFile loud = parse_stl(
      "SOLID\nFACET NORMAL nan nan nan OUTER LOOP VERTEX 0 0 0 VERTEX 1 0 0\tVERTEX 0 1 0 ENDLOOP "
      "ENDFACET\nENDSOLID\n",
      "x.stl");
  EXPECT_EQ(loud.mesh.triangle_count(), 1);
}

TEST(Stl, AsciiKeepsDoublePrecision) {
  EXPECT_EQ(parse_stl(ascii("0.1234567890123456 0 0"), "x.stl").mesh.vertices[0].x(),
            0.1234567890123456);
}

TEST(Stl, SeveralSolidsAreOneMesh) {
  EXPECT_EQ(parse_stl(ascii() + ascii("0 0 1"), "x.stl").mesh.triangle_count(), 2);
}

TEST(Stl, AsciiErrorsNameTheLine) {
  EXPECT_EQ(stl_error("hello world, this is no mesh\n"),
            "x.stl: is no STL: starts with \"hello\"; \"solid\" or a binary header is required");
  EXPECT_EQ(stl_error(ascii("0 zero 0")), "x.stl:4: \"zero\" where a number (y) is expected");
  EXPECT_EQ(stl_error(ascii("0 0 0\n vertex 0 0 0")),
            "x.stl:7: \"vertex\" where \"endloop\" is expected");
  EXPECT_THAT(stl_error(ascii().substr(0, 70)),
              HasSubstr("is truncated: ends in facet 1 (line 5)"));
}

TEST(Stl, WithoutTrianglesIsRefused) {
  EXPECT_EQ(stl_error("solid empty\nendsolid empty\n"),
            "x.stl: holds no triangles; a surface mesh is required");
  EXPECT_EQ(stl_error(format_stl({})), "x.stl: holds no triangles; a surface mesh is required");
}

TEST(Stl, FacetsWithTwoEqualCornersAreDropped) {
  const MeshFile file = parse_stl(ascii() + ascii("1 0 0"), "x.stl");
  EXPECT_EQ(file.mesh.triangle_count(), 1);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0], "1 triangles with two equal corners dropped");
}

}  // namespace
}  // namespace palmar::formats
