// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/hand_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"
#include "palmar/server/job_request.h"

namespace palmar::server {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string hand(const std::string& members) { return R"({"kind": "hand", )" + members + "}"; }

std::string hand_command(const std::string& members, const std::vector<std::string>& sources) {
  JobPlaces places;
  places.sources = sources;
  return command_text(commands_of(parse_job_request(hand(members)), places).front());
}

std::string hand_refusal(const std::string& members) {
  try {
    parse_job_request(hand(members));
  } catch (const UsageError& error) {
    return error.what();
  }
  return "taken";
}

TEST(HandRequest, IsTheCommandThatPeopleType) {
  EXPECT_EQ(
      hand_command(R"("method": "scan", "uploads": "k", "name": "anna", "unit": "cm",
                            "crease_colour": "#20a040", "dot_colour": "blue", "side": "left")",
                   {"reference.ply", "finger_flexion.ply"}),
      "palmar hand from-scan reference.ply finger_flexion.ply --known person.toml "
      "--crease-colour '#20a040' --dot-colour blue --unit cm --language en --work found --out "
      "found/anna.hand.glb");
  EXPECT_EQ(hand_command(R"("method": "quick", "uploads": "k", "name": "anna", "sheet": "card",
                            "wrist_inside_mm": 12, "palm_up": true, "population": "ansur2_women",
                            "sizes_mm": {"hand_circumference": 190.5}, "unit": "cm")",
                         {"photo.jpg"}),
            "palmar hand quick photo.jpg --known person.toml --population ansur2_women --sheet "
            "card --wrist-inside-mm 12 --palm-up --picture found/found.png "
            "--json --out found/anna.hand.glb");
  EXPECT_THAT(hand_command(R"("method": "photos", "uploads": "k")", {"anna"}),
              HasSubstr("palmar hand from-photos anna "));
  EXPECT_THAT(hand_command(R"("method": "mri", "uploads": "k", "dot_colour": "blue")", {"mri"}),
              AllOf(HasSubstr("palmar hand from-mri mri --language en --work found --out "
                              "found/hand.hand.glb"),
                    Not(HasSubstr("colour"))));
  EXPECT_EQ(hand_command(R"("method": "file", "uploads": "k")", {"anna.hand.glb"}),
            "palmar hand info anna.hand.glb");
}

TEST(HandRequest, WhatIsKnownOfThePersonIsOneFile) {
  const HandRequest request = parse_job_request(hand(R"("method": "scan", "uploads": "k",
      "side": "left", "pick_dot": [1, 2, 0.1], "sizes_mm": {"hand_length": 181.5},
      "corrections": [
        {"posture": "reference", "mark": "dot", "name": "none", "place_mm": [1, -2.5, 3]},
        {"posture": "finger_flexion", "mark": "added_dot", "name": "palm", "place_mm": [4, 5, 6]},
        {"posture": "reference", "mark": "added_dot", "name": "none", "place_mm": [4, 5, 6]},
        {"name": "index_middle_phalanx", "place_mm": [7, 8, 9]}])"))
                                  .hand;
  EXPECT_EQ(records::format_person(request.known), R"(side = "left"

[scan]
pick_dot = [1.0, 2.0, 0.1]

[[mark]]
posture = "reference"
mark = "dot"
name = "none"
at_mm = [1.0, -2.5, 3.0]

[[mark]]
posture = "finger_flexion"
mark = "added_dot"
name = "palm"
at_mm = [4.0, 5.0, 6.0]

[[bone]]
name = "index_middle_phalanx"
at_mm = [7.0, 8.0, 9.0]

[measured_mm]
hand_length = 181.5
)");
  for (const char* method : {"scan", "photos", "mri", "quick"}) {
    const std::string members = R"("uploads": "k", "method": ")" + std::string(method) + '"';
    EXPECT_THAT(hand_command(members + R"(, "side": "left")", {"a"}),
                HasSubstr(" a --known person.toml "));
    EXPECT_THAT(hand_command(members, {"a"}), Not(HasSubstr("--known")));
  }
}

TEST(HandRequest, ReadsBackAsItWasWritten) {
  const std::string json = hand(R"("method": "quick", "uploads": "", "name": "anna", "side": "left",
      "sizes_mm": {"hand_length": 181}, "population": "ansur2"))");
  const std::string once = job_request_json(parse_job_request(
      hand(R"("method": "quick", "name": "anna", "side": "left", "sizes_mm": {"hand_length": 181},
              "pick_crease": [0.1, 2, 3],
              "corrections": [{"mark": "dot", "name": "palm", "place_mm": [0, 1, 2]},
                              {"name": "capitate", "place_mm": [0, 1, 2]}])")));
  EXPECT_THAT(once, AllOf(HasSubstr(R"("pick_crease":[0.1,2.0,3.0],"pick_dot":null)"),
                          HasSubstr(R"("posture":"reference","mark":"dot","name":"palm")"),
                          HasSubstr(R"("mark":"","name":"capitate")")));
  EXPECT_EQ(job_request_json(parse_job_request(once)), once);
  EXPECT_THROW(parse_job_request(json), UsageError) << "a bracket too many";
}

TEST(HandRequest, NamesNoFileOfThisMachine) {
  const std::string scan = R"("method": "scan", "uploads": "k")";
  for (
      const char* member :
      {R"("name": "../anna")",
       R"("name": "--out")",
       R"("population": "/etc/passwd")",
       R"("population": "ours.toml")",
       R"("dot_colour": "#12345")",
       R"("crease_colour": "--x")",
       R"("unit": "furlong")",
       R"("side": "both")",
       R"("sheet": "a3")",
       R"("wrist_inside_mm": 1e9)",
       R"("sizes_mm": {"--out": 3})",
       R"("sizes_mm": {"hand_length": -1})",
       R"("sizes_mm": 3)",
       R"("sizes_mm": {"hand_length": 501})",
       R"("sizes_mm": {"arm_length": 300})",
       R"("pick_dot": [1, 2])",
       R"("pick_crease": "/etc/passwd")",
       R"("corrections": [{"mark": "dot", "name": "a,b", "place_mm": [0, 0, 0]}])",
       R"("corrections": [{"mark": "rm", "name": "palm", "place_mm": [0, 0, 0]}])",
       R"("corrections": [{"mark": "dot", "name": "palm", "place_mm": [0, 0]}])",
       R"("corrections": [{"mark": "dot", "name": "palm", "place_mm": [0, 0, 1e300]}])",
       R"("corrections": [{"mark": "dot", "name": "index", "place_mm": [0, 0, 0]}])",
       R"("corrections": [{"mark": "dot", "name": "palm", "posture": "fist", "place_mm": [0, 0, 0]}])",
       R"("corrections": [{"name": "a b", "place_mm": [0, 0, 0]}])",
       R"("corrections": [7])"}) {
    EXPECT_NE(hand_refusal(scan + ", " + member), "taken") << member;
  }
  EXPECT_THAT(hand_refusal(R"("method": "rm")"), AllOf(HasSubstr("rm"), HasSubstr("quick")));
  EXPECT_THAT(hand_refusal(R"("method": "scan")"), HasSubstr("uploads"));
  EXPECT_THAT(hand_refusal(R"("method": "quick")"), HasSubstr("uploads"));
  EXPECT_EQ(hand_refusal(scan), "taken");
}

TEST(HandRequest, SourcesAreWhatTheCommandTakes) {
  const std::vector<std::string> scan = {"calibration/a.jpg", "reference.mtl", "reference.obj",
                                         "reference.png", "spread.PLY"};
  EXPECT_THAT(hand_sources(HandMethod::kScan, scan), ElementsAre("reference.obj", "spread.PLY"));
  EXPECT_THAT(hand_sources(HandMethod::kQuick, {"a.JPG", "notes.txt"}), ElementsAre("a.JPG"));
  EXPECT_THAT(hand_sources(HandMethod::kPhotos, scan), ElementsAre("")) << "the folder itself";
  EXPECT_THAT(hand_sources(HandMethod::kMri, {"a/1.dcm"}), ElementsAre(""));
  EXPECT_THAT(hand_sources(HandMethod::kMri, {"reference.nii.gz"}),
              ElementsAre("reference.nii.gz"));
  EXPECT_TRUE(hand_sources(HandMethod::kFile, {"hand.txt"}).empty());
}

TEST(HandRequest, OneFileSaysWhatIsKnown) {
  EXPECT_EQ(known_source({"reference.ply"}), std::nullopt);
  EXPECT_EQ(known_source({"a/1.dcm", "a/Anna.TOML"}), "a/Anna.TOML");
  EXPECT_THAT(formats::message_of<UsageError>([] {
                known_source({"a.toml", "b.toml"});
              }),
              AllOf(HasSubstr("a.toml"), HasSubstr("b.toml"), HasSubstr("one file")));
}

}  // namespace
}  // namespace palmar::server
