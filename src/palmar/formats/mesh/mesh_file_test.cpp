// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/glb_fields.h"
#include "palmar/formats/mesh/obj.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/mesh/stl.h"
#include "palmar/formats/mesh/test_archives.h"
#include "palmar/formats/test_files.h"

namespace palmar::formats {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string mesh_message(const std::filesystem::path& path) {
  return message_of<InputError>([&] { read_mesh(path); });
}

TEST(MeshFile, EveryFormatWrittenReadsBack) {
  const TestFolder folder;
  const geometry::TriangleMesh box = box_mesh({20, 30, 40});
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
  const geometry::TriangleMesh box = box_mesh({20, 30, 40});
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
  EXPECT_EQ(read_mesh(folder / "d.stl").unit, geometry::LengthUnit::kInch);
  EXPECT_EQ(read_mesh(folder / "e.ply").unit, geometry::LengthUnit::kMetre);
}

TEST(MeshFile, WhatCantBeReadIsNamedWithWhatCan) {
  const TestFolder folder;
  const auto message = [&](const std::string& name, std::string_view bytes) {
    write_file(folder / name, bytes);
    return mesh_message(folder / name).substr(folder.path().string().size() + 1);
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
  EXPECT_THAT(mesh_message(folder / "no.stl"), HasSubstr("no such file"));
  EXPECT_THAT(mesh_message(folder.path()), HasSubstr("is a directory"));
  std::ofstream(folder / "empty.obj");
  EXPECT_THAT(mesh_message(folder / "empty.obj"), HasSubstr("is empty (0 bytes)"));
}

TEST(MeshFile, OneTriangleIsReadable) {
  const TestFolder folder;
  write_file(folder / "t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(read_mesh(folder / "t.obj").mesh.triangle_count(), 1);
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
    const geometry::TriangleMesh stl = read_mesh(folder / "again.stl").mesh;
    EXPECT_EQ(stl.triangle_count(), scan.triangles) << scan.name;
    EXPECT_EQ(stl.vertex_count(), scan.vertices) << scan.name;
    EXPECT_NEAR(signed_volume(stl), signed_volume(file.mesh), 1.0) << scan.name;
  }
}

}  // namespace
}  // namespace palmar::formats
