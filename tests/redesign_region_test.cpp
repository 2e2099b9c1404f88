// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The whole of `palmar redesign region`: hands on a prism, its contact region in CAD, its ridges
// rounded, the same hands again.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "gmock/gmock.h"
#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::HasSubstr;

int occurrences(const std::string& text, const std::string& word) {
  int count = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++count;
  }
  return count;
}

const std::string kPrism = "\"made: prism width_mm=35 depth_mm=35 length_mm=130 fillet_mm=3\"";

TEST(RedesignRegion, ThoroughOfAPrismGivesCadFilesThatHoldWhatTheySayAndAShapeThatPressesLess) {
  const std::string folder = temporary_folder();
  const ProgramRun run =
      run_palmar("redesign region " + kPrism + " --hands 6 --out region --json", folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json json = Json::parse(run.out);

  // Every part is inside the whole; every face's share is a share.
  const double whole = json["regions"][0]["area_mm2"].get<double>();
  EXPECT_GT(whole, 1000.0);
  double of_faces = 0.0;
  for (const Json& face : json["regions"][0]["faces"]) {
    of_faces += face["area_mm2"].get<double>();
    EXPECT_GT(face["share"].get<double>(), 0.0);
    EXPECT_LE(face["share"].get<double>(), 1.0);
  }
  EXPECT_NEAR(of_faces, whole, 1e-3 * whole);

  // STEP as the kernel read it back: the solid as it was; a valid redesign of less volume.
  const Json& cad = json["cad"];
  EXPECT_TRUE(cad["region"]["is_valid"].get<bool>());
  const double before = cad["product"]["volume_mm3"].get<double>();
  const double section = 35.0 * 35.0 - (4.0 - M_PI) * 9.0;
  EXPECT_NEAR(before, section * 130.0, 1e-6 * before);
  EXPECT_NEAR(cad["region"]["volume_mm3"].get<double>(), before, 1e-3 * before);
  const Json& redesign = cad["redesign"];
  EXPECT_TRUE(redesign["read_back"]["is_valid"].get<bool>());
  EXPECT_TRUE(redesign["read_back"]["is_closed"].get<bool>());
  EXPECT_EQ(redesign["read_back"]["solids"].get<int>(), 1);
  const double after = redesign["volume_mm3"].get<double>();
  EXPECT_LT(after, before);
  EXPECT_NEAR(redesign["read_back"]["volume_mm3"].get<double>(), after, 1e-3 * after);
  int outlines = 0, surfaces = 0;
  for (const Json& curve : cad["curves"]) {
    EXPECT_TRUE(curve["is_closed"].get<bool>());
    // Few poles say an outline that is itself known to 1.5 mm.
    EXPECT_LT(curve["deviation_mm"].get<double>(), 1.5);
    EXPECT_LE(curve["poles"].get<int>(), 40);
    ++outlines;
  }
  for (const Json& surface : cad["surfaces"]) {
    EXPECT_GT(surface["area_mm2"].get<double>(), 0.0);
    ++surfaces;
  }
  EXPECT_GT(outlines, 3);
  EXPECT_GT(surfaces, 1);
  const std::string step = read_text(folder + "/region/region.step");
  EXPECT_EQ(occurrences(step, "MANIFOLD_SOLID_BREP("), 1);
  EXPECT_GE(occurrences(step, "'outline "), outlines);
  EXPECT_GE(occurrences(step, "'contact "), surfaces);
  for (const Json& relief : json["redesign"]["reliefs"]) {
    EXPECT_LE(relief["depth_mm"].get<double>(), 5.0);
    EXPECT_GE(relief["radius_mm"].get<double>(), 6.0);
  }

  // Unrolled: four flats of 29 mm and four quarters of r 3.
  EXPECT_NEAR(json["unrolled"]["width_mm"].get<double>(), 4.0 * 29.0 + 6.0 * M_PI, 0.05);
  EXPECT_THAT(read_text(folder + "/region/outline.dxf"), HasSubstr("AC1009"));
  EXPECT_THAT(read_text(folder + "/region/outline.svg"), HasSubstr("mm\" viewBox="));
  EXPECT_THAT(read_text(folder + "/region/region.csv"), HasSubstr("region,face,title,area_mm2"));
  EXPECT_TRUE(fs::exists(folder + "/region/region.png"));
  EXPECT_TRUE(fs::exists(folder + "/region/report/report.html"));

  // Compared in other hands, in the hold of the original and at its grip force.
  ASSERT_FALSE(json["comparison"].is_null());
  EXPECT_TRUE(json["comparison"]["in_other_hands"].get<bool>());
  const Json& change = json["comparison"]["hold_changes"].at(0);
  EXPECT_EQ(change["hands"], 6);
  EXPECT_LT(change["largest_turn_deg"].get<double>(), 30.0);
  EXPECT_LT(change["largest_shift_mm"].get<double>(), 10.0);
  EXPECT_FALSE(change["is_other_hold"].get<bool>());
  EXPECT_THAT(run.err, HasSubstr("compared in 6 other hands than those it was made for"));
  for (const Json& quantity : json["comparison"]["conditions"][0]["quantities"]) {
    if (quantity["quantity"] != "grip_force_n") continue;
    const Json& products = quantity["products"];
    EXPECT_NEAR(products[0]["mean"].get<double>(), products[1]["mean"].get<double>(), 1.0);
  }
}

TEST(RedesignRegion, OfAMeshHasNoSolidAndSaysSo) {
  const std::string folder = temporary_folder();
  const ProgramRun made = run_palmar(
      "product make prism --width-mm 35 --depth-mm 35 --length-mm 130 --out bar.stl", folder);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const ProgramRun run = run_palmar(
      "redesign region bar.stl --unit mm --hands 3 --no-compare --no-pictures --out region",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("is a mesh: region.step has outlines and surfaces but no solid"));
  const std::string step = read_text(folder + "/region/region.step");
  EXPECT_EQ(occurrences(step, "MANIFOLD_SOLID_BREP("), 0);
  EXPECT_GE(occurrences(step, "'outline "), 1);
  EXPECT_FALSE(fs::exists(folder + "/region/redesign.step"));
  EXPECT_TRUE(fs::exists(folder + "/region/redesign.stl"));
}

TEST(RedesignRegion, OfARoundBarHasNothingToRoundAndSaysSo) {
  const std::string folder = temporary_folder();
  const ProgramRun run = run_palmar(
      "redesign region \"made: cylinder diameter_mm=35 length_mm=130\" --hands 3 --no-pictures "
      "--out region",
      folder);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // Where the hand presses hardest decides whether a place is looked at as a ridge at all.
  EXPECT_THAT(run.err, ::testing::AnyOf(HasSubstr("there is nothing to round"),
                                        HasSubstr("none of the handle's ridges can be rounded")));
  EXPECT_TRUE(fs::exists(folder + "/region/region.step"));
  EXPECT_FALSE(fs::exists(folder + "/region/redesign.step"));
}

TEST(RedesignRegion, RefusesWhatItDoesntUnderstand) {
  const ProgramRun run = run_palmar("redesign region " + kPrism + " --hands-share most --out x");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("--hands-share"));
  EXPECT_FALSE(fs::exists("x"));
}

}  // namespace
}  // namespace palmar::testing
