// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/region_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <STEPControl_Reader.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "palmar/cad/edits/relief_cut.h"
#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/solids/solids.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/product/parametric_kinds.h"

namespace palmar::cad {
namespace {

namespace fs = std::filesystem;

CadModel prism() {
  const product::ParametricKind& kind = product::parametric_kind("prism");
  return make_kind_solid(
      kind, product::complete_values(
                kind, {{"width_mm", 35}, {"depth_mm", 35}, {"length_mm", 130}, {"fillet_mm", 3}}));
}

/// A circle of radius 10 mm on the prism's +x side.
records::NamedCurve circle() {
  records::NamedCurve curve{
      .name = "outline palm, half of 30 hands, 1", .colour = {0.2F, 0.4F, 0.7F}, .points = {}};
  for (int i = 0; i < 63; ++i) {
    const double a = 2.0 * std::numbers::pi * i / 63;
    curve.points.emplace_back(17.5, 10.0 * std::cos(a), 10.0 * std::sin(a));
  }
  return curve;
}

/// A patch of 60 degrees and 40 mm of a cylinder of radius 15 mm about z.
records::NamedSurface patch(bool with_outline) {
  records::NamedSurface surface{.name = "contact palm, patch 1: cylinder r 15 mm",
                                .colour = {0.2F, 0.4F, 0.7F},
                                .surface = {.kind = product::FaceKind::kCylinder, .radius = 15.0},
                                .points = {},
                                .outline = {}};
  for (int i = 0; i <= 12; ++i) {
    for (int j = 0; j <= 20; ++j) {
      const double a = (i / 12.0 - 0.5) * std::numbers::pi / 3.0;
      surface.points.emplace_back(15.0 * std::cos(a), 15.0 * std::sin(a), 2.0 * j - 20.0);
    }
  }
  for (int i = 0; with_outline && i < 80; ++i) {
    // An ellipse on the sheet of the unrolled cylinder, semi-axes 7 and 18 mm.
    const double t = 2.0 * std::numbers::pi * i / 80, a = 7.0 / 15.0 * std::cos(t);
    surface.outline.emplace_back(16.0 * std::cos(a), 16.0 * std::sin(a), 18.0 * std::sin(t));
  }
  return surface;
}

class TempFolder {
 public:
  TempFolder()
      : path_(fs::temp_directory_path() / ("palmar-region-" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  ~TempFolder() { fs::remove_all(path_); }
  fs::path file(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

TEST(RegionModel, WiresAreClosedSmoothAndWhereThePointsAre) {
  const RegionModel region = make_region_model(CadModel(), {circle()}, {});
  ASSERT_EQ(region.curves.size(), 1U);
  EXPECT_TRUE(region.curves[0].is_closed);
  EXPECT_LT(region.curves[0].deviation, 0.02);  // mm
  EXPECT_NEAR(region.curves[0].length, 2.0 * std::numbers::pi * 10.0,
              0.01);  // cubic through 32 points
}

TEST(RegionModel, FacesEndWhereTheyShould) {
  const RegionModel region = make_region_model(CadModel(), {}, {patch(false), patch(true)});
  EXPECT_FALSE(region.surfaces[0].ends_at_outline);
  EXPECT_NEAR(region.surfaces[0].area, 15.0 * std::numbers::pi / 3.0 * 40.0, 1e-6);
  EXPECT_TRUE(region.surfaces[1].ends_at_outline);
  EXPECT_NEAR(region.surfaces[1].area, std::numbers::pi * 7.0 * 18.0, 0.5);
  EXPECT_TRUE(check_cad(region.model).is_valid);
}

TEST(RegionModel, OneStepHoldsSolidWiresAndFacesByTheirNames) {
  const TempFolder folder;
  const CadModel before = prism();
  const RegionModel region = make_region_model(before, {circle()}, {patch(true)});
  write_step(folder.file("region.step"), region.model);
  // As text: B-spline curve, cylinder, names.
  const std::string text = formats::read_file(folder.file("region.step"));
  EXPECT_GE(occurrences(text, "B_SPLINE_CURVE"), 1);
  EXPECT_GE(occurrences(text, "'outline palm, half of 30 hands, 1'"), 1);
  EXPECT_GE(occurrences(text, "'contact palm, patch 1: cylinder r 15 mm'"), 1);
  EXPECT_EQ(occurrences(text, "MANIFOLD_SOLID_BREP("), 1);
  EXPECT_GE(occurrences(text, "COLOUR_RGB"), 1);
  // By the kernel's plain reader, which knows nothing of ours.
  STEPControl_Reader reader;
  ASSERT_EQ(reader.ReadFile(folder.file("region.step").c_str()), IFSelect_RetDone);
  reader.TransferRoots();
  TopTools_IndexedMapOfShape solids, faces, wires;
  TopExp::MapShapes(reader.OneShape(), TopAbs_SOLID, solids);
  TopExp::MapShapes(reader.OneShape(), TopAbs_FACE, faces);
  EXPECT_EQ(solids.Extent(), 1);
  EXPECT_EQ(faces.Extent(), 11);  // ten of the prism
  // By ours: the solid as it was.
  EXPECT_NEAR(volume_of(read_step(folder.file("region.step")).model), volume_of(before),
              1e-6 * volume_of(before));
}

redesign::RidgeRelief corner(double radius) {
  redesign::RidgeRelief relief;
  relief.name = "relief 1";
  relief.start = Vec3(17.5 - radius, 17.5 - radius, -30);
  relief.end = Vec3(17.5 - radius, 17.5 - radius, 20);
  relief.outward = Vec3(1, 1, 0).normalized();
  relief.radius = radius;
  relief.half_angle = 0.25 * std::numbers::pi;
  relief.run_out = 40.0;
  relief.depth = (radius - 3.0) * (std::sqrt(2.0) - 1.0);
  return relief;
}

// Colours hang on shapes by their address, which is another one every time.
TEST(RegionModel, TheSameRegionGivesTheSameBytesWhereverItsShapesLie) {
  const TempFolder folder;
  std::vector<records::NamedCurve> curves;
  for (int i = 0; i < 6; ++i) {
    curves.push_back(circle());
    curves.back().name = "outline " + std::to_string(i + 1);
    curves.back().colour[0] = 0.1F * static_cast<float>(i);
    for (Vec3& x : curves.back().points) x.z() += 5.0 * i;
  }
  std::vector<RegionModel> kept;
  for (const char* const name : {"one.step", "two.step", "three.step"}) {
    kept.push_back(make_region_model(prism(), curves, {patch(false), patch(true)}));
    write_step(folder.file(name), kept.back().model);
  }
  const std::string one = formats::read_file(folder.file("one.step"));
  EXPECT_EQ(occurrences(one, "STYLED_ITEM("), 8);
  EXPECT_TRUE(one == formats::read_file(folder.file("two.step")));
  EXPECT_TRUE(one == formats::read_file(folder.file("three.step")));
}

TEST(CutReliefs, AllAlongAnEdgeEqualsALargerFillet) {
  redesign::RidgeRelief relief = corner(14.0);
  relief.is_open_start = relief.is_open_end = true;
  relief.start.z() = -65.0;
  relief.end.z() = 65.0;
  const RelievedModel cut = cut_reliefs(prism(), {relief});
  // (1 - pi / 4)(14^2 - 3^2) mm^2 of the section over 130 mm.
  const double removed = (1.0 - 0.25 * std::numbers::pi) * 187.0 * 130.0;
  EXPECT_NEAR(cut.volume_before - cut.volume_after, removed, 1e-3 * removed);
  EXPECT_TRUE(check_cad(cut.model).is_good());
  EXPECT_EQ(cut.model.face_count(), 10);  // the old fillet is gone, the new one is there
}

TEST(CutReliefs, LeavesAValidSolidOfSimpleFacesAndSaysWhichAreNew) {
  const TempFolder folder;
  const RelievedModel cut = cut_reliefs(prism(), {corner(14.0)});
  const CadCheck check = check_cad(cut.model);
  EXPECT_TRUE(check.is_good()) << testing::PrintToString(check.findings);
  const double straight = (1.0 - 0.25 * std::numbers::pi) * 187.0 * 50.0;
  EXPECT_GT(cut.volume_before - cut.volume_after, straight);
  EXPECT_LT(cut.volume_before - cut.volume_after, 2.0 * straight);
  write_step(folder.file("redesign.step"), cut.model);
  const CadModel again = read_step(folder.file("redesign.step")).model;
  EXPECT_TRUE(check_cad(again).is_good());
  EXPECT_NEAR(volume_of(again), cut.volume_after, 1e-3 * cut.volume_after);
  const std::string text = formats::read_file(folder.file("redesign.step"));
  EXPECT_GE(occurrences(text, "TOROIDAL_SURFACE("), 2);  // run-outs
  EXPECT_EQ(occurrences(text, "'relief 1'"), 3);
  EXPECT_EQ(occurrences(text, "B_SPLINE_SURFACE"), 0);
}

TEST(CutReliefs, SayWhyNot) {
  redesign::RidgeRelief relief = corner(14.0);
  relief.run_out = 5.0;
  EXPECT_THAT([&] { cut_reliefs(prism(), {relief}); },
              testing::ThrowsMessage<NumericalError>(
                  testing::HasSubstr("relief 1: the run-out's radius is 5 mm; the cutter needs at "
                                     "least")));
  EXPECT_THAT([&] { cut_reliefs(CadModel(), {relief}); },
              testing::ThrowsMessage<InputError>("relief: the model has 0 solids; it must be one"));
  relief = corner(14.0);
  relief.start += Vec3(200, 0, 0);
  relief.end += Vec3(200, 0, 0);
  EXPECT_THAT([&] { cut_reliefs(prism(), {relief}); },
              testing::ThrowsMessage<NumericalError>("relief 1: takes nothing away"));
}

TEST(RegionModel, SaysWhatItNeeds) {
  records::NamedCurve curve = circle();
  curve.points.resize(3);
  EXPECT_THAT([&] { make_region_model(CadModel(), {curve}, {}); },
              testing::ThrowsMessage<UsageError>(
                  "curve \"outline palm, half of 30 hands, 1\": 3 points; at least 4 are needed"));
}

}  // namespace
}  // namespace palmar::cad
