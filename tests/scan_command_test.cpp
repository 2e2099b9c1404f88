// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

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
  expect_refused("hand from-scan a.obj b.obj --out a.hand.glb", folder, 2, "tell the posture");
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

TEST(PhantomScan, NamesWrongArguments) {
  const std::string folder = temporary_folder();
  expect_refused("phantom scan --out p --format stl", folder, 2, "neither ply");
  expect_refused("phantom scan --out p --noise-mm 9", folder, 2, "noise is 9");
  expect_refused("phantom scan --out p --unit foot", folder, 2, "foot");
}

}  // namespace
}  // namespace palmar::testing
