// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "hands/images/exif.h"
#include "palmar/formats/mesh/texture_file.h"
#include "run_program.h"

// `palmar hand quick` on photographs of `palmar phantom sheet`, whose persons aren't Palmar's
// hands.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

/// Small photographs of a left hand on A4 (the lens isn't given) and of a right one beside a card.
class QuickCommand : public ::testing::Test {
 protected:
  static const std::string& folder() {
    static const std::string made = [] {
      const std::string folder = temporary_folder();
      photograph(folder, "--seed 64 --side left --no-exif --threads 1 --out sheet");
      photograph(folder, "--seed 65 --sheet card --table grey --plain --out card");
      return folder;
    }();
    return made;
  }
  static void photograph(const std::string& folder, const std::string& arguments) {
    const ProgramRun run = run_palmar(
        "phantom sheet --width-px 720 --height-px 960 --tilt-deg 4 " + arguments, folder);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void expect_refused(const std::string& arguments, int code, const std::string& words) {
    const ProgramRun run = run_palmar("hand quick " + arguments, folder());
    EXPECT_EQ(run.exit_code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(words));
  }
  /// Most of what is reported holds, and hand length is as near as reported.
  static void expect_true(const Json& reported, const std::string& name) {
    const Json truth = Json::parse(read_text(folder() + "/" + name + "/truth.json"));
    int held = 0, all = 0;
    for (const auto& [dimension, one] : reported.at("dimensions").items()) {
      const double error =
          one.at("value_mm").get<double>() - truth.at(dimension + "_mm").get<double>();
      ++all;
      held += std::abs(error) <= 1.96 * one.at("sd_mm").get<double>() ? 1 : 0;
    }
    EXPECT_GE(held, 0.85 * all) << name;
    EXPECT_NEAR(reported.at("dimensions").at("hand_length").at("value_mm").get<double>(),
                truth.at("hand_length_mm").get<double>(), 3.0)
        << name;
  }
};

TEST_F(QuickCommand, ReportsAHandOnASheetTheSameWithAnyThreads) {
  std::string first, hand;
  for (const char* threads : {"1", "2"}) {
    const ProgramRun run = run_palmar(std::string("hand quick sheet/photo.jpg --json --threads ") +
                                          threads + " --out a.hand.glb --picture found.png",
                                      folder());
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = read_text(folder() + "/a.hand.glb");
    if (first.empty()) {
      first = run.out;
      hand = bytes;
    }
    EXPECT_TRUE(run.out == first && bytes == hand) << threads << " threads";
    EXPECT_THAT(run.err, HasSubstr("if its lens is that of most telephones"));
  }
  const Json reported = Json::parse(first);
  EXPECT_EQ(reported.at("side"), "left");
  EXPECT_EQ(reported.at("photograph").at("sheet"), "a4");
  EXPECT_EQ(reported.at("photograph").at("focal_from"), "usual");
  EXPECT_TRUE(reported.at("photograph").at("measured_against_a_model").get<bool>());
  expect_true(reported, "sheet");
  EXPECT_EQ(read_text(folder() + "/found.png").substr(1, 3), "PNG");
}

TEST_F(QuickCommand, ReportsAHandBesideACard) {
  const ProgramRun run = run_palmar("hand quick card/photo.jpg --sheet card --json", folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("lengths follow from so small a card within"));
  const Json reported = Json::parse(run.out);
  EXPECT_EQ(reported.at("side"), "right");
  EXPECT_EQ(reported.at("photograph").at("focal_from"), "camera");
  expect_true(reported, "card");
}

/// By boxes of three widths one after the other, which is near to a bell of that deviation, pixels.
geometry::RgbImage blurred(geometry::RgbImage image, double deviation) {
  const int reach =
      static_cast<int>(std::lround(0.5 * (std::sqrt(4.0 * deviation * deviation + 1.0) - 1.0)));
  for (int pass = 0; pass < 6; ++pass) {
    const geometry::RgbImage before = image;
    const bool is_across = pass % 2 == 0;
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        for (int c = 0; c < 3; ++c) {
          int sum = 0;
          for (int k = -reach; k <= reach; ++k) {
            const int at_x = std::clamp(is_across ? x + k : x, 0, image.width - 1);
            const int at_y = std::clamp(is_across ? y : y + k, 0, image.height - 1);
            sum += before.rgb[3 * (static_cast<std::size_t>(at_y) * image.width + at_x) + c];
          }
          image.rgb[3 * (static_cast<std::size_t>(y) * image.width + x) + c] =
              static_cast<std::uint8_t>(std::lround(static_cast<double>(sum) / (2 * reach + 1)));
        }
      }
    }
  }
  return image;
}

TEST_F(QuickCommand, BlurIsNamedBeforeItIsMeasured) {
  for (const std::string name : {"sheet", "card"}) {
    const geometry::RgbImage sharp =
        formats::read_texture(read_text(folder() + "/" + name + "/photo.jpg"), "photo.jpg");
    // 1.7 pixels a millimetre: deviations of 0.9 and 2 mm.
    for (const double pixels : {1.5, 3.5}) {
      const std::string file = name + "-blurred.png";
      write_text(folder() + "/" + file, formats::format_png(blurred(sharp, pixels)));
      const std::string card = name == "card" ? " --sheet card" : "";
      expect_refused(file + card, 3,
                     file + ": the photograph is blurred: the sharpest edge of the " + name);
    }
  }
}

TEST_F(QuickCommand, ACroppedPhotographIsNamed) {
  const geometry::RgbImage whole =
      formats::read_texture(read_text(folder() + "/sheet/photo.jpg"), "photo.jpg");
  const images::PhotoExif camera{"Maker", 4.2, 26.0, 714.286, 960, 720};
  for (const int cut : {0, 60}) {  // rows at the lower edge
    geometry::RgbImage image = whole;
    image.height -= cut;
    image.rgb.resize(3 * static_cast<std::size_t>(image.width) * image.height);
    write_text(folder() + "/cropped.jpg",
               formats::format_jpeg(image, 90, images::format_exif(camera)));
    const ProgramRun run = run_palmar("hand quick cropped.jpg --out cropped.hand.glb", folder());
    if (cut == 0) {
      EXPECT_THAT(run.err, ::testing::Not(HasSubstr("cropped, and")));
    } else {
      EXPECT_EQ(run.exit_code, 3);
      EXPECT_THAT(run.err, HasSubstr("cropped.jpg: has 720 x 900 pixels, but the camera took 960 "
                                     "x 720: it is cropped"));
    }
  }
}

TEST_F(QuickCommand, SaysWhatIsWrong) {
  expect_refused("", 2, "nothing is known of the hand");
  expect_refused("sheet/photo.jpg --sheet a5", 2, "a4, letter and card are allowed");
  expect_refused("sheet/photo.jpg --side right", 2, "the thumb is that of a left hand");
  expect_refused("sheet/photo.jpg --sheet card", 3, "bank card");
  expect_refused("card/photo.jpg", 3, "sheet");
  const ProgramRun run = run_palmar("phantom sheet --k1 0.5 --out none", folder());
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("k1 is 0.5"));
}

}  // namespace
}  // namespace palmar::testing
