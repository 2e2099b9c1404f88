// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/coloured_mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/texture_file.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A PNG of 2 x 2 pixels: red, green over blue, white.
std::string png_bytes() {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = 2;
  image.format = PNG_FORMAT_RGB;
  const std::array<std::uint8_t, 12> pixel{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
  png_alloc_size_t size = 0;
  png_image_write_to_memory(&image, nullptr, &size, 0, pixel.data(), 0, nullptr);
  std::string bytes(size, '\0');
  png_image_write_to_memory(&image, bytes.data(), &size, 0, pixel.data(), 0, nullptr);
  return bytes;
}

std::string mesh_text() {
  return "mtllib my scan.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
         "vt 0.25 0.25\nvt 0.75 0.25\nvt 0.75 0.75\nvt 0.25 0.75\nusemtl skin\nf 1/1 2/2 3/3 4/4\n";
}

TEST(ColouredMeshFile, ObjTakesItsTextureFromTheMaterialFile) {
  const TestFolder folder;
  write_file(folder / "scan.obj", mesh_text());
  write_file(folder / "my scan.mtl", "newmtl skin\nKd 1 1 1\nmap_Kd -s 1 1 1 hand.png\n");
  write_file(folder / "hand.png", png_bytes());
  const ColouredMeshFile file = read_coloured_mesh(folder / "scan.obj");
  ASSERT_EQ(file.shape.mesh.triangle_count(), 2);
  const geometry::ColouredMesh mesh = geometry::coloured_mesh(file.shape.mesh, file.colours, 10.0);
  // The origin is the lower left of the image: blue.
  EXPECT_EQ(mesh.colour[0], geometry::Srgb(0, 0, 1));
  EXPECT_EQ(mesh.colour[1], geometry::Srgb(1, 1, 1));
  EXPECT_EQ(mesh.colour[2], geometry::Srgb(0, 1, 0));
  EXPECT_EQ(mesh.colour[3], geometry::Srgb(1, 0, 0));
}

TEST(ColouredMeshFile, NamesWhatIsMissingOrDamaged) {
  const TestFolder folder;
  write_file(folder / "scan.obj", mesh_text());
  const auto message = [&] {
    return message_of<InputError>([&] { read_coloured_mesh(folder / "scan.obj"); });
  };
  EXPECT_THAT(message(), HasSubstr("my scan.mtl\" is missing"));
  write_file(folder / "my scan.mtl", "newmtl skin\nmap_Kd hand.png\n");
  EXPECT_THAT(message(), HasSubstr("hand.png\" is missing"));
  write_file(folder / "hand.png", png_bytes().substr(0, 60));
  EXPECT_THAT(message(), HasSubstr("no valid PNG"));
  write_file(folder / "hand.png", "\xff\xd8\xff\xe0 no picture");
  EXPECT_THAT(message(), HasSubstr("JPEG"));
  write_file(folder / "hand.png", "GIF89a");
  EXPECT_THAT(message(), HasSubstr("neither PNG nor JPEG"));
  write_file(folder / "my scan.mtl", "newmtl skin\nmap_Kd ../../etc/hand.png\n");
  EXPECT_THAT(message(), HasSubstr("outside its folder"));
}

TEST(TextureFile, AJpegThatIsCutOffOrDamagedIsRefused) {
  geometry::RgbImage image{64, 48, {}};
  for (int p = 0; p < 64 * 48 * 3; ++p) {
    image.rgb.push_back(static_cast<std::uint8_t>(p * 37 % 251));  // no two blocks alike
  }
  const std::string whole = format_jpeg(image, 90);
  EXPECT_EQ(read_texture(whole, "a.jpg").rgb.size(), image.rgb.size());
  const auto message = [](const std::string& bytes) {
    return message_of<InputError>([&] { read_texture(bytes, "a.jpg"); });
  };
  for (const double share : {0.3, 0.7, 0.95}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    EXPECT_THAT(message(whole.substr(0, size)),
                HasSubstr("a.jpg: is a damaged or truncated JPEG: Premature end of JPEG file"))
        << share;
  }
  std::string holed = whole;
  holed.erase(holed.size() / 2, holed.size() / 20);  // the end is there, a part before it isn't
  EXPECT_THAT(message(holed),
              HasSubstr("a.jpg: is a damaged or truncated JPEG: Corrupt JPEG data"));
}

TEST(ColouredMeshFile, VertexColoursOfObjAndPlyReadBack) {
  const TestFolder folder;
  write_file(folder / "a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 0.5\nf 1 2 3\n");
  ColouredMeshFile file = read_coloured_mesh(folder / "a.obj");
  ASSERT_EQ(file.colours.vertex.size(), 3u);
  EXPECT_EQ(file.colours.vertex[2], geometry::Srgb(0, 0, 0.5F));
  write_file(folder / "b.obj", "v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 0 0 51\nf 1 2 3\n");
  file = read_coloured_mesh(folder / "b.obj");
  EXPECT_NEAR(file.colours.vertex[2].z(), 0.2F, 1e-6);
  write_file(folder / "c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_TRUE(read_coloured_mesh(folder / "c.obj").colours.empty());

  const geometry::ColouredMesh mesh{
      {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}},
      {geometry::Srgb(1, 0, 0), geometry::Srgb(0, 0.2F, 0), geometry::Srgb(0, 0, 0.6F)}};
  write_coloured_mesh(folder / "d.ply", mesh);
  file = read_coloured_mesh(folder / "d.ply");
  ASSERT_EQ(file.colours.vertex.size(), 3u);
  for (std::size_t v = 0; v < 3; ++v) {
    EXPECT_LT((file.colours.vertex[v] - mesh.colour[v]).norm(), 0.003);
  }
}

TEST(ColouredMeshFile, WhatNoPhotographSawIsAGuess) {
  const TestFolder folder;
  const auto guesses = [&](const std::string& property, const std::string& values) {
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
        "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n" +
        property + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::array<const char*, 4> place{"9 9 9", "0 0 0", "1 0 0",
                                           "0 1 0"};  // the first: unused
    for (std::size_t v = 0; v < 4; ++v) {
      text += std::string(place[v]) + " 1 2 3 " + (values.empty() ? "" : values.substr(2 * v, 1)) +
              "\n";
    }
    write_file(folder / "a.ply", text + "3 1 2 3\n");
    return read_coloured_mesh(folder / "a.ply").colours.is_guess;
  };
  EXPECT_THAT(guesses("property uchar measured\n", "0 1 0 1"), ElementsAre(0, 1, 0));
  EXPECT_THAT(guesses("property uchar views\n", "0 1 2 3"), ElementsAre(1, 0, 0));
  EXPECT_TRUE(guesses("", "").empty());
}

TEST(ColouredMeshFile, UnusedVerticesTakeTheirColoursAlong) {
  const TestFolder folder;
  write_file(folder / "a.obj",
             "v 9 9 9 0 0 0\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 2 2 3\nf 2 3 4\n");
  const ColouredMeshFile file = read_coloured_mesh(folder / "a.obj");
  ASSERT_EQ(file.shape.mesh.vertex_count(), 3);
  EXPECT_EQ(file.colours.vertex[0], geometry::Srgb(1, 0, 0));
  EXPECT_TRUE(file.colours.texture.empty());
}

// Two triangles of a square that share their places but not their colours: glTF splits them.
TEST(ColouredMeshFile, GltfTexturesAndLinearColours) {
  const TestFolder folder;
  std::string buffer;
  const auto floats = [&](std::initializer_list<float> values) {
    for (const float v : values) {
      buffer.append(reinterpret_cast<const char*>(&v), sizeof v);
    }
  };
  floats({0, 0, 0, 1, 0, 0, 0, 1, 0});                 // positions
  floats({0.25F, 0.25F, 0.75F, 0.25F, 0.25F, 0.75F});  // texture places
  floats({1, 0, 0, 0.2140411F, 0, 0, 0, 0, 1});        // colours; 0.2140411 linear is 0.5 in sRGB
  const std::string image = png_bytes();
  nlohmann::json json = {
      {"asset", {{"version", "2.0"}}},
      {"scene", 0},
      {"scenes", {{{"nodes", {0}}}}},
      {"nodes", {{{"mesh", 0}}}},
      {"buffers", {{{"uri", "b.bin"}, {"byteLength", buffer.size() + image.size()}}}},
      {"bufferViews",
       {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 36}},
        {{"buffer", 0}, {"byteOffset", 36}, {"byteLength", 24}},
        {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 36}},
        {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", image.size()}}}},
      {"accessors",
       {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
        {{"bufferView", 1}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}},
        {{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
      {"images", {{{"bufferView", 3}, {"mimeType", "image/png"}}}},
      {"textures", {{{"source", 0}}}},
      {"materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}},
      {"meshes",
       {{{"primitives",
          {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}, {"COLOR_0", 2}}},
            {"material", 0}}}}}}}};
  write_file(folder / "b.bin", buffer + image);
  write_file(folder / "a.gltf", json.dump());
  ColouredMeshFile file = read_coloured_mesh(folder / "a.gltf");
  EXPECT_EQ(file.shape.unit, geometry::LengthUnit::kMetre);
  ASSERT_EQ(file.colours.vertex.size(), 3u);
  EXPECT_NEAR(file.colours.vertex[1].x(), 0.5F, 1e-4);
  geometry::ColouredMesh mesh = geometry::coloured_mesh(file.shape.mesh, file.colours, 10.0);
  EXPECT_EQ(mesh.colour[0], geometry::Srgb(1, 0, 0));  // the upper left of the image
  EXPECT_EQ(mesh.colour[1], geometry::Srgb(0, 1, 0));
  EXPECT_EQ(mesh.colour[2], geometry::Srgb(0, 0, 1));

  json["images"][0]["bufferView"] = 7;
  write_file(folder / "a.gltf", json.dump());
  EXPECT_THAT(message_of<InputError>([&] { read_coloured_mesh(folder / "a.gltf"); }),
              HasSubstr("image 0 has neither"));
}

}  // namespace
}  // namespace palmar::formats
