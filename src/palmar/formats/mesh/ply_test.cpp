// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

MeshFile ply(const std::string& bytes) { return parse_ply(bytes, "x.ply"); }
std::string ply_error(const std::string& bytes) {
  return message_of<InputError>([&] { parse_ply(bytes, "x.ply"); });
}

std::string ascii_ply(const std::string& rows, int vertices = 3, int faces = 1) {
  return "ply\nformat ascii 1.0\ncomment c\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n" + rows;
}
constexpr const char* kThreeCorners = "0 0 0\n1 0 0\n0 1 0\n";

/// Appends a value in the given byte order.
template <typename T>
void put(std::string& bytes, T value, std::endian order) {
  std::string raw;
  append_value(raw, value);
  if (order == std::endian::big) std::reverse(raw.begin(), raw.end());
  bytes += raw;
}

TEST(Ply, BinaryReadsBackExactly) {
  const geometry::TriangleMesh mesh = box_mesh({1.0 / 3.0, 2.0, 1e-9});
  const MeshFile file = ply(format_ply(mesh));
  EXPECT_EQ(file.mesh.vertices, mesh.vertices);
  EXPECT_EQ(file.mesh.triangles, mesh.triangles);
  EXPECT_EQ(file.format, "binary PLY");
}

TEST(Ply, AsciiPolygonsAreSplit) {
  const MeshFile file = ply(ascii_ply("0 0 0\n2 0 0\n2 3 0\n0 3 0\n4 0 1 2 3\n", 4));
  EXPECT_EQ(file.mesh.triangle_count(), 2);
  EXPECT_DOUBLE_EQ(surface_area(file.mesh), 6.0);
  EXPECT_EQ(file.format, "ascii PLY");
}

TEST(Ply, AnyOrderAndTypeOfPropertiesInBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    std::string bytes =
        std::string("ply\r\nformat ") +
        (order == std::endian::little ? "binary_little_endian" : "binary_big_endian") +
        " 1.0\r\nobj_info scanner\r\n"
        "element material 1\r\nproperty list uchar double shine\r\nproperty short k\r\n"
        "element vertex 3\r\nproperty uchar red\r\nproperty double z\r\n"
        "property float x\r\nproperty list uchar ushort rings\r\nproperty int16 y\r\n"
        "element face 1\r\nproperty float quality\r\n"
        "property list uint8 uint16 vertex_index\r\nproperty char flag\r\nend_header\r\n";
    put(bytes, std::uint8_t{2}, order);
    put(bytes, 1.5, order);
    put(bytes, 2.5, order);
    put(bytes, std::int16_t{-3}, order);
    for (int i = 0; i < 3; ++i) {
      put(bytes, std::uint8_t{255}, order);
      put(bytes, 0.1 + i, order);                    // z
      put(bytes, static_cast<float>(i * i), order);  // x
      put(bytes, static_cast<std::uint8_t>(i), order);
      for (int k = 0; k < i; ++k) put(bytes, std::uint16_t{9}, order);
      put(bytes, static_cast<std::int16_t>(-7 * i), order);  // y
    }
    put(bytes, 0.5f, order);
    put(bytes, std::uint8_t{3}, order);
    for (const int v : {2, 0, 1}) put(bytes, static_cast<std::uint16_t>(v), order);
    put(bytes, std::int8_t{1}, order);

    const MeshFile file = ply(bytes);
    EXPECT_THAT(file.mesh.vertices,
                ElementsAre(Vec3(0, 0, 0.1), Vec3(1, -7, 1.1), Vec3(4, -14, 2.1)));
    EXPECT_THAT(file.mesh.triangles, ElementsAre(Triangle{2, 0, 1}));
  }
}

TEST(Ply, FacesMayStandBeforeVertices) {
  const MeshFile file = ply(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_index\nelement vertex "
      "3\nproperty double x\nproperty double y\nproperty double z\nend_header\n3 0 1 2\n0 0 0\n1 0 "
      "0\n0 1 0\n");
  EXPECT_EQ(file.mesh.triangle_count(), 1);
}

TEST(Ply, TruncatedDataNameTheElement) {
  EXPECT_EQ(ply_error(ascii_ply("0 0 0\n1 0 0\n")),
            "x.ply: is truncated: the data end in vertex 3 of 3 (line 13)");
  EXPECT_EQ(ply_error(ascii_ply(std::string(kThreeCorners) + "3 0 1\n")),
            "x.ply: is truncated: the data end in face 1 of 1 (line 15)");
  const std::string whole = format_ply(box_mesh({1, 1, 1}));
  EXPECT_THAT(ply_error(whole.substr(0, whole.size() - 1)),
              HasSubstr("is truncated: the data end in face 12 of 12 (byte "));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 3\n"),
              HasSubstr("no \"end_header\""));
  EXPECT_THAT(ply_error(ascii_ply(kThreeCorners, 2000000000)),
              HasSubstr("announces 2000000000 \"vertex\" elements, but only 18 bytes"));
}

TEST(Ply, HeaderErrorsNameTheLine) {
  EXPECT_EQ(ply_error("ply\nformat text 1.0\nend_header\n"),
            "x.ply:2: format is \"text\"; ascii, binary_little_endian or binary_big_endian is "
            "required");
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nproperty float x\nend_header\n"),
              HasSubstr("x.ply:3: a property comes before the first element"));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex -3\nend_header\n"),
              HasSubstr("count is \"-3\""));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\nend_header\n"),
              HasSubstr("property type is \"half\""));
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                        "z\nend_header\n1 2\n"),
              HasSubstr("element vertex has no property y"));
  EXPECT_THAT(ply_error("play\n"), HasSubstr("is no PLY: starts with"));
}

TEST(Ply, BadValuesNameElementAndPlace) {
  EXPECT_EQ(ply_error(ascii_ply("0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n")),
            "x.ply: vertex 1 (line 12): y is nan; a finite number is required");
  EXPECT_EQ(ply_error(ascii_ply(std::string(kThreeCorners) + "3 0 1 3\n")),
            "x.ply: face 0 (line 14) names vertex 3; the file has 3 (from 0)");
  EXPECT_THAT(ply_error(ascii_ply(std::string(kThreeCorners) + "3 0 1 -2\n")),
              HasSubstr("names vertex -2"));
  EXPECT_THAT(ply_error(ascii_ply("0 0 0\n1 x 0\n")),
              HasSubstr("vertex 2 of 3 (line 12): \"x\" is no number"));
  EXPECT_THAT(ply_error(ascii_ply(std::string(kThreeCorners) + "4000000000 0 1 2\n")),
              HasSubstr("a list of 4e+09 values can't be in this file"));
}

TEST(Ply, PointCloudsAndStripsAreRefusedByName) {
  EXPECT_EQ(ply_error(ascii_ply(kThreeCorners, 3, 0)),
            "x.ply: holds 3 vertices but no faces; a surface mesh is required");
  EXPECT_THAT(ply_error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                        "y\nproperty float z\nelement tristrips 1\nproperty list int int "
                        "vertex_indices\nend_header\n0 0 0\n3 0 0 0\n"),
              HasSubstr("triangle strips"));
}

}  // namespace
}  // namespace palmar::formats
