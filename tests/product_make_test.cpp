// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Products from parameters as a user makes them.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string& folder() {
  static const std::string made = temporary_folder();
  return made;
}

ProgramRun make(const std::string& arguments) {
  return run_palmar("product make " + arguments, folder());
}

bool is_there(const std::string& name) { return fs::is_regular_file(fs::path(folder()) / name); }

TEST(ProductMake, ListReportsEveryKindWithItsRanges) {
  const ProgramRun run = make("--list");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* kind :
       {"cylinder", "elliptic_handle", "tapered_handle", "prism", "bottle", "bicycle_grip",
        "pistol_grip", "phone", "knife_handle", "screwdriver_handle", "sphere", "ellipsoid"}) {
    EXPECT_THAT(run.out, HasSubstr(std::string(kind) + ": "));
  }
  EXPECT_THAT(run.out, AllOf(HasSubstr("--bar-diameter-mm"), HasSubstr("(12 to 40 mm)"),
                             HasSubstr("fillet_mm is at most half of the smaller of width_mm")));
  const Json list = Json::parse(make("--list --json").out);
  EXPECT_EQ(list.at("kinds").size(), 12U);
}

TEST(ProductMake, StepAndMeshComeFromOneSolid) {
  const ProgramRun run = make("bicycle_grip --json --end-fillet-mm 0 --out g.step --out g.stl");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json made = Json::parse(run.out).at("products").at(0);
  // A tube of 32 mm with a bore of 22 mm, 136 mm long.
  EXPECT_NEAR(made.at("volume_mm3").get<double>(), 57679.6, 0.1);
  EXPECT_TRUE(is_there("g.step") && is_there("g.stl"));
  EXPECT_THAT(read_text(folder() + "/g.step"), AllOf(HasSubstr("ISO-10303-21"), HasSubstr("bore")));
  const ProgramRun check = run_palmar("product check g.step", folder());
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  EXPECT_EQ(run_palmar("product check g.stl --unit mm", folder()).exit_code, 0);
}

TEST(ProductMake, TheSameWordsGiveTheSameBytes) {
  ASSERT_EQ(make("knife_handle --out a.step").exit_code, 0);
  ASSERT_EQ(make("knife_handle --param length_mm=118 --out b.step").exit_code, 0);
  EXPECT_EQ(read_text(folder() + "/a.step"), read_text(folder() + "/b.step"));
}

// A pistol grip's shape doesn't show which end is up; the kind does, with its rake of 30 degrees.
TEST(ProductMake, TheStudyReportsWhichEndOfAPistolGripIsUpAndTheCommandThatMadeIt) {
  ASSERT_EQ(make("pistol_grip --rake-deg 30 --out 'my grips/'").exit_code, 0);
  EXPECT_THAT(read_text(folder() + "/my grips/study.toml"),
              AllOf(HasSubstr("axis = [0, -0.5, 0.866025]"),
                    HasSubstr("pistol_grip --rake-deg 30 --out 'my grips/'\n")));
  ASSERT_EQ(make("plane --out p.stl --out p.obj").exit_code, 0);
  EXPECT_TRUE(is_there("p.stl") && is_there("p.obj"));
}

TEST(ProductMake, ASweepWritesFilesAndAStudyThatRunsThem) {
  const ProgramRun run =
      make("tapered_handle --diameter-mm 30:40:5 --taper-deg 1,2.5 --format stl --out handles/");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(is_there("handles/tapered_handle-diameter-30-mm-taper-1-deg.stl"));
  EXPECT_TRUE(is_there("handles/tapered_handle-diameter-40-mm-taper-2.5-deg.stl"));
  EXPECT_THAT(run.err, HasSubstr("palmar study run handles/study.toml"));
  const std::string study = read_text(folder() + "/handles/study.toml");
  EXPECT_THAT(study, AllOf(HasSubstr("name = \"tapered_handle diameter 35 mm taper 2.5 deg\""),
                           HasSubstr("file = \"tapered_handle-diameter-35-mm-taper-2.5-deg.stl\""),
                           HasSubstr("family = \"tapered_handle\"")));
  const ProgramRun again = make("tapered_handle --diameter-mm 30:40:5 --format stl --out handles/");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  write_text(folder() + "/handles/study.toml", "[study]\n");
  const ProgramRun kept = make("tapered_handle --diameter-mm 30:40:5 --format stl --out handles/");
  EXPECT_EQ(kept.exit_code, 2);
  EXPECT_THAT(kept.err, HasSubstr("handles/study.toml is there and isn't one that"));
}

TEST(ProductMake, MessagesNameWhatIsWrong) {
  const struct {
    std::string arguments, said;
  } cases[] = {
      {"", "a kind of product is required: cylinder, elliptic_handle"},
      {"botle --out none.step", "did you mean bottle?"},
      {"pram --out none.step",
       "pram is no kind of product; did you mean prism? There are cylinder, "},
      {"bottle --diametre-mm 70 --out none.step", "did you mean --diameter-mm?"},
      {"bottle --diameter-mm 700 --out none.step", "bottle: diameter_mm is 700 mm; 20 to 200 mm"},
      {"bottle --param diametr_mm=70 --out none.step", "did you mean diameter_mm?"},
      {"bottle --param diameter_mm --out none.step", "--param is \"diameter_mm\"; name=value"},
      {"bottle --diameter-mm 60:70:0 --out b/", "diameter_mm: the sweep's step is 0 mm"},
      {"bottle --diameter-mm 70:60:1 --out b/", "from 70 mm down to 60 mm"},
      {"bottle --diameter-mm 60:70:0.001 --out b/", "10001 variants; up to 1000 are allowed"},
      {"bottle --diameter-mm 60:70:5 --out none.step",
       "the sweep makes 3 products, but --out is one file, none.step; a folder is allowed, as "
       "none/"},
      {"bottle --out b.iges", "--out is b.iges; .step, .stp, .stl, .obj or .ply is allowed"},
      {"bottle --out b/ --format dwg", "--format is \"dwg\"; step, stl, obj and ply"},
      {"prism --fillet-mm 18 --out p.step", "at most 15 mm is allowed (half of the smaller of"},
  };
  for (const auto& one : cases) {
    const ProgramRun run = make(one.arguments);
    EXPECT_EQ(run.exit_code, 2) << one.arguments;
    EXPECT_THAT(run.err, HasSubstr(one.said)) << one.arguments;
  }
  EXPECT_FALSE(is_there("none.step"));
  EXPECT_FALSE(fs::exists(fs::path(folder()) / "b"));
}

TEST(ProductMake, ThoroughKindsAndSweepsStandInStudyFiles) {
  write_text(folder() + "/kinds.toml",
             "[[population]]\npreset = \"xie2014\"\nhands = 1\n"
             "[[product]]\nname = \"grip\"\nkind = \"bicycle_grip\"\nsizes = [0.9, 1.0]\n"
             "[[product]]\nname = \"handle\"\nkind = \"cylinder\"\ndiameter_mm = \"30:40:5\"\n");
  const ProgramRun run = run_palmar("study plan kinds.toml --json", folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("grip x 0.9"), HasSubstr("handle diameter 35 mm")));
}

TEST(ProductMake, ExamplesAreWhatTheListMakes) {
  const fs::path examples = fs::path(PALMAR_SOURCE_DIR) / "examples" / "products";
  const ProgramRun run =
      make("--from " + (examples / "products.toml").string() + " --out examples/ --json");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GE(Json::parse(run.out).at("products").size(), 12U);
  int compared = 0;
  for (const auto& entry : fs::directory_iterator(examples)) {
    if (entry.path().extension() != ".step") continue;
    EXPECT_EQ(read_text(entry.path().string()),
              read_text(folder() + "/examples/" + entry.path().filename().string()))
        << entry.path();
    ++compared;
  }
  EXPECT_GE(compared, 0);
}

}  // namespace
}  // namespace palmar::testing
