// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The answer that `palmar assess` and `study compare` give, and for whom.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;

class AnswerCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = temporary_folder();
    for (const char* made : {"cylinder --diameter-mm 56 --length-mm 120 --out thick.stl",
                             "cylinder --diameter-mm 24 --length-mm 120 --out thin.stl"}) {
      const ProgramRun run = palmar(std::string("product make ") + made);
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
  }
  static ProgramRun palmar(const std::string& arguments) { return run_palmar(arguments, folder_); }
  static Json assessed(const std::string& options) {
    const ProgramRun run = palmar("assess thick.stl thin.stl --unit mm --quiet --json " + options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.exit_code == 0 ? Json::parse(run.out) : Json();
  }
  static std::string folder_;
};
std::string AnswerCommand::folder_;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

TEST_F(AnswerCommand, IsTheSameInTheTextTheJsonAndThePage) {
  const ProgramRun text = palmar(
      "assess thick.stl thin.stl --unit mm --grip-force-n 40 --no-pictures --out two --quiet");
  ASSERT_EQ(text.exit_code, 0) << text.err;
  const Json json = Json::parse(read_text(folder_ + "/two/assessment.json"));
  const std::string sentence = json.at("verdict").at("sentence");
  EXPECT_EQ(first_line(text.out), sentence);
  EXPECT_THAT(read_text(folder_ + "/two/report.html"), HasSubstr(sentence + "</p>"));
  EXPECT_THAT(sentence, StartsWith("thin presses "));
  EXPECT_THAT(sentence,
              HasSubstr("% less than thick at its hardest place, in the same grip of 40"));
  EXPECT_EQ(json.at("verdict").at("best"), "thin");
  // The percentage is that of the figures.
  const auto peak = [&](int i) {
    return json.at("assessments").at(i).at("contact").at("peak_pressure_cells_mpa").get<double>();
  };
  EXPECT_NEAR(json.at("verdict").at("comparisons").at(0).at("peak_change").get<double>(),
              peak(1) / peak(0) - 1.0, 1e-12);
  // Both are held alike, so that what differs is the products.
  const Json& pair = json.at("verdict").at("comparisons").at(0);
  EXPECT_LT(pair.at("hand_turned_deg").get<double>(), 10.0);
  EXPECT_LT(pair.at("hand_shifted_mm").get<double>(), 5.0);
  EXPECT_EQ(pair.at("held_alike"), true);
  // Nothing else judges comfort.
  EXPECT_THAT(text.out, Not(HasSubstr("algometer")));
}

TEST_F(AnswerCommand, AHoldByNumberIsTheSameBesideAnotherProduct) {
  const Json beside = assessed("--grip-force-n 40 --hold 2").at("assessments").at(1);
  const ProgramRun run =
      palmar("assess thin.stl --unit mm --quiet --json --grip-force-n 40 --hold 2");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json alone = Json::parse(run.out).at("assessments").at(0);
  for (const char* key : {"words", "along", "toward", "turn_deg"}) {
    EXPECT_EQ(beside.at("hold").at(key), alone.at("hold").at(key)) << key;
  }
}

TEST_F(AnswerCommand, ComfortIsWhatItsFiguresSay) {
  const Json one = assessed("--grip-force-n 40").at("assessments").at(0);
  const Json& comfort = one.at("verdict").at("comfort");
  double most = 0.0;
  for (const Json& region : one.at("contact").at("regions")) {
    most = std::max(most, region.at("peak_pressure_cells_mpa").get<double>());
  }
  EXPECT_LE(comfort.at("moment").at("pressure_mpa").get<double>(), most);
  for (const char* key : {"moment", "repeated"}) {
    const Json& onset = comfort.at(key);
    EXPECT_NEAR(onset.at("share").get<double>(),
                onset.at("pressure_mpa").get<double>() / onset.at("onset_mpa").get<double>(),
                1e-12);
  }
  EXPECT_NEAR(comfort.at("repeated").at("share").get<double>(),
              one.at("indices").at("discomfort_onset_percent").get<double>() / 100.0, 1e-9);
  EXPECT_NEAR(comfort.at("minutes").at("share_of_skin").get<double>(),
              one.at("indices").at("skin_above_50_kpa_percent").get<double>() / 100.0, 1e-9);
}

TEST_F(AnswerCommand, SpeaksGerman) {
  const ProgramRun run = palmar(
      "assess thick.stl thin.stl --unit mm --grip-force-n 40 --no-pictures --out de --quiet "
      "--language de");
  EXPECT_THAT(first_line(run.out), HasSubstr("drückt an der härtesten Stelle"));
  const ProgramRun wrong = palmar("assess thin.stl --unit mm --language fr");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("--language is \"fr\"; en or de"));
}

TEST_F(AnswerCommand, ThoroughTheHandIsThatOfThePersonAskedFor) {
  const Json small = assessed("--person woman:P5");
  const Json large = assessed("--person man:P95,age=30");
  const auto length = [](const Json& json) {
    return json.at("assessments").at(0).at("hand").at("hand_length_mm").get<double>();
  };
  // ANSUR II women: 181.08 mm, SD 10.056; men 193.28, 9.946 (docs/method/populations.md).
  EXPECT_NEAR(length(small), 181.08 - 1.6448536 * 10.056, 0.2);
  EXPECT_NEAR(length(large), 193.28 + 1.6448536 * 9.946, 0.2);
  // A quarter of her own strength, unless a force is given.
  const Json& strength = small.at("assessments").at(1).at("verdict").at("strength");
  EXPECT_NEAR(strength.at("for_comparison").at("share").get<double>(), 0.25, 0.01);
  const Json given = assessed("--person woman:P5 --grip-force-n 30");
  EXPECT_EQ(given.at("assessments").at(0).at("settings").at("grip_force_asked_n"), 30.0);
}

TEST_F(AnswerCommand, ThoroughALeftHandIsTheMirrorImage) {
  const Json right = assessed("--grip-force-n 40"), left = assessed("--grip-force-n 40 --left");
  const Json &a = right.at("assessments").at(1), &b = left.at("assessments").at(1);
  EXPECT_EQ(b.at("hand").at("side"), "left");
  const auto peak = [](const Json& one) {
    return one.at("contact").at("peak_pressure_cells_mpa").get<double>();
  };
  EXPECT_NEAR(peak(a), peak(b), 0.02 * peak(a));  // the product's mesh isn't quite symmetric
}

TEST_F(AnswerCommand, OfManyHandsIsASmallStudy) {
  const ProgramRun run = palmar(
      "assess thick.stl thin.stl --unit mm --grip-force-n 40 --population ansur2_women --hands 3 "
      "--no-pictures --out many --quiet");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("3 hands agree"));
  EXPECT_TRUE(fs::exists(folder_ + "/many/report.html"));
  const ProgramRun compared = palmar("study compare many/hands.palmar --json");
  EXPECT_EQ(Json::parse(compared.out).at("verdict").at("sentence"), first_line(run.out));
  EXPECT_THAT(palmar("study compare many/hands.palmar").out, StartsWith(first_line(run.out)));
}

TEST_F(AnswerCommand, OptionsThatCantBeTakenAreNamed) {
  const struct {
    std::string options, said;
  } cases[] = {
      {"--person child", "--person is \"child\"; woman or man is required"},
      {"--person woman:P0", "--person has the percentile 0; above 0 and below 100"},
      {"--hands 3", "--hands is the number of hands of a --population"},
      {"--population ansur2_women --friction 0.5", "--friction is of one hand"},
      {"--paper a5", "--paper is \"a5\"; a4 or letter"},
  };
  for (const auto& [options, said] : cases) {
    const ProgramRun run = palmar("assess thin.stl --unit mm " + options);
    EXPECT_EQ(run.exit_code, 2) << options;
    EXPECT_THAT(run.err, HasSubstr(said));
  }
}

}  // namespace
}  // namespace palmar::testing
