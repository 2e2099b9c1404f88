// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "run_program.h"

// `palmar hand from-scan` and `palmar phantom scan`: what they refuse, and how they say so.

namespace palmar::testing {
namespace {

using ::testing::HasSubstr;

std::string folder_with(const std::string& name, const std::string& text) {
  const std::string folder = temporary_folder();
  std::ofstream(folder + "/" + name) << text;
  return folder;
}

/// A tetrahedron of edge length `size`.
std::string tetrahedron(double size) {
  const std::string s = std::to_string(size);
  return "v 0 0 0\nv " + s + " 0 0\nv 0 " + s + " 0\nv 0 0 " + s +
         "\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
}

void expect_refused(const std::string& arguments, const std::string& folder, int code,
                    const std::string& words) {
  const ProgramRun run = run_palmar(arguments, folder);
  EXPECT_EQ(run.exit_code, code) << run.err;
  EXPECT_THAT(run.err, HasSubstr(words));
}

TEST(HandFromScan, NamesWrongArguments) {
  const std::string folder = folder_with("a.obj", tetrahedron(200));
  expect_refused("hand from-scan a.obj --out a.glb", folder, 2, "must end in .hand.glb");
  expect_refused("hand from-scan a.obj b.obj --out a.hand.glb", folder, 2, "give the posture");
  expect_refused("hand from-scan flexed.obj spread.obj --out a.hand.glb", folder, 2,
                 "no scan shows the reference posture");
  expect_refused("hand from-scan natural.obj open.obj --out a.hand.glb", folder, 2, "both show");
  expect_refused("hand from-scan a.obj --out a.hand.glb --dot-colour pink", folder, 2,
                 "\"pink\" is no colour");
  expect_refused("hand from-scan a.obj --out a.hand.glb --side both", folder, 2,
                 "neither right nor left");
}

TEST(HandFromScan, NamesScansThatCannotBe) {
  const std::string folder = folder_with("a.obj", tetrahedron(200));
  expect_refused("hand from-scan none.obj --out a.hand.glb", folder, 3, "none.obj");
  // 15 long: 150 mm in centimetres, 381 mm in inches.
  std::ofstream(folder + "/b.obj") << tetrahedron(15);
  expect_refused("hand from-scan b.obj --out a.hand.glb", folder, 3, "cm or inch; --unit");
  std::ofstream(folder + "/c.obj") << tetrahedron(0.02);
  expect_refused("hand from-scan c.obj --out a.hand.glb", folder, 3, "in no unit as long");
  expect_refused("hand from-scan a.obj --unit m --out a.hand.glb", folder, 3,
                 "a hand with or without a forearm has 70 (bent) to 480 mm");
  expect_refused("hand from-scan a.obj --out a.hand.glb", folder, 3, "no hand found");
}

// A table beside it, larger than the hand, does no harm, nor do corners that fall together.
TEST(HandFromScan, LeavesTheTableOut) {
  const std::string table = "v 5000 0 0\nv 6000 0 0\nv 5000 1000 0\nf 5 6 7\n";
  const std::string collapsed = "v 0 0 0\nf 1 8 2\n";
  const std::string folder = folder_with("a.obj", tetrahedron(200) + table + collapsed);
  expect_refused("hand from-scan a.obj --out a.hand.glb", folder, 3, "no hand found");
}

/// Rows of a small CSV file without quotes, with its head.
std::vector<std::vector<std::string>> rows_of(const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(read_text(file));
  for (std::string line; std::getline(text, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

using Json = nlohmann::json;

/// A row of marks.csv for a point of the truth.
std::string mark_row(const std::string& mark, const std::string& name, const Json& point) {
  std::string row = "reference," + mark + "," + name;
  for (const Json& value : point) row += "," + std::to_string(value.get<double>());
  return row + "\n";
}

/// A person who wears a ring, scanned once, and once made into a hand with marks that somebody
/// edited: a crease and a dot are left out, a dot is added.
class RingedHand : public ::testing::Test {
 protected:
  static constexpr const char* kHead = "posture,mark,name,x_mm,y_mm,z_mm\n";

  static const std::string& folder() {
    static const std::string made = [] {
      std::string path = temporary_folder();
      const ProgramRun run =
          run_palmar("phantom scan --seed 3 --posture reference --ring ring --out p", path);
      EXPECT_EQ(run.exit_code, 0) << run.err;
      return path;
    }();
    return made;
  }
  static const Json& truth() {
    static const Json json = Json::parse(read_text(folder() + "/p/truth/subject.json"));
    return json;
  }
  static const Json& dot() {
    for (const Json& one : truth().at("postures").at("reference").at("dots")) {
      if (one.at("segment") == "middle_distal") return one.at("point_mm");
    }
    throw std::runtime_error("no dot on middle_distal");
  }
  static const ProgramRun& made() {
    static const ProgramRun run = [] {
      const Json& line = truth().at("postures").at("reference").at("proximal_creases_mm");
      const Json& crease = line.at("index_distal");
      // Off the skin by a few millimetres: that doesn't matter to a dot that was added.
      Json added = dot();
      added[0] = added[0].get<double>() + 2.0;
      write_text(folder() + "/edited.csv",
                 kHead + mark_row("crease", "none", crease.at(crease.size() / 2)) +
                     mark_row("dot", "none", dot()) +
                     mark_row("added_dot", "middle_distal", added));
      return run_palmar(
          "hand from-scan p/scan/reference.ply --marks edited.csv --truth p/truth/subject.json "
          "--out a.hand.glb",
          folder());
    }();
    return run;
  }
};

TEST_F(RingedHand, ThoroughIsMeasuredWithoutTheRing) {
  ASSERT_EQ(made().exit_code, 0) << made().err;
  EXPECT_THAT(made().err, HasSubstr("A ring on ring_proximal"));
  // 1.2 mm thick: taken for skin it would make the phalanx 2 mm broader.
  double off = -1.0;
  for (const auto& row : rows_of(folder() + "/a.scan/truth_errors.csv")) {
    if (row[0] == "ring_proximal_width") off = std::abs(std::stod(row[3]));
  }
  EXPECT_GE(off, 0.0);
  EXPECT_LT(off, 0.6);
}

TEST_F(RingedHand, ThoroughFollowsEditedMarks) {
  ASSERT_EQ(made().exit_code, 0) << made().err;
  EXPECT_THAT(made().err, HasSubstr("Creases not found, taken from the joints: index_distal."));
  int near_left_out = 0, on_segment = 0;
  for (const auto& row : rows_of(folder() + "/a.scan/marks.csv")) {
    if (row[1] != "dot") continue;
    on_segment += row[2] == "middle_distal" ? 1 : 0;
    double squares = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      squares += std::pow(std::stod(row[3 + k]) - dot().at(k).get<double>(), 2);
    }
    near_left_out += squares < 1.0 ? 1 : 0;
  }
  EXPECT_EQ(near_left_out, 0);
  EXPECT_EQ(on_segment, 3);  // two that were drawn, one that was added

  write_text(folder() + "/wrong.csv", std::string(kHead) + "reference,dot,none,9000,0,0\n");
  expect_refused("hand from-scan p/scan/reference.ply --marks wrong.csv --out c.hand.glb", folder(),
                 3, "wrong.csv:2: no dot within 3 mm of 9000.0, 0.0, 0.0");
}

TEST_F(RingedHand, ThoroughIsReportedWithWhatATapeMeasures) {
  ASSERT_EQ(made().exit_code, 0) << made().err;
  const std::string page = read_text(folder() + "/a.scan/report.html");
  EXPECT_THAT(page, HasSubstr("along the back"));
  std::string girth;
  for (const auto& row : rows_of(folder() + "/a.scan/dimensions.csv")) {
    if (row[0] == "index_middle_girth") girth = row[1];
  }
  ASSERT_GT(girth.size(), 3U);
  // The cell holds the number in full, the table of values to 0.001 mm.
  EXPECT_THAT(page, HasSubstr("data-value=\"" + girth.substr(0, girth.size() - 2)));
}

TEST_F(RingedHand, ThoroughIsRefusedIfAnInkIsLikeItsSkin) {
  expect_refused("hand from-scan p/scan/reference.ply --crease-colour '#b38770' --out d.hand.glb",
                 folder(), 3, "reference.ply: the crease colour is like this skin's");
  EXPECT_EQ(read_text(folder() + "/d.hand.glb"), "");
}

/// Tables [[mark]] of a found.toml, each with its number's line.
std::vector<std::string> marks_of(const std::string& toml) {
  std::vector<std::string> marks;
  for (std::size_t at = toml.find("[[mark]]"); at != std::string::npos;) {
    const std::size_t next = toml.find("[[mark]]", at + 1);
    marks.push_back(toml.substr(at, next - at));
    at = next;
  }
  return marks;
}

// Before anything is computed on it; what somebody corrects there counts in the next run.
TEST_F(RingedHand, WhatWasFoundIsShownByNumberAndCanBeCorrected) {
  const std::string look = "hand from-scan p/scan/reference.ply --look --out l.hand.glb";
  const ProgramRun run = run_palmar(look, folder());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("l.scan/found.png"));
  EXPECT_THAT(run.err, HasSubstr("no hand was made"));
  EXPECT_EQ(read_text(folder() + "/l.hand.glb"), "");
  EXPECT_EQ(read_text(folder() + "/l.scan/found.png").substr(1, 3), "PNG");
  const std::string found = read_text(folder() + "/l.scan/found.toml");
  std::vector<std::string> marks = marks_of(found);
  const auto is_dot = [](const std::string& m) { return m.find("\"dot\"") != m.npos; };
  const auto dots = static_cast<double>(std::count_if(marks.begin(), marks.end(), is_dot));
  const auto& drawn = truth().at("postures").at("reference").at("dots");
  EXPECT_GE(dots, 0.9 * static_cast<double>(drawn.size()));
  EXPECT_LE(dots, static_cast<double>(drawn.size()));

  // The first dot is none.
  const auto first = std::find_if(marks.begin(), marks.end(), is_dot);
  ASSERT_NE(first, marks.end());
  EXPECT_THAT(*first, HasSubstr("# 1\n"));
  first->replace(first->find("name = \"\""), 9, "name = \"none\"");
  write_text(folder() + "/anna.toml", "side = \"right\"\n" + *first);
  const ProgramRun again = run_palmar(look + " --known anna.toml", folder());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const std::vector<std::string> left = marks_of(read_text(folder() + "/l.scan/found.toml"));
  EXPECT_EQ(static_cast<double>(std::count_if(left.begin(), left.end(), is_dot)), dots - 1.0);

  write_text(folder() + "/wrong.toml",
             "[[mark]]\nmark = \"dot\"\nname = \"none\"\nat_mm = [9000, 0, 0]\n");
  expect_refused(look + " --known wrong.toml", folder(), 3, "wrong.toml:1: no dot within 3 mm");
}

TEST(PhantomScan, NamesWrongArguments) {
  const std::string folder = temporary_folder();
  expect_refused("phantom scan --out p --format stl", folder, 2, "neither ply");
  expect_refused("phantom scan --out p --noise-mm 9", folder, 2, "noise is 9");
  expect_refused("phantom scan --out p --unit foot", folder, 2, "foot");
}

}  // namespace
}  // namespace palmar::testing
