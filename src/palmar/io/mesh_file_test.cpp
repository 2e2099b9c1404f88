// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "palmar/core/error.h"
#include "palmar/io/file.h"
#include "palmar/io/glb_fields.h"
#include "palmar/io/obj.h"
#include "palmar/io/ply.h"
#include "palmar/io/product_file.h"
#include "palmar/io/stl.h"
#include "palmar/io/test_archives.h"
#include "palmar/io/test_files.h"

namespace palmar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string box_three_mf(const Vec3& size, const std::string& unit) {
  return zip_bytes(
      {{"3D/3dmodel.model", model_xml("<object id=\"1\">" + mesh_xml(box_mesh(size)) + "</object>",
                                      "<item objectid=\"1\"/>", unit)}},
      true);
}

std::string read_message(const std::filesystem::path& path) {
  return message_of<InputError>([&] { read_mesh(path); });
}

TEST(MeshFile, EveryFormatWrittenReadsBack) {
  const TestFolder folder;
  const TriangleMesh box = box_mesh({20, 30, 40});
  for (const char* name : {"box.stl", "box.OBJ", "box.ply"}) {
    write_mesh(folder / name, box);
    const MeshFile file = read_mesh(folder / name);
    EXPECT_EQ(file.mesh.triangle_count(), 12) << name;
    EXPECT_DOUBLE_EQ(signed_volume(file.mesh), 24000.0) << name;
    EXPECT_TRUE(file.notes.empty()) << name;
  }
  EXPECT_EQ(message_of<UsageError>([&] { write_mesh(folder / "box.fbx", box); }),
            (folder / "box.fbx").string() +
                ": can't write a mesh as \".fbx\"; .stl, .obj or .ply is required");
}

TEST(MeshFile, TheContentDecidesNotTheName) {
  const TestFolder folder;
  const TriangleMesh box = box_mesh({20, 30, 40});
  write_file(folder / "a.stl", format_ply(box));
  write_file(folder / "b.obj", format_stl(box));
  write_file(folder / "c", format_obj(box));
  write_file(folder / "d.stl", box_three_mf({1, 2, 3}, "unit=\"inch\""));
  write_file(folder / "e.ply",
             format_glb_fields({{.name = "b", .mesh = box, .colour = {}, .field = {}}}));
  EXPECT_EQ(read_mesh(folder / "a.stl").format, "binary PLY");
  EXPECT_THAT(read_mesh(folder / "a.stl").notes, ElementsAre("is named .stl but holds PLY"));
  EXPECT_EQ(read_mesh(folder / "b.obj").format, "binary STL");
  EXPECT_EQ(read_mesh(folder / "c").format, "OBJ");
  EXPECT_TRUE(read_mesh(folder / "c").notes.empty());
  EXPECT_EQ(read_mesh(folder / "d.stl").unit, LengthUnit::kInch);
  EXPECT_EQ(read_mesh(folder / "e.ply").unit, LengthUnit::kMetre);
}

TEST(MeshFile, WhatCantBeReadIsNamedWithWhatCan) {
  const TestFolder folder;
  const auto message = [&](const std::string& name, std::string_view bytes) {
    write_file(folder / name, bytes);
    return read_message(folder / name).substr(folder.path().string().size() + 1);
  };
  EXPECT_EQ(message("a.step", "ISO-10303-21;\nHEADER;\n"),
            "a.step: STEP holds surfaces, not a mesh; `palmar product convert` makes one of it");
  EXPECT_EQ(message("b.stl", "ISO-10303-21;\nHEADER;\n"),
            "b.stl: STEP holds surfaces, not a mesh; `palmar product convert` makes one of it");
  EXPECT_EQ(message("c.igs", std::string(72, ' ') + "S      1\n"),
            "c.igs: IGES holds surfaces, not a mesh; `palmar product convert` makes one of it");
  EXPECT_EQ(message("d.fbx", "Kaydara FBX Binary"),
            "d.fbx: FBX is not supported; STL, OBJ, PLY, 3MF, glTF and GLB are read");
  EXPECT_EQ(message("e.docx.txt", "Dear reader"),
            "e.docx.txt: is no mesh that Palmar knows; STL, OBJ, PLY, 3MF, glTF and GLB are read");
  EXPECT_EQ(message("f.stl", "Dear reader"),
            "f.stl: is no STL: starts with \"Dear\"; \"solid\" or a binary header is required");
  EXPECT_THAT(message("g.ply", "Dear reader"), HasSubstr("is no PLY"));
  EXPECT_THAT(message("h.obj", "Dear reader"), HasSubstr("is no OBJ"));
  EXPECT_THAT(message("i.3mf", "Dear reader"),
              HasSubstr("the ZIP directory at its end is missing"));
  EXPECT_THAT(message("j.glb", "Dear reader"), HasSubstr("is no valid glTF"));
  EXPECT_THAT(message("k.stl", format_stl(box_mesh({1, 1, 1})).substr(0, 400)),
              HasSubstr("684 bytes expected for 12 triangles, got 400"));
}

TEST(MeshFile, MissingEmptyAndFolderAreNamed) {
  const TestFolder folder;
  EXPECT_THAT(read_message(folder / "no.stl"), HasSubstr("no such file"));
  EXPECT_THAT(read_message(folder.path()), HasSubstr("is a directory"));
  std::ofstream(folder / "empty.obj");
  EXPECT_THAT(read_message(folder / "empty.obj"), HasSubstr("is empty (0 bytes)"));
}

TEST(MeshFile, OneTriangleIsReadable) {
  const TestFolder folder;
  write_file(folder / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_mesh(folder / "t.obj").mesh.triangle_count(), 1);
}

TEST(LoadProduct, TheUnitOfTheFileOrOfTheUserTurnsIntoMillimetres) {
  const TestFolder folder;
  write_file(folder / "handle.3mf", box_three_mf({4, 1, 1}, "unit=\"inch\""));
  const Product from_file = load_product(folder / "handle.3mf");
  EXPECT_EQ(from_file.name, "handle");
  EXPECT_EQ(from_file.unit_source, UnitSource::kFile);
  EXPECT_NEAR(signed_volume(from_file.mesh), 4 * 25.4 * 25.4 * 25.4, 1e-6);

  write_mesh(folder / "handle.stl", box_mesh({12, 3, 3}));
  const Product from_user = load_product(folder / "handle.stl", {.unit = LengthUnit::kCentimetre});
  EXPECT_EQ(from_user.unit_source, UnitSource::kUser);
  EXPECT_NEAR(signed_volume(from_user.mesh), 108000.0, 1e-6);
  // Inside: in the very middle, and 7 mm from the nearest side.
  EXPECT_NEAR(from_user.distance->at(Vec3(60, 15, 15)).distance, -15.0, 1e-9);
  EXPECT_NEAR(from_user.distance->at(Vec3(33, 7, 9)).distance, -7.0, 1e-9);
}

TEST(LoadProduct, AnUndecidableUnitAndAnAbsurdSizeAreRefusedByName) {
  const TestFolder folder;
  write_mesh(folder / "a.stl", box_mesh({12, 3, 3}));
  const std::string undecided = message_of<InputError>([&] { load_product(folder / "a.stl"); });
  EXPECT_THAT(undecided, StartsWith((folder / "a.stl").string()));
  EXPECT_THAT(undecided, HasSubstr("--unit"));
  write_mesh(folder / "b.stl", box_mesh({1e9, 1e8, 1e8}));
  EXPECT_THAT(message_of<InputError>(
                  [&] { load_product(folder / "b.stl", {.unit = LengthUnit::kMillimetre}); }),
              StartsWith((folder / "b.stl").string()));
}

TEST(MeshFile, RealScansHaveTheTrianglesTheirSourcesState) {
  const std::filesystem::path products = std::filesystem::path(PALMAR_SHARED_DIR) / "products";
  if (!std::filesystem::exists(products)) GTEST_SKIP() << "no folder of product scans here";
  struct Scan {
    const char* name;
    int vertices, triangles;
    double volume;  // cm^3
  };
  for (const Scan& scan :
       {Scan{"screwdriver_phillips", 2799, 5610, 70.2}, Scan{"rubber_mallet", 3918, 7836, 312.0},
        Scan{"mug", 4227, 8454, 172.4}, Scan{"cookie_spatula", 2247, 4494, 39.4},
        Scan{"handheld_console", 3129, 6254, 265.3}, Scan{"portable_speaker", 3466, 6928, 648.9},
        Scan{"portable_drive", 1638, 3272, 150.1}, Scan{"power_drill", 8192, 16380, 580.9},
        Scan{"mustard_bottle", 8192, 16380, 612.0}, Scan{"large_marker", 8192, 16384, 27.4}}) {
    const auto path = products / (std::string(scan.name) + ".obj");
    if (!std::filesystem::exists(path)) continue;
    const MeshFile file = read_mesh(path);
    EXPECT_EQ(file.mesh.vertex_count(), scan.vertices) << scan.name;
    EXPECT_EQ(file.mesh.triangle_count(), scan.triangles) << scan.name;
    EXPECT_NEAR(signed_volume(file.mesh) * 1e-3, scan.volume, 0.0501) << scan.name;

    // The same mesh through the other formats; STL rounds to single precision (3e-5 mm at 290 mm).
    const TestFolder folder;
    write_mesh(folder / "again.ply", file.mesh);
    EXPECT_EQ(read_mesh(folder / "again.ply").mesh.vertices, file.mesh.vertices) << scan.name;
    write_mesh(folder / "again.stl", file.mesh);
    const TriangleMesh stl = read_mesh(folder / "again.stl").mesh;
    EXPECT_EQ(stl.triangle_count(), scan.triangles) << scan.name;
    EXPECT_EQ(stl.vertex_count(), scan.vertices) << scan.name;
    EXPECT_NEAR(signed_volume(stl), signed_volume(file.mesh), 1.0) << scan.name;
  }
}

}  // namespace
}  // namespace palmar
