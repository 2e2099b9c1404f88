// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/press_deck.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "palmar/formats/file.h"
#include "palmar/formats/process/program_missing.h"
#include "palmar/workflow/hand/workflow_test_hand.h"

namespace palmar::workflow {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using workflow_test::coarse_hand;
using workflow_test::TemporaryFolder;

class WrittenPressDeck : public testing::Test {
 protected:
  WrittenPressDeck() {
    request.hand.value = coarse_hand();
    request.out = (folder / "tip").string();
  }
  std::string refused() const {
    try {
      request.check();
    } catch (const UsageError& error) {
      return error.what();
    }
    return "accepted";
  }

  TemporaryFolder folder;
  PressDeckRequest request;
};

TEST_F(WrittenPressDeck, PlateTouchesTheSkinWithoutEnteringIt) {
  request.tilt = 20.0 * std::numbers::pi / 180.0;
  try {
    const records::PressDeck deck = write_press_deck(request).deck;
    const Vec3 out_of_skin = -deck.direction, on_plate = deck.indenter.vertices.at(0);
    double highest = -std::numeric_limits<double>::infinity();
    const hand::Hand& hand = *coarse_hand();
    for (int v = 0; v < hand.skin.vertex_count(); ++v) {
      if (hand.region[v] != request.region) continue;
      highest = std::max(highest, (hand.skin.vertices[v] - on_plate).dot(out_of_skin));
    }
    EXPECT_NEAR(highest, 0.0, 1e-6);  // mm; rounding
  } catch (const formats::ProgramMissing& error) {
    GTEST_SKIP() << error.what();
  }
}

TEST_F(WrittenPressDeck, FinerTetrahedraFillTheSameTissue) {
  try {
    const records::TetMesh coarse = write_press_deck(request).deck.block.mesh;
    request.largest_tet = 0.5;
    const records::TetMesh fine = write_press_deck(request).deck.block.mesh;
    EXPECT_GT(fine.tets.size(), coarse.tets.size());
    EXPECT_NEAR(records::volume(fine), records::volume(coarse),
                1e-6 * records::volume(coarse));  // mm^3; digits of the files
  } catch (const formats::ProgramMissing& error) {
    GTEST_SKIP() << error.what();
  }
}

TEST_F(WrittenPressDeck, EveryDepthIsAStep) {
  request.indenter = {.kind = contact::PressIndenter::Kind::kSphere, .radius = 8.0};
  request.depths = {0.5, 1.0, 2.0};
  try {
    const std::string text = formats::read_file(write_press_deck(request).file);
    EXPECT_THAT(text, StartsWith("** middle_distal of hand template, sphere:8 at 0 deg\n"));
    int steps = 0;
    for (std::size_t at = text.find("\n*STEP"); at != text.npos;
         at = text.find("\n*STEP", at + 1)) {
      ++steps;
    }
    EXPECT_EQ(steps, 3);
  } catch (const formats::ProgramMissing& error) {
    GTEST_SKIP() << error.what();
  }
}

TEST_F(WrittenPressDeck, SettingsAreRefusedBeforeAnythingIsMade) {
  EXPECT_EQ(refused(), "accepted");
  request.depths = {2.0, 1.0};
  EXPECT_THAT(refused(), HasSubstr("depth 1 mm after 2 mm; they must ascend"));
  request.depths = {1.0};
  request.poisson = 0.5;
  EXPECT_THAT(refused(), HasSubstr("Poisson's ratio 0.5; above -1 and below 0.5 is allowed"));
  request.poisson = 0.45;
  request.largest_tet = 0.0;
  EXPECT_THAT(refused(), HasSubstr("largest tetrahedron 0 mm3; more than 0 is required"));
  request.largest_tet = 2.0;
  request.region = hand::Region::kDorsum;
  EXPECT_THAT(refused(), HasSubstr("the dorsum is no region to press"));
  EXPECT_FALSE(std::filesystem::exists(request.out));
}

}  // namespace
}  // namespace palmar::workflow
