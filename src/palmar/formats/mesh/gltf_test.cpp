// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/gltf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/glb.h"
#include "palmar/formats/mesh/glb_fields.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Box of 1 x 2 x 3 as one buffer: positions, then 16-bit indices.
std::string box_buffer() {
  const geometry::TriangleMesh box = box_mesh({1, 2, 3});
  std::string bytes;
  for (const Vec3& v : box.vertices) {
    for (int c = 0; c < 3; ++c) append_value(bytes, static_cast<float>(v[c]));
  }
  for (const Triangle& t : box.triangles) {
    for (const int v : t) append_value(bytes, static_cast<std::uint16_t>(v));
  }
  return bytes;
}

/// glTF of that box with these nodes; the buffer's place is `uri`.
Json box_gltf(const Json& nodes, const std::string& uri) {
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", Json::array({{{"nodes", Json::array({0})}}})},
          {"nodes", nodes},
          {"meshes", Json::array({{{"primitives", Json::array({{{"attributes", {{"POSITION", 0}}},
                                                                {"indices", 1}}})}}})},
          {"buffers", Json::array({{{"uri", uri}, {"byteLength", 168}}})},
          {"bufferViews", Json::array({{{"buffer", 0}, {"byteLength", 96}},
                                       {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}}})},
          {"accessors",
           Json::array(
               {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
                {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}}})}};
}
std::string data_uri() { return "data:application/octet-stream;base64," + base64(box_buffer()); }
const Json kPlainNode = Json::array({{{"mesh", 0}}});

MeshFile gltf(const Json& json) { return parse_gltf(json.dump(), "x.gltf"); }
std::string gltf_error(const Json& json) {
  return message_of<InputError>([&] { parse_gltf(json.dump(), "x.gltf"); });
}
Box3 bounds(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  return box;
}

TEST(Gltf, EmbeddedAndNeighbouringBuffersGiveTheSameBoxInMetres) {
  const MeshFile embedded = gltf(box_gltf(kPlainNode, data_uri()));
  EXPECT_EQ(embedded.unit, geometry::LengthUnit::kMetre);
  EXPECT_EQ(embedded.format, "glTF");
  EXPECT_EQ(embedded.mesh.vertex_count(), 8);
  EXPECT_DOUBLE_EQ(signed_volume(embedded.mesh), 6.0);

  const TestFolder folder;
  write_file(folder / "my box.bin", box_buffer());
  const MeshFile beside =
      parse_gltf(box_gltf(kPlainNode, "my%20box.bin").dump(), folder / "box.gltf");
  EXPECT_EQ(beside.mesh.vertices, embedded.mesh.vertices);
}

TEST(Gltf, NodeTransformsApplyFromTheRootDown) {
  // Parent: matrix moving by +10 in x (columns). Child: scale 2, quarter turn about z, +1 in z.
  const double h = std::sqrt(0.5);
  const Json nodes = Json::array(
      {{{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1}}, {"children", {1}}},
       {{"mesh", 0},
        {"scale", {2, 2, 2}},
        {"rotation", {0, 0, h, h}},
        {"translation", {0, 0, 1}}}});
  const Box3 box = bounds(gltf(box_gltf(nodes, data_uri())).mesh);
  // x -> y, y -> -x: (1, 2, 3) * 2 lands on x in [-4, 0], y in [0, 2], z in [0, 6].
  EXPECT_NEAR((box.min() - Vec3(6, 0, 1)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((box.max() - Vec3(10, 2, 7)).norm(), 0.0, 1e-12);
}

TEST(Gltf, AMirroredNodeKeepsTheOutsideOutside) {
  const Json nodes = Json::array({{{"mesh", 0}, {"scale", {-1, 1, 1}}}});
  EXPECT_DOUBLE_EQ(signed_volume(gltf(box_gltf(nodes, data_uri())).mesh), 6.0);
}

TEST(Gltf, StripsAndFansAreUnrolledWithOneSense) {
  // A unit square as strip 0 1 2 3 (z-shaped order) and as fan 0 1 3 2.
  geometry::TriangleMesh square;
  for (const int mode : {5, 6}) {
    std::string buffer;
    const std::vector<Vec3> strip = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    const std::vector<Vec3> fan = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (const Vec3& v : mode == 5 ? strip : fan) {
      for (int c = 0; c < 3; ++c) append_value(buffer, static_cast<float>(v[c]));
    }
    Json json = box_gltf(kPlainNode, "data:;base64," + base64(buffer));
    json["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}, {"mode", mode}};
    json["bufferViews"] = Json::array({{{"buffer", 0}, {"byteLength", 48}}});
    json["accessors"] =
        Json::array({{{"bufferView", 0}, {"componentType", 5126}, {"count", 4}, {"type", "VEC3"}}});
    const geometry::TriangleMesh mesh = gltf(json).mesh;
    ASSERT_EQ(mesh.triangle_count(), 2) << mode;
    EXPECT_DOUBLE_EQ(surface_area(mesh), 1.0) << mode;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[static_cast<std::size_t>(t[0])];
      EXPECT_GT((mesh.vertices[static_cast<std::size_t>(t[1])] - a)
                    .cross(mesh.vertices[static_cast<std::size_t>(t[2])] - a)
                    .z(),
                0.0)
          << mode;
    }
  }
}

TEST(Gltf, WhatPalmarWritesIsRead) {
  const FieldMesh part{.name = "box",
                       .mesh = box_mesh({10, 20, 30}),
                       .colour = std::vector<VertexColour>(8, {255, 0, 128}),
                       .field = {{"pressure_mpa", {0, 1, 2, 3, 4, 5, 6, 7}, 1}}};
  const std::string bytes = format_glb_fields({part});
  const MeshFile file = parse_gltf(bytes, "x.glb");
  EXPECT_EQ(file.format, "binary glTF");
  // 30 mm is 0.03 m in single precision: 2e-9.
  EXPECT_NEAR((bounds(file.mesh).max() - Vec3(0.01, 0.02, 0.03)).norm(), 0.0, 4e-9);
  EXPECT_NEAR(signed_volume(file.mesh), 6e-6, 1e-11);

  const Glb glb = parse_glb({bytes.begin(), bytes.end()}, "x.glb");
  const Json& attributes = glb.json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_THAT(read_accessor(glb, attributes["_PRESSURE_MPA"], "x").value,
              ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  const std::vector<double> colour = read_accessor(glb, attributes["COLOR_0"], "x").value;
  EXPECT_FLOAT_EQ(static_cast<float>(colour[0]), 1.0f);
  EXPECT_EQ(colour[1], 0.0);
  EXPECT_NEAR(colour[2], 0.2158605, 1e-6);  // sRGB 128 in linear light, IEC 61966-2-1
}

TEST(Gltf, FieldsThatDontFitAreRefused) {
  FieldMesh part{.name = "box", .mesh = box_mesh({1, 1, 1}), .colour = {}, .field = {}};
  part.field = {{"pressure_mpa", {1.0}, 1}};
  EXPECT_EQ(message_of<Error>([&] { format_glb_fields({part}); }),
            "mesh \"box\": field \"pressure_mpa\" has 1 numbers; one for each of 8 vertices is "
            "required");
}

TEST(Gltf, ErrorsNameThePlace) {
  EXPECT_THAT(gltf_error(Json::array()), HasSubstr("no JSON object"));
  EXPECT_THAT(gltf_error({{"nodes", Json::array()}}), HasSubstr("has no \"asset\""));
  EXPECT_THAT(gltf_error({{"asset", {{"version", "1.0"}}}}), HasSubstr("glTF version \"1.0\""));
  EXPECT_THAT(message_of<InputError>([] { parse_gltf("{\"asset\":", "x.gltf"); }),
              HasSubstr("x.gltf: is no valid glTF"));
  Json json = box_gltf(kPlainNode, data_uri());
  json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_THAT(gltf_error(json), HasSubstr("needs \"KHR_draco_mesh_compression\""));
  EXPECT_THAT(gltf_error(box_gltf(kPlainNode, "../secret.bin")),
              HasSubstr("outside the file's own folder"));
  EXPECT_THAT(gltf_error(box_gltf(kPlainNode, "https://x.y/z.bin")),
              HasSubstr("outside the file's own folder"));
  EXPECT_THAT(gltf_error(box_gltf(kPlainNode, "missing.bin")),
              HasSubstr("missing.bin: no such file"));
  EXPECT_THAT(gltf_error(box_gltf(Json::array({{{"mesh", 0}, {"children", {0}}}}), data_uri())),
              HasSubstr("node 0 is reached twice"));
  EXPECT_THAT(gltf_error(box_gltf(Json::array({{{"mesh", 7}}}), data_uri())),
              HasSubstr("mesh 7 does not exist"));
  json = box_gltf(kPlainNode, data_uri());
  json["accessors"][0]["count"] = 7;
  EXPECT_THAT(gltf_error(json), HasSubstr("names vertex 7; there are 7 (from 0)"));
  json["bufferViews"][1]["byteLength"] = 1000;
  EXPECT_THAT(gltf_error(json), HasSubstr("bufferView 1 reaches to byte 96 + 1000"));
  EXPECT_THAT(gltf_error(box_gltf(Json::array({{{"name", "empty"}}}), data_uri())),
              HasSubstr("holds no triangles"));
}

}  // namespace
}  // namespace palmar::formats
