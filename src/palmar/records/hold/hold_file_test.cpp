// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hold/hold_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string temporary_hold(const std::string& name) { return formats::own_file(name); }

HoldFile read_hold_text(const std::string& toml) {
  const std::string path = temporary_hold("text.toml");
  formats::write_file(path, toml);
  return read_hold(path);
}

/// What reading says of a text, from the file's name on.
std::string hold_message(const std::string& toml) {
  try {
    read_hold_text(toml);
  } catch (const InputError& e) {
    const std::string what = e.what();
    return what.substr(std::min(what.size(), what.find("text.toml")));
  }
  return "no error";
}

const std::string kShortest = "part = 2\ngrip = \"medium_wrap\"\nalong = 0.5\n";

HoldFile hook_of_a_mug() {
  HoldFile file;
  file.product = "a \"mug\"";
  file.hold.part = 2;
  file.hold.part_name = "handle";
  file.hold.grip = grasp::Grip::kFixedHook;
  file.hold.along = 0.1 + 0.2;  // 17 digits
  file.hold.edge = 1.0 / 3.0;
  file.hold.toward = -1;
  file.hold.turn = std::numbers::pi / 4.0;
  return file;
}

TEST(HoldFile, ReadBackIsTheSameHold) {
  HoldFile file = hook_of_a_mug();
  const std::string path = temporary_hold("same.toml");
  write_hold(path, file);
  const HoldFile back = read_hold(path);
  EXPECT_EQ(back.product, "a \"mug\"");
  EXPECT_EQ(back.hold.part, 2);
  EXPECT_EQ(back.hold.part_name, "handle");
  EXPECT_EQ(back.hold.grip, grasp::Grip::kFixedHook);
  EXPECT_EQ(back.hold.along, 0.1 + 0.2);
  EXPECT_EQ(back.hold.edge, 1.0 / 3.0);
  EXPECT_EQ(back.hold.toward, -1);
  EXPECT_EQ(back.hold.turn, std::numbers::pi / 4.0);
  EXPECT_FALSE(back.hold.is_over_end);
  EXPECT_TRUE(back.hold.fingertips.empty());
  EXPECT_EQ(hold_toml(back), formats::read_file(path)) << "writing again must give the same bytes";
}

TEST(HoldFile, AnglesAreWrittenInDegreesWithFewDigits) {
  EXPECT_THAT(hold_toml(hook_of_a_mug()), HasSubstr("\nturn_deg = 45.0 "));
}

TEST(HoldFile, AnglesReadBackWithinTheLastDigitAndStayThere) {
  HoldFile file = hook_of_a_mug();
  for (int k = 0; k < 1000; ++k) {
    file.hold.turn = -std::numbers::pi + 2.0 * std::numbers::pi * k / 999.0;
    const HoldFile once = read_hold_text(hold_toml(file));
    EXPECT_DOUBLE_EQ(once.hold.turn, file.hold.turn);
    const HoldFile twice = read_hold_text(hold_toml(once));
    EXPECT_EQ(twice.hold.turn, once.hold.turn);
  }
}

TEST(HoldFile, FingertipsAreInThePartsCoordinates) {
  HoldFile file;
  file.hold.grip = grasp::Grip::kTripod;
  file.hold.is_over_end = true;
  file.hold.fingertips = {{hand::Finger::kThumb, {.along = -0.02, .turn = 1.0, .height = 5.25}},
                          {hand::Finger::kIndex, {.along = 0.04, .turn = -2.5, .height = 0.1}},
                          {hand::Finger::kMiddle, {.along = 0.05, .turn = 3.0, .height = 1e-9}}};
  const grasp::Hold back = read_hold_text(hold_toml(file)).hold;
  EXPECT_TRUE(back.is_over_end);
  ASSERT_EQ(back.fingertips.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const grasp::HoldFingertip& a = back.fingertips[k];
    const grasp::HoldFingertip& b = file.hold.fingertips[k];
    EXPECT_EQ(a.finger, b.finger);
    EXPECT_EQ(a.place.along, b.place.along);
    EXPECT_DOUBLE_EQ(a.place.turn, b.place.turn);
    EXPECT_EQ(a.place.height, b.place.height);
  }
}

TEST(HoldFile, TheWristsSideOfFingertipsReadsBackExactly) {
  HoldFile file;
  file.hold.grip = grasp::Grip::kPalmarPinch;
  file.hold.fingertips = {{hand::Finger::kThumb, {.along = 0.5, .turn = 1.0, .height = 5.0}},
                          {hand::Finger::kIndex, {.along = 0.5, .turn = -2.0, .height = 5.0}}};
  EXPECT_FALSE(read_hold_text(hold_toml(file)).hold.wrist.has_value());
  file.hold.wrist = Vec3(0.3, -0.5, 0.7).normalized();
  EXPECT_EQ(read_hold_text(hold_toml(file)).hold.wrist, file.hold.wrist);
  const std::string text = hold_toml(file);
  const std::size_t at = text.find("wrist = ");
  const auto with = [&](const std::string& line) {
    std::string changed = text;
    return changed.replace(at, text.find('\n', at) - at, line);
  };
  EXPECT_EQ(read_hold_text(with("wrist = [0, 0, 2]")).hold.wrist, Vec3(0.0, 0.0, 1.0));
  EXPECT_THAT(hold_message(with("wrist = [0, 0, 0]")), HasSubstr("wrist has no direction"));
  EXPECT_THAT(hold_message(with("wrist = [0, 1]")), HasSubstr("wrist has 2 numbers; three"));
  EXPECT_THAT(hold_message(kShortest + "wrist = [0, 0, 1]\n"),
              HasSubstr("wrist goes with grips of fingertips only"));
}

TEST(HoldFile, WhereItsPartLayReadsBackExactly) {
  HoldFile file = hook_of_a_mug();
  file.hold.anchor = {Vec3(0.1, 0.2, -0.9).normalized(), Vec3(0.0, 0.9, 0.2).normalized()};
  const grasp::Hold back = read_hold_text(hold_toml(file)).hold;
  ASSERT_TRUE(back.anchor.has_value());
  EXPECT_EQ(back.anchor->along, file.hold.anchor->along);
  EXPECT_EQ(back.anchor->zero, file.hold.anchor->zero);
  EXPECT_THAT(hold_message(kShortest + "turn_from = [0, 0, 1]\n"),
              HasSubstr("turn_from stands alone; along_toward is required, too"));
}

TEST(HoldFile, WhatIsNotSaidHasItsDefault) {
  const HoldFile file = read_hold_text(kShortest);
  EXPECT_EQ(file.product, "");
  EXPECT_EQ(file.hold.toward, 1);
  EXPECT_EQ(file.hold.turn, 0.0);
  EXPECT_EQ(file.hold.edge, 0.0);
  EXPECT_EQ(read_hold_text("part = 1\ngrip = \"cylinder\"\nalong = 1\n").hold.grip,
            grasp::Grip::kMediumWrap);
}

TEST(HoldFile, MalformedFilesAreRefusedByLineKeyAndValue) {
  EXPECT_THAT(hold_message("part = \n"), StartsWith("text.toml:1: no TOML"));
  EXPECT_THAT(hold_message("grip = \"medium_wrap\"\nalong = 0.5\n"),
              AllOf(StartsWith("text.toml:1: "), HasSubstr("\"part\" is missing")));
  EXPECT_THAT(hold_message("part = 1\nalong = 0.5\n"), HasSubstr("grip"));
  EXPECT_THAT(hold_message("part = 1\ngrip = \"medium_wrap\"\n"), HasSubstr("along"));
  EXPECT_EQ(hold_message(kShortest + "towards = 1\n"),
            "text.toml:4: the file: key \"towards\" is not known; did you mean toward?");
  EXPECT_THAT(hold_message(kShortest + "zzz = 1\n"), HasSubstr("allowed are version, product"));
  EXPECT_EQ(hold_message(kShortest + "toward = 0\n"),
            "text.toml:4: toward is 0; 1 or -1 is allowed");
  EXPECT_EQ(hold_message(kShortest + "toward = 2\n"),
            "text.toml:4: toward is 2; -1 to 1 is allowed");
  EXPECT_EQ(hold_message("part = 0\ngrip = \"tripod\"\nalong = 0.5\n"),
            "text.toml:1: part is 0; 1 to 10000 is allowed");
  EXPECT_EQ(hold_message("part = 1.5\ngrip = \"tripod\"\nalong = 0.5\n"),
            "text.toml:1: part is no whole number; 1 to 10000 is allowed");
  EXPECT_EQ(hold_message("part = 1\ngrip = \"medium_wrap\"\nalong = 1.5\n"),
            "text.toml:3: along is 1.5; 0 to 1 is allowed");
  EXPECT_EQ(hold_message("part = 1\ngrip = \"medium_wrap\"\nalong = nan\n"),
            "text.toml:3: along is nan; 0 to 1 is allowed");
  EXPECT_EQ(hold_message(kShortest + "turn_deg = 1e9\n"),
            "text.toml:4: turn_deg is 1e+09 deg; -360 to 360 deg is allowed");
  EXPECT_EQ(hold_message(kShortest + "over_end = 1\n"),
            "text.toml:4: over_end must be true or false");
  EXPECT_THAT(hold_message("part = 1\ngrip = \"medum_wrap\"\nalong = 0.5\n"),
              StartsWith("text.toml:2: grip is \"medum_wrap\", which is not known, did you mean "
                         "medium_wrap?; medium_wrap, "));
  EXPECT_THAT(
      hold_message("version = 2\n" + kShortest),
      AllOf(StartsWith("text.toml:1: version is 2"), EndsWith("(a newer Palmar wrote it)")));
}

TEST(HoldFile, FingertipsGoWithPrecisionGripsOnceEach) {
  const std::string tripod = "part = 1\ngrip = \"tripod\"\nalong = 0.5\n";
  const std::string thumb =
      "[[fingertip]]\nfinger = \"thumb\"\nalong = 0.5\nturn_deg = 0\nheight_mm = 4\n";
  EXPECT_THAT(hold_message(tripod), HasSubstr("2: grip is tripod, which holds "
                                              "with fingertips; a [[fingertip]] is required"));
  EXPECT_EQ(hold_message(tripod + thumb), "no error");
  EXPECT_THAT(hold_message(tripod + thumb + thumb), HasSubstr("gives thumb twice"));
  EXPECT_THAT(hold_message(kShortest + thumb),
              HasSubstr("fingertip goes with grips of fingertips only; medium_wrap"));
  EXPECT_THAT(hold_message(tripod + "[[fingertip]]\nfinger = \"toe\"\n"),
              AllOf(StartsWith("text.toml:5: "), HasSubstr("finger is \"toe\"")));
  EXPECT_THAT(hold_message(tripod + "[[fingertip]]\nfinger = \"thumb\"\nalong = 0.1\n"),
              HasSubstr("turn_deg"));
  EXPECT_THAT(hold_message(tripod + thumb + "heigt_mm = 3\n"),
              HasSubstr("did you mean height_mm?"));
}

}  // namespace
}  // namespace palmar::records
