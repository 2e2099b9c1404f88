// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "run_program.h"

// Ways to hold a product as a user looks at them, picks one and keeps it.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using HoldsJson = nlohmann::json;

/// A bar of 35 mm along z, made once.
const std::string& bar_folder() {
  static const std::string made = [] {
    std::string name = temporary_folder();
    run_palmar("product make cylinder --diameter-mm 35 --length-mm 140 --out bar.stl", name);
    return name;
  }();
  return made;
}

ProgramRun in_bar_folder(const std::string& arguments) {
  return run_palmar(arguments, bar_folder());
}

HoldsJson ranked(const std::string& arguments) {
  const ProgramRun run = in_bar_folder("grasp holds bar.stl --unit mm --json " + arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return HoldsJson::parse(run.out, nullptr, false);
}

TEST(GraspHolds, AreListedBestFirstWithReasons) {
  const HoldsJson json = ranked("");
  ASSERT_GE(json.at("holds").size(), 2U);
  // By the score, but the first is any of those that are as good to 0.2.
  double last = 1e-9;
  for (const HoldsJson& hold : json.at("holds")) {
    const double score = hold.at("score");
    if (&hold == &json.at("holds").front()) {
      for (const HoldsJson& other : json.at("holds")) {
        EXPECT_GE(score, other.at("score").get<double>() - 0.2);
      }
    } else {
      EXPECT_LE(score, last);
      last = score;
    }
    double sum = 0.0;
    for (const HoldsJson& term : hold.at("terms")) sum += term.at("score").get<double>();
    EXPECT_NEAR(sum, score, 1e-9);
    EXPECT_EQ(hold.at("part"), 1);  // it has no other
  }
  const ProgramRun text = in_bar_folder("grasp holds bar.stl --unit mm");
  EXPECT_THAT(text.out, AllOf(HasSubstr("against it"), HasSubstr("score: 0 at best")));
}

TEST(GraspHolds, ThumbsSideGoesWhereItIsAsked) {
  for (const auto& [asked, sign] : {std::pair{"up", 1.0}, std::pair{"-z", -1.0}}) {
    const HoldsJson json = ranked(std::string("--grip power --most 1 --toward ") + asked);
    const double z = json.at("holds").at(0).at("thumb_towards").at(2);
    EXPECT_GT(sign * z, 0.7) << asked;  // the grip axis lies obliquely in the palm
  }
}

TEST(GraspHolds, AFileTakesTheHoldItWasWrittenFrom) {
  const ProgramRun wrote = in_bar_folder("grasp holds bar.stl --unit mm --most 2 --out holds");
  ASSERT_EQ(wrote.exit_code, 0) << wrote.err;
  const fs::path folder = fs::path(bar_folder()) / "holds";
  EXPECT_TRUE(fs::exists(folder / "hold-1.toml"));
  EXPECT_TRUE(fs::exists(folder / "hold-2.toml"));
  EXPECT_EQ(read_text((folder / "sheet.png").string()).substr(1, 3), "PNG");
  const ProgramRun by_file =
      in_bar_folder("grasp close bar.stl --unit mm --json --hold holds/hold-2.toml");
  const ProgramRun by_number = in_bar_folder("grasp close bar.stl --unit mm --json --hold 2");
  ASSERT_EQ(by_file.exit_code, 0) << by_file.err;
  ASSERT_EQ(by_number.exit_code, 0) << by_number.err;
  const HoldsJson a = HoldsJson::parse(by_file.out), b = HoldsJson::parse(by_number.out);
  for (const char* key : {"part", "grip", "along", "toward", "words", "kind"}) {
    EXPECT_EQ(a.at("hold").at(key), b.at("hold").at(key)) << key;
  }
  EXPECT_NEAR(a.at("hold").at("turn_deg"), b.at("hold").at("turn_deg"), 1e-9);
  EXPECT_EQ(a.at("hold").at("kind"), "bar");
  EXPECT_TRUE(b.at("hold").contains("terms"));
}

TEST(GraspHolds, ToHandItOverItIsTakenBetweenFingertipsAndKeptAsSuch) {
  const HoldsJson json = ranked("--purpose hand-over --out offered");
  const HoldsJson& first = json.at("holds").at(0);
  EXPECT_GE(first.at("fingertips").size(), 2U);
  ASSERT_EQ(first.at("wrist").size(), 3U);
  const ProgramRun run =
      in_bar_folder("grasp close bar.stl --unit mm --json --hold offered/hold-1.toml");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const HoldsJson kept = HoldsJson::parse(run.out);
  EXPECT_EQ(kept.at("hold").at("grip"), first.at("grip"));
  EXPECT_EQ(kept.at("hold").at("wrist"), first.at("wrist"));
  // A grip that isn't between fingertips can be asked for as well.
  EXPECT_EQ(ranked("--purpose hand-over --grip medium_wrap").at("holds").at(0).at("grip"),
            "medium_wrap");
}

TEST(GraspHolds, WeightsAreFittedToPeoplesHoldsAndUsed) {
  run_palmar("product make cylinder --diameter-mm 60 --length-mm 100 --out can.stl", bar_folder());
  std::string table = "object";
  for (const char* point : {"wrist", "thumb", "index", "middle", "ring", "little"}) {
    for (const char axis : {'x', 'y', 'z'}) table += std::string(",") + point + "_" + axis + "_mm";
  }
  table += ",up_x,up_y,up_z";
  // From the side, fingers and thumb round it; from above.
  table +=
      "\nbar,-20,-130,0,20,0,10,-22,15,30,-22,15,10,-22,15,-10,-22,10,-30,0,0,1"
      "\nbar,0,-130,0,20,5,0,-22,15,30,-22,15,10,-22,15,-10,-22,10,-30,0,0,1"
      "\ncan,0,-20,180,32,0,50,-32,10,50,-34,0,50,-32,-10,50,-20,-25,50,0,0,1\n";
  write_text(bar_folder() + "/people.csv", table);
  const ProgramRun fit =
      in_bar_folder("grasp fit-holds people.csv --products . --out weights.toml --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const HoldsJson json = HoldsJson::parse(fit.out);
  EXPECT_EQ(json.at("features").size(), 12U);
  ASSERT_EQ(json.at("left_out").size(), 2U);
  EXPECT_EQ(json.at("left_out").at(0).at("object"), "bar");
  EXPECT_EQ(json.at("left_out").at(0).at("holds"), 2);
  EXPECT_LT(json.at("left_out").at(0).at("nearest_candidate_mm"), 60.0);
  EXPECT_THAT(in_bar_folder("grasp fit-holds people.csv --products .").out,
              AllOf(HasSubstr("object left out"), HasSubstr("even chances")));
  const auto score = [](const std::string& options) {
    return ranked("--purpose hand-over" + options).at("holds").at(0).at("terms").dump();
  };
  EXPECT_NE(score(" --hold-weights weights.toml"), score(""));
}

TEST(GraspHolds, ATableThatCantBeFittedIsRefused) {
  write_text(bar_folder() + "/none.csv", "object,wrist_x_mm\nbar,1\n");
  const auto refused = [](const std::string& arguments) {
    const ProgramRun run = in_bar_folder(arguments);
    return std::to_string(run.exit_code) + " " + run.err;
  };
  EXPECT_THAT(refused("grasp fit-holds none.csv --products ."),
              AllOf(HasSubstr("3 "), HasSubstr("none.csv:1"), HasSubstr("wrist_y_mm")));
  EXPECT_THAT(refused("grasp fit-holds nowhere.csv --products ."),
              AllOf(HasSubstr("3 "), HasSubstr("nowhere.csv")));
  EXPECT_THAT(refused("grasp holds bar.stl --unit mm --hold-weights bar.stl"),
              AllOf(HasSubstr("2 "), HasSubstr("--hold-weights goes with --purpose hand-over")));
  EXPECT_THAT(refused("grasp holds bar.stl --unit mm --purpose hand-over --hold-weights none.csv"),
              AllOf(HasSubstr("3 "), HasSubstr("none.csv")));
}

TEST(GraspHolds, WhatContradictsIsAUsageError) {
  write_text(bar_folder() + "/bad.toml",
             "part = 1\ngrip = \"medium_wrap\"\nalong = 0.5\nturn_degs = 3\n");
  const auto refused = [](const std::string& arguments) {
    const ProgramRun run = in_bar_folder("grasp close bar.stl --unit mm " + arguments);
    EXPECT_NE(run.exit_code, 0) << arguments;
    return std::to_string(run.exit_code) + " " + run.err;
  };
  EXPECT_THAT(refused("--hold 1 --at 0,0,0"),
              AllOf(HasSubstr("2 "), HasSubstr("--hold and --at are both given")));
  EXPECT_THAT(refused("--part 1 --at 0,0,0"),
              AllOf(HasSubstr("2 "), HasSubstr("--part and --at are both given")));
  EXPECT_THAT(refused("--hold 0"), HasSubstr("--hold is 0; a number from 1 is required"));
  EXPECT_THAT(refused("--along 1.5"), HasSubstr("--along is 1.5"));
  EXPECT_THAT(refused("--toward sideways"), HasSubstr("--toward: \"sideways\" is no direction"));
  EXPECT_THAT(refused("--part lid"), HasSubstr("lid"));
  EXPECT_THAT(refused("--hold bad.toml"),
              AllOf(HasSubstr("3 "), HasSubstr("bad.toml:4"), HasSubstr("did you mean")));
  EXPECT_THAT(refused("--hold none.toml"), AllOf(HasSubstr("3 "), HasSubstr("none.toml")));
}

}  // namespace
}  // namespace palmar::testing
