// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/job_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::server {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string first_command(const std::string& json, const JobPlaces& places) {
  return command_text(commands_of(parse_job_request(json), places).front());
}

std::string refusal_of(const std::string& json) {
  try {
    parse_job_request(json);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

const JobPlaces& two_files() {
  static const JobPlaces places{{"old.stl", "my new.stl"}, geometry::LengthUnit::kCentimetre, ""};
  return places;
}

TEST(JobRequest, StudyIsTheCommandThatPeopleType) {
  const std::string json =
      R"({"kind": "study", "products": ["p1", "p2"], "populations": ["ansur2_women",
          "ansur2_men"], "hands": 12, "grip_force_n": 60, "mass_kg": 0.5, "hold": 2,
          "language": "de"})";
  EXPECT_EQ(first_command(json, two_files()),
            "palmar study run --product old.stl --product 'my new.stl' --unit cm --population "
            "ansur2_women --population ansur2_men --hands 12 --hold 2 --grip-force-n 60 --mass-kg "
            "0.5 --out study.palmar");
  const auto all = commands_of(parse_job_request(json), {{"a.stl"}, {}, "/data/j1/"});
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(command_text(all[1]),
            "palmar study report /data/j1/study.palmar --out /data/j1/report --language de");
  EXPECT_DOUBLE_EQ(all[0].share + all[1].share, 1.0);
  EXPECT_EQ(command_text(estimate_of(parse_job_request(json), {{"a.stl"}, {}, ""})),
            "palmar study plan --product a.stl --population ansur2_women --population ansur2_men "
            "--hands 12 --hold 2 --grip-force-n 60 --mass-kg 0.5 --json");
}

TEST(JobRequest, GivenPeopleHaveNoNumberOfHands) {
  EXPECT_THAT(first_command(R"({"kind": "study", "products": ["p1"],
                                "populations": ["woman:P5..man:P95"], "hands": 30})",
                            {{"a.stl"}, {}, ""}),
              AllOf(HasSubstr("--population woman:P5..man:P95"), Not(HasSubstr("--hands"))));
}

TEST(JobRequest, ComparisonAndRedesigns) {
  EXPECT_EQ(first_command(R"({"kind": "compare", "products": ["p1", "p2"], "person": "man:P95",
                              "left": true, "grip_force_n": 40})",
                          two_files()),
            "palmar assess old.stl 'my new.stl' --unit cm --person man:P95 --left --grip-force-n "
            "40 --language en --out report");
  const auto redesign = [](const std::string& more) {
    return first_command(R"({"kind": "redesign", "products": ["p1"], "populations": ["xie2014"],
                             "hands": 6, )" +
                             more + "}",
                         {{"a.step"}, {}, ""});
  };
  EXPECT_EQ(redesign(R"("verb": "press", "largest_depth_mm": 3)"),
            "palmar redesign press a.step --population xie2014 --hands 6 --largest-depth-mm 3 "
            "--language en --out redesign");
  EXPECT_THAT(redesign(R"("verb": "fillet", "radius_mm": [2, 9])"),
              HasSubstr("--edges long --radius-mm 2:9"));
  EXPECT_THAT(redesign(R"("verb": "features")"), HasSubstr("--propose"));
  EXPECT_THAT(redesign(R"("verb": "features", "vary": ["fillet:face=7=2:6", "offset:sides=-1"])"),
              AllOf(HasSubstr("--vary fillet:face=7=2:6 --vary offset:sides=-1"),
                    Not(HasSubstr("--propose"))));
}

TEST(JobRequest, PreviewIsMadeByFewHandsAndComparesNothing) {
  const auto preview = [](const std::string& more) {
    return command_text(estimate_of(
        parse_job_request(R"({"kind": "redesign", "products": ["p1"], "populations": ["ansur2"],
                              "hands": 30, )" +
                          more + "}"),
        {{"a.step"}, {}, "/j/"}));
  };
  EXPECT_EQ(preview(R"("verb": "press", "largest_depth_mm": 3)"),
            "palmar redesign press a.step --population ansur2 --hands 4 --largest-depth-mm 3 "
            "--no-compare --no-pictures --out /j/preview");
  EXPECT_THAT(preview(R"("verb": "fillet", "radius_mm": [2, 9])"),
              AllOf(HasSubstr("--radius-mm 5.5 "), HasSubstr("--no-compare")));
  EXPECT_THAT(preview(R"("verb": "fillet", "radius_mm": [2, 9], "preview_mm": 8)"),
              HasSubstr("--radius-mm 8 "));
  EXPECT_THAT(preview(R"("verb": "features", "vary": ["fillet:long=1:7"])"),
              HasSubstr("--vary fillet:long=4 "));
  const auto is_tried = [](const std::string& verb) {
    return is_tried_first(parse_job_request(
        R"({"kind": "redesign", "products": ["p1"], "populations": ["ansur2"], "hands": 3, )" +
        verb + "}"));
  };
  EXPECT_TRUE(is_tried(R"("verb": "region")"));
  EXPECT_FALSE(is_tried(R"("verb": "features")")) << "proposals have no shape yet";
  EXPECT_TRUE(is_tried(R"("verb": "features", "vary": ["fillet:long=3"])"));
}

TEST(JobRequest, OwnHandIsAHandOfThisServer) {
  const std::string json = R"({"kind": "compare", "products": ["p1", "p2"], "person": "hand:j12"})";
  JobPlaces places = two_files();
  places.hand = "/j/j12/found/anna.hand.glb";
  EXPECT_THAT(first_command(json, places), HasSubstr("--hand /j/j12/found/anna.hand.glb"));
  EXPECT_EQ(job_request_json(parse_job_request(json)).find("hand:j12") == std::string::npos, false);
  EXPECT_NE(refusal_of(R"({"kind": "compare", "products": ["p1", "p2"], "person": "hand:../x"})"),
            "taken");
}

TEST(JobRequest, ReadsBackAsItWasWritten) {
  for (const char* json :
       {R"({"kind": "study", "products": ["p1"], "populations": ["ansur2"], "hands": 3})",
        R"({"kind": "compare", "products": ["p1", "p2"], "left": true, "mass_kg": 1.5})",
        R"({"kind": "redesign", "products": ["p1"], "verb": "fillet", "populations": ["ansur2"],
            "hands": 3, "radius_mm": [1, 2.5], "hold": 4})"}) {
    const std::string once = job_request_json(parse_job_request(json));
    EXPECT_EQ(job_request_json(parse_job_request(once)), once);
  }
}

TEST(JobRequest, RefusesWhatIsWrongByName) {
  const std::string study = R"({"kind": "study", "products": ["p1"], )";
  EXPECT_THAT(refusal_of("[]"), HasSubstr("no JSON object"));
  EXPECT_THAT(refusal_of(R"({"kind": "rm"})"), AllOf(HasSubstr("rm"), HasSubstr("compare")));
  EXPECT_THAT(refusal_of(study + R"("populations": ["ansur2"]})"), HasSubstr("hands"));
  EXPECT_THAT(refusal_of(study + R"("populations": ["ansur2"], "hands": 5000})"),
              HasSubstr("5000"));
  // No file of this machine, no option in place of a name.
  for (const char* name : {"/etc/passwd", "ours.csv", "../a.toml", "--out", "", "woman:P5/../x"}) {
    EXPECT_THAT(refusal_of(study + R"("hands": 3, "populations": [")" + name + "\"]}"),
                HasSubstr("population"))
        << name;
  }
  EXPECT_NE(refusal_of(study + R"("populations": ["woman:P95..woman:P5"]})"), "taken");
  EXPECT_THAT(refusal_of(R"({"kind": "compare", "products": ["p1"]})"), HasSubstr("products"));
  EXPECT_THAT(refusal_of(R"({"kind": "compare", "products": ["p1", "p1"]})"),
              HasSubstr("different"));
  EXPECT_THAT(refusal_of(R"({"kind": "compare", "products": ["p1", "p2"], "person": "child"})"),
              HasSubstr("child"));
  EXPECT_THAT(refusal_of(R"({"kind": "compare", "products": ["p1", "p2"], "grip_force_n": -1})"),
              AllOf(HasSubstr("grip_force_n"), HasSubstr("-1")));
  EXPECT_THAT(refusal_of(R"({"kind": "redesign", "products": ["p1"], "populations": ["ansur2"],
                             "hands": 3, "verb": "--help"})"),
              HasSubstr("press, region, fillet or features"));
  for (const char* vary : {"groove:/etc/passwd=1", "groove:line.csv=1", "--out=3", "fillet:long",
                           "fillet:long=x", "fillet:a b=1", "fillet:long=1:", ""}) {
    EXPECT_THAT(refusal_of(R"({"kind": "redesign", "products": ["p1"], "populations": ["ansur2"],
                               "hands": 3, "verb": "features", "vary": [")" +
                           std::string(vary) + "\"]}"),
                HasSubstr("vary"))
        << vary;
  }
}

}  // namespace
}  // namespace palmar::server
