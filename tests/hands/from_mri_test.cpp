// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"

// `palmar hand from-mri` as a user runs it. Finding surfaces in fine images takes minutes, so that
// the scans are folders of surfaces, as a user may give them, made of a synthetic person's truth;
// what is found in images is tested beside the code that does it. Refusals come from images.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

constexpr const char* kPostures[] = {"reference", "thumb_flexion", "grasp"};

/// The true surfaces of a posture as `palmar mri surfaces` leaves what it found.
void write_surfaces(const std::string& root, const std::string& posture, const Json& truth) {
  const fs::path from = fs::path(root) / "p/truth" / posture;
  const fs::path to = fs::path(root) / "scans" / posture;
  fs::create_directories(to);
  fs::copy(from / "skin.ply", to / "skin.ply");
  fs::copy(from / "bones", to / "bones");
  const Json& state = truth.at("postures").at(posture);
  Json bones = Json::array();
  for (const auto& [name, pose] : state.at("patient_from_reference").items()) {
    bones.push_back({{"name", name}, {"file", "bones/" + name + ".ply"}, {"is_cut", false}});
  }
  const Json index = {{"palmar_scan_version", 1},
                      {"key", ""},
                      {"side", truth.at("side")},
                      {"air_threshold", 40.0},
                      {"bone_threshold", 90.0},
                      {"noise", 0.0},
                      {"bone_error_estimate_mm", 0.1},
                      {"skin", "skin.ply"},
                      {"bones", bones},
                      {"markers_mm", state.at("markers_mm")},
                      {"notes", Json::array()}};
  write_text((to / "scan.json").string(), index.dump());
}

/// A left hand in three postures: images in p/mri, surfaces in scans. Made once.
const std::string& person() {
  static const std::string folder = [] {
    const std::string made = temporary_folder();
    const ProgramRun run = run_palmar(
        "phantom mri --seed 4 --side left --pixel-mm 3 --slice-mm 4 --slices 30 --posture "
        "reference,thumb_flexion,grasp --out p",
        made);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const Json truth = Json::parse(read_text(made + "/p/truth/subject.json"));
    for (const char* posture : kPostures) write_surfaces(made, posture, truth);
    return made;
  }();
  return folder;
}

/// All three scans and the bar that was held. Run once.
const ProgramRun& whole_run() {
  static const ProgramRun run = run_palmar(
      "hand from-mri scans --out anna.hand.glb --product p/truth/grasp/product.ply --no-report "
      "--json",
      person());
  return run;
}

/// A copy of the surfaces of the reference, to be spoilt.
std::string copied_reference(const std::string& name) {
  fs::copy(person() + "/scans/reference", person() + "/" + name, fs::copy_options::recursive);
  return person() + "/" + name + "/scan.json";
}

/// Names of the bones in a found.toml, with the words that say where they are.
std::multimap<std::string, std::string> bones_in_toml(const std::string& toml) {
  std::multimap<std::string, std::string> bones;
  for (std::size_t at = toml.find("[[bone]]"); at != std::string::npos;
       at = toml.find("[[bone]]", at + 1)) {
    const std::size_t name = toml.find("name = \"", at) + 8, place = toml.find("at_mm = ", at) + 8;
    bones.emplace(toml.substr(name, toml.find('"', name) - name),
                  toml.substr(place, toml.find('\n', place) - place));
  }
  return bones;
}

TEST(HandFromMri, ComesOutLikeThePerson) {
  ASSERT_EQ(whole_run().exit_code, 0) << whole_run().err;
  const Json record = Json::parse(whole_run().out);
  const Json truth = Json::parse(read_text(person() + "/p/truth/subject.json"));
  EXPECT_EQ(record.at("side"), "left");
  for (const char* dimension : {"hand_length_mm", "hand_width_mm", "hand_circumference_mm"}) {
    EXPECT_NEAR(record.at("hand").at(dimension).get<double>(),
                truth.at("dimensions").at(dimension).get<double>(), 2.0)
        << dimension;
  }
  for (const Json& row : record.at("bone_error_rows")) {
    EXPECT_LT(row.at("icp_mm").get<double>(), 0.2) << row;
    EXPECT_LT(row.at("single_axis_mm").get<double>(), 1.5) << row;
  }
  ASSERT_EQ(record.at("skin_errors").size(), 1U);
  const Json& skin = record.at("skin_errors").at(0);
  EXPECT_LT(skin.at("corrected_mm").get<double>(), 0.6);
  EXPECT_LT(skin.at("corrected_mm").get<double>(), 0.5 * skin.at("skinning_only_mm").get<double>());
  const ProgramRun info = run_palmar("hand info anna.hand.glb", person());
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("left"));
}

TEST(HandFromMri, ContactIsComparedOnWhatIsHeld) {
  ASSERT_EQ(whole_run().exit_code, 0) << whole_run().err;
  const Json contact = Json::parse(whole_run().out).at("grasp_contact");
  EXPECT_EQ(contact.at("range_mm"), 2.0);
  // A hand closed on a bar: 3300 to 4000 mm^2 (docs/method/phantom.md) of 2 mm about the skin.
  EXPECT_GT(contact.at("scanned_area_mm2").get<double>(), 2000.0);
  EXPECT_LT(contact.at("scanned_area_mm2").get<double>(), 6000.0);
  EXPECT_GT(contact.at("share_of_scan").get<double>(), 0.6);
  EXPECT_GT(contact.at("intersection_over_union").get<double>(), 0.5);
  write_text(person() + "/far.obj",
             "v 500 0 0\nv 510 0 0\nv 500 10 0\nv 500 0 10\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const ProgramRun elsewhere = run_palmar(
      "hand from-mri scans --out b.hand.glb --work anna.mri --product far.obj --unit mm "
      "--no-report",
      person());
  EXPECT_EQ(elsewhere.exit_code, 3);
  EXPECT_THAT(elsewhere.err, HasSubstr("from the skin in the scan of the grasp"));
  const ProgramRun none = run_palmar(
      "hand from-mri scans --skip grasp --out b.hand.glb --product p/truth/grasp/product.ply",
      person());
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_THAT(none.err, HasSubstr("none of the scans shows the posture grasp"));
}

TEST(HandFromMri, AnotherRunGivesTheSameHand) {
  ASSERT_EQ(whole_run().exit_code, 0) << whole_run().err;
  const std::string hand = read_text(person() + "/anna.hand.glb");
  const ProgramRun again = run_palmar(
      "hand from-mri scans --out again.hand.glb --name anna --work anna.mri --no-report", person());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(read_text(person() + "/again.hand.glb"), hand);
}

TEST(HandFromMri, SaysWhatAMissingPostureCosts) {
  copied_reference("alone");
  const ProgramRun run = run_palmar(
      "hand from-mri alone --series alone=reference --out only.hand.glb --no-report --json",
      person());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json record = Json::parse(run.out);
  EXPECT_THAT(record.at("notes").dump(), HasSubstr("No limit posture of the thumb was scanned"));
  for (const Json& joint : record.at("joints")) EXPECT_FALSE(joint.at("is_measured")) << joint;
  EXPECT_TRUE(record.at("bone_errors").empty());
  EXPECT_TRUE(record.at("grasp_contact").is_null());
}

TEST(HandFromMri, NoHandIsMadeOfTooLittle) {
  const std::string index = copied_reference("few_bones");
  Json scan = Json::parse(read_text(index));
  for (Json& bone : scan["bones"]) {
    if (bone.at("name").get<std::string>().rfind("little_", 0) == 0) bone["name"] = "";
  }
  write_text(index, scan.dump());
  const ProgramRun few =
      run_palmar("hand from-mri few_bones --series few=reference --out x.hand.glb", person());
  EXPECT_EQ(few.exit_code, 3);
  EXPECT_THAT(few.err, AllOf(HasSubstr("too few bones"), HasSubstr("little_proximal_phalanx"),
                             HasSubstr("--labels")));
  EXPECT_THAT(few.err,
              AllOf(HasSubstr("step bones (reference) failed"), HasSubstr("x.mri/report.html")));
  const Json found = Json::parse(read_text(person() + "/x.mri/found.json"));
  EXPECT_EQ(found.at("refusal").at("step"), "bones");
  EXPECT_THAT(found.at("refusal").at("message").get<std::string>(), HasSubstr("--labels"));
  EXPECT_EQ(found.at("scans").at(0).at("unnamed_bones"), 4);
  const std::string page = read_text(person() + "/x.mri/report.html");
  EXPECT_THAT(page, AllOf(HasSubstr("too few bones"), HasSubstr("data:image/png")));
  // The sheet was drawn before it was refused, and the file has them to be named.
  EXPECT_EQ(read_text(person() + "/x.mri/found.png").substr(1, 3), "PNG");
  const auto bones = bones_in_toml(read_text(person() + "/x.mri/found.toml"));
  EXPECT_EQ(bones.size(), 29U);
  EXPECT_EQ(bones.count(""), 4U);

  const std::string cut = copied_reference("cut");
  scan = Json::parse(read_text(cut));
  for (Json& bone : scan["bones"]) bone["is_cut"] = bone.at("name") == "middle_distal_phalanx";
  write_text(cut, scan.dump());
  const ProgramRun part =
      run_palmar("hand from-mri cut --series cut=reference --out x.hand.glb", person());
  EXPECT_EQ(part.exit_code, 3);
  EXPECT_THAT(part.err, HasSubstr("the edge of the image cuts the hand at middle_distal_phalanx"));

  const ProgramRun coarse = run_palmar("hand from-mri p/mri --out x.hand.glb", person());
  EXPECT_EQ(coarse.exit_code, 3);
  EXPECT_THAT(coarse.err, HasSubstr("too coarse for bones"));
  EXPECT_FALSE(fs::exists(person() + "/x.hand.glb"));
}

TEST(HandFromMri, AWrongNameIsPutRightByTheFileOfThePerson) {
  const std::string index = copied_reference("swapped");
  const std::string one = "index_middle_phalanx", other = "ring_middle_phalanx";
  Json scan = Json::parse(read_text(index));
  for (Json& bone : scan["bones"]) {
    bone["name"] = bone.at("name") == one     ? Json(other)
                   : bone.at("name") == other ? Json(one)
                                              : bone.at("name");
  }
  write_text(index, scan.dump());
  const std::string look =
      "hand from-mri swapped --series swapped=reference --look --out s.hand.glb";
  const ProgramRun first = run_palmar(look, person());
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.err, AllOf(HasSubstr("s.mri/found.png"), HasSubstr("no hand was made")));
  EXPECT_FALSE(fs::exists(person() + "/s.hand.glb"));
  EXPECT_FALSE(fs::exists(person() + "/s.mri/report.html"));
  auto found = bones_in_toml(read_text(person() + "/s.mri/found.toml"));
  const std::string at_one = found.find(one)->second, at_other = found.find(other)->second;
  const auto table = [](const std::string& name, const std::string& at) {
    return "[[bone]]\nname = \"" + name + "\"\nat_mm = " + at + "\n";
  };
  write_text(person() + "/anna.toml",
             "side = \"left\"\n" + table(other, at_one) + table(one, at_other));
  const ProgramRun second = run_palmar(look + " --known anna.toml", person());
  ASSERT_EQ(second.exit_code, 0) << second.err;
  found = bones_in_toml(read_text(person() + "/s.mri/found.toml"));
  EXPECT_EQ(found.find(one)->second, at_other);
  EXPECT_EQ(found.find(other)->second, at_one);

  // What can't be is named with its line, and what was found is shown all the same.
  fs::remove(person() + "/s.mri/found.png");
  write_text(person() + "/wrong.toml", table(one, "[900.0, 0.0, 0.0]"));
  const ProgramRun far = run_palmar(look + " --known wrong.toml", person());
  EXPECT_EQ(far.exit_code, 3);
  EXPECT_THAT(far.err, HasSubstr("wrong.toml:1: no bone was found within 3 mm"));
  EXPECT_TRUE(fs::exists(person() + "/s.mri/found.png"));
  // An option counts more than the file.
  const auto row = [](const std::string& name, const std::string& at) {
    return name + "," + at.substr(1, at.size() - 2) + "\n";
  };
  write_text(person() + "/names.csv",
             "name,x_mm,y_mm,z_mm\n" + row(one, at_other) + row(other, at_one));
  const ProgramRun said = run_palmar(look + " --known wrong.toml --labels names.csv", person());
  EXPECT_EQ(said.exit_code, 0) << said.err;
  write_text(person() + "/wrong.toml", table("index_midle_phalanx", at_one));
  const ProgramRun unknown = run_palmar(look + " --known wrong.toml", person());
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("wrong.toml:1"), HasSubstr(one)));
}

TEST(HandFromMri, ALateRefusalLeavesWhatWasFoundAndNoHand) {
  // A skin that isn't round the bones: only the last step but one meets it.
  const std::string index = copied_reference("other_skin");
  const fs::path folder = fs::path(index).parent_path();
  fs::copy(folder / "bones/capitate.ply", folder / "skin.ply",
           fs::copy_options::overwrite_existing);
  const std::string words = "hand from-mri other_skin --series other=reference --out late.hand.glb";
  const ProgramRun late = run_palmar(words, person());
  EXPECT_EQ(late.exit_code, 3) << late.err;
  EXPECT_THAT(late.err, AllOf(HasSubstr("step hand failed"), HasSubstr("late.mri/report.html"),
                              HasSubstr("No bone of it looks wrong")));
  EXPECT_FALSE(fs::exists(person() + "/late.hand.glb"));
  EXPECT_FALSE(fs::exists(person() + "/late.mri/hand.json"));
  const Json found = Json::parse(read_text(person() + "/late.mri/found.json"));
  EXPECT_EQ(found.at("refusal").at("step"), "hand");
  EXPECT_EQ(found.at("scans").at(0).at("bones").size(), 29U);
  EXPECT_THAT(read_text(person() + "/late.mri/report.html"), HasSubstr("data:image/png"));
  // Nothing but the surfaces' folder is said to be there without a report.
  const ProgramRun bare = run_palmar(words + " --work bare.mri --no-report", person());
  EXPECT_EQ(bare.exit_code, 3);
  EXPECT_THAT(bare.err, Not(HasSubstr("report.html")));
}

TEST(HandFromMri, DamagedSeriesAreNamedBeforeTheWork) {
  const std::string folder = person() + "/damaged";
  fs::copy(person() + "/p/mri", folder, fs::copy_options::recursive);
  const std::string slice = folder + "/grasp/slice-0015.dcm";
  std::string bytes = read_text(slice);
  for (std::size_t k = bytes.size() - 4000; k < bytes.size(); ++k) bytes[k] = char(k * k % 251);
  write_text(slice, bytes);
  const ProgramRun odd = run_palmar("hand from-mri damaged --out odd.hand.glb", person());
  EXPECT_EQ(odd.exit_code, 3);
  EXPECT_THAT(odd.err,
              AllOf(HasSubstr("grasp/slice-0015.dcm: differs"), HasSubstr("--accept-odd-slices")));
  EXPECT_FALSE(fs::exists(person() + "/odd.mri"));  // made for it, and nothing came of it
  const ProgramRun step = run_palmar("mri surfaces damaged/grasp --out step", person());
  EXPECT_EQ(step.exit_code, 3);
  EXPECT_THAT(step.err,
              AllOf(HasSubstr("grasp/slice-0015.dcm: differs"), HasSubstr("--accept-odd-slices")));
  EXPECT_FALSE(fs::exists(person() + "/step"));

  write_text(slice, bytes.substr(0, bytes.size() / 2));
  const ProgramRun cut_off = run_palmar("hand from-mri damaged --out x.hand.glb", person());
  EXPECT_EQ(cut_off.exit_code, 3);
  EXPECT_THAT(cut_off.err, AllOf(HasSubstr("slice-0015.dcm"), HasSubstr("the pixels end after"),
                                 HasSubstr("--skip grasp")));

  fs::remove_all(folder + "/reference");
  const ProgramRun lacking =
      run_palmar("hand from-mri damaged --skip grasp --out x.hand.glb", person());
  EXPECT_EQ(lacking.exit_code, 2);
  EXPECT_THAT(lacking.err, HasSubstr("none of the series is the reference posture"));
}

TEST(HandFromMri, WrongUseIsNamed) {
  const auto fails = [](const std::string& arguments, const std::string& says, int code) {
    const ProgramRun run = run_palmar("hand from-mri " + arguments, person());
    EXPECT_EQ(run.exit_code, code) << arguments;
    EXPECT_THAT(run.err, HasSubstr(says));
    EXPECT_THAT(run.err, Not(HasSubstr("terminate")));
  };
  fails("scans --out x.glb", "must end in .hand.glb", 2);
  fails("nowhere --out x.hand.glb", "nowhere: there is no such file or folder", 3);
  fails("scans --out x.hand.glb --skip fist", "no posture", 2);
  fails("scans --out x.hand.glb --series 9=grasp", "fits no series", 2);
  fs::create_directories(person() + "/empty");
  fails("empty --out x.hand.glb", "empty: is empty", 3);
  fails("p/mri --out x.hand.glb --work p/mri", "holds the images themselves", 2);
  fails("scans --out nowhere/x.hand.glb --work w", "nowhere: there is no such folder", 1);
  EXPECT_FALSE(fs::exists(person() + "/w"));
  // Labels are read before the long search.
  write_text(person() + "/labels.csv", "name,x,y\ncapitate,1,2\n");
  const ProgramRun labels =
      run_palmar("mri surfaces p/mri/grasp --out step --labels labels.csv", person());
  EXPECT_EQ(labels.exit_code, 3);
  EXPECT_THAT(labels.err, HasSubstr("labels.csv"));
}

}  // namespace
}  // namespace palmar::testing
