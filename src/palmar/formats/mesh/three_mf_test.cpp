// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/three_mf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/mesh/test_archives.h"
#include "palmar/formats/test_files.h"
#include "palmar/formats/zip.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr const char* kModel = "3D/3dmodel.model";

/// A package with this <resources> and <build>.
std::string package(const std::string& resources, const std::string& build,
                    const std::string& unit = "unit=\"millimeter\"", bool deflate = true) {
  return zip_bytes(
      {{"[Content_Types].xml", "<Types/>"}, {kModel, model_xml(resources, build, unit)}}, deflate);
}
std::string object_box(const std::string& id, const Vec3& size) {
  return "<object id=\"" + id + "\" type=\"model\">" + mesh_xml(box_mesh(size)) + "</object>";
}
MeshFile three_mf(const std::string& bytes) { return parse_three_mf(bytes, "x.3mf"); }
std::string three_mf_error(const std::string& bytes) {
  return message_of<InputError>([&] { parse_three_mf(bytes, "x.3mf"); });
}
Box3 bounds_of(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

TEST(ThreeMf, ABoxIsReadStoredOrDeflated) {
  for (const bool deflate : {false, true}) {
    const MeshFile file = three_mf(package(object_box("1", {20, 30, 40}), "<item objectid=\"1\"/>",
                                           "unit=\"millimeter\"", deflate));
    EXPECT_EQ(file.mesh.vertices, box_mesh({20, 30, 40}).vertices);
    EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 24000.0);
    EXPECT_EQ(file.unit, geometry::LengthUnit::kMillimetre);
    EXPECT_EQ(file.format, "3MF");
    EXPECT_TRUE(file.notes.empty());
  }
}

TEST(ThreeMf, EveryUnitOfTheSpecificationIsKept) {
  struct Case {
    std::string text;
    geometry::LengthUnit unit;
    double size;  // of a side of 2
  };
  for (const Case& one : {Case{"", geometry::LengthUnit::kMillimetre, 2.0},
                          Case{"unit=\"centimeter\"", geometry::LengthUnit::kCentimetre, 2.0},
                          Case{"unit=\"inch\"", geometry::LengthUnit::kInch, 2.0},
                          Case{"unit='meter'", geometry::LengthUnit::kMetre, 2.0},
                          Case{"unit=\"foot\"", geometry::LengthUnit::kInch, 24.0},
                          Case{"unit=\"micron\"", geometry::LengthUnit::kMillimetre, 0.002}}) {
    const MeshFile file =
        three_mf(package(object_box("1", {2, 2, 2}), "<item objectid=\"1\"/>", one.text));
    EXPECT_EQ(file.unit, one.unit) << one.text;
    EXPECT_DOUBLE_EQ(bounds_of(file.mesh).sizes().x(), one.size) << one.text;
  }
  EXPECT_THAT(three_mf_error(package(object_box("1", {2, 2, 2}), "<item objectid=\"1\"/>",
                                     "unit=\"furlong\"")),
              HasSubstr("unit is \"furlong\"; micron, millimeter"));
}

TEST(ThreeMf, TransformsOfItemsAndComponentsMultiply) {
  // Component: +10 in x. Item: quarter turn about z (x -> y), then +100 in z. Row vectors.
  const std::string resources =
      object_box("1", {1, 2, 3}) +
      "<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 10 0 "
      "0\"/></components></object>";
  const MeshFile file = three_mf(
      package(resources, "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 100\"/>"));
  EXPECT_EQ(bounds_of(file.mesh).min(), Vec3(-2, 10, 100));
  EXPECT_EQ(bounds_of(file.mesh).max(), Vec3(0, 11, 103));
  EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 6.0);
}

TEST(ThreeMf, AMirroringTransformKeepsTheOutsideOutside) {
  const MeshFile file = three_mf(package(
      object_box("1", {1, 2, 3}), "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>"));
  EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 6.0);
}

TEST(ThreeMf, SeveralItemsAreJoinedAndSupportIsSkipped) {
  std::string support = object_box("3", {9, 9, 9});
  support.replace(support.find("model"), 5, "support");
  const MeshFile file = three_mf(package(
      object_box("1", {1, 1, 1}) + support,
      "<item objectid=\"1\"/><item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/><item "
      "objectid=\"3\"/>"));
  EXPECT_EQ(file.mesh.triangle_count(), 24);
  EXPECT_EQ(bounds_of(file.mesh).max(), Vec3(6, 1, 1));
  EXPECT_THAT(file.notes,
              ElementsAre("2 build items joined into one mesh", "1 support structures skipped"));
}

TEST(ThreeMf, ObjectsInOtherPartsAndOtherPlacesAreFound) {
  const std::string root = model_xml(
      "<object id=\"8\"><components><component p:path=\"/3D/Objects/part.model\" "
      "objectid=\"1\"/></components></object>",
      "<item objectid=\"8\"/>", "unit=\"millimeter\"");
  const std::string part = model_xml(object_box("1", {1, 1, 1}), "", "unit=\"centimeter\"");
  const std::string relations =
      "<Relationships><Relationship Target=\"/3D/root.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  const MeshFile file = three_mf(zip_bytes(
      {{"_rels/.rels", relations}, {"3D/root.model", root}, {"3D/Objects/part.model", part}},
      true));
  EXPECT_EQ(bounds_of(file.mesh).max(), Vec3(10, 10, 10));
}

TEST(ThreeMf, HostilePackagesEndWithAMessage) {
  // A ring of components, and 2^40 copies of one box.
  EXPECT_THAT(three_mf_error(package("<object id=\"1\"><components><component "
                                     "objectid=\"1\"/></components></object>",
                                     "<item objectid=\"1\"/>")),
              HasSubstr("deeper than 32 levels"));
  std::string doubling = object_box("0", {1, 1, 1});
  for (int i = 1; i <= 30; ++i) {
    const std::string inner = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
    doubling += "<object id=\"" + std::to_string(i) + "\"><components>" + inner + inner +
                "</components></object>";
  }
  EXPECT_THAT(three_mf_error(package(doubling, "<item objectid=\"30\"/>")),
              HasSubstr("more than 100000"));
  EXPECT_THAT(
      three_mf_error(zip_bytes({{kModel, "<!DOCTYPE x [<!ENTITY a \"b\">]><model/>"}}, true)),
      HasSubstr("document type definitions are not allowed"));
}

TEST(ThreeMf, ErrorsNamePartAndLine) {
  const std::string build = "<item objectid=\"1\"/>";
  EXPECT_THAT(three_mf_error(package("<object id=\"1\"><mesh><vertices>\n<vertex x=\"0\" y=\"a\" "
                                     "z=\"0\"/></vertices></mesh></object>",
                                     build)),
              HasSubstr("x.3mf (3D/3dmodel.model):3: y is \"a\"; a number is required"));
  EXPECT_THAT(three_mf_error(package("<object id=\"1\"><mesh><vertices><vertex x=\"0\" "
                                     "y=\"NaN\" z=\"0\"/></vertices></mesh></object>",
                                     build)),
              HasSubstr("vertex 0: y is nan; a finite number is required"));
  geometry::TriangleMesh wrong = box_mesh({1, 1, 1});
  wrong.triangles[3][1] = 8;
  EXPECT_THAT(three_mf_error(package("<object id=\"1\">" + mesh_xml(wrong) + "</object>", build)),
              HasSubstr("object 1, triangle 3 names vertex 8; the object has 8 (from 0)"));
  EXPECT_THAT(three_mf_error(package("", build)), HasSubstr("object \"1\" does not exist"));
  EXPECT_THAT(three_mf_error(package(object_box("1", {1, 1, 1}), "")),
              HasSubstr("<build> is empty"));
  EXPECT_THAT(three_mf_error(zip_bytes({{"readme.txt", "hello"}}, false)),
              HasSubstr("is a ZIP archive without \"3D/3dmodel.model\""));
}

TEST(Zip, DamageIsNoticed) {
  const std::string bytes = zip_bytes({{"a.txt", std::string(1000, 'a')}}, true);
  EXPECT_EQ(ZipArchive(bytes, "z").read("/A.TXT"), std::string(1000, 'a'));
  EXPECT_FALSE(ZipArchive(bytes, "z").read("b.txt").has_value());
  EXPECT_THAT(message_of<InputError>([&] { ZipArchive(bytes.substr(0, 60), "z"); }),
              HasSubstr("is truncated: the ZIP directory at its end is missing (60 bytes)"));
  std::string flipped = bytes;
  flipped[37] = static_cast<char>(flipped[37] ^ 0x10);  // first byte of the packed data or near
  EXPECT_THAT(message_of<InputError>([&] { ZipArchive(flipped, "z").read("a.txt"); }),
              HasSubstr("is damaged"));
}

}  // namespace
}  // namespace palmar::formats
