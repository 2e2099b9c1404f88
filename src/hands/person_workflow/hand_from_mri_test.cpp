// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_mri.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

// Requests that are refused; what becomes of images is tested with the whole program.

namespace palmar::person_workflow {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

HandFromMriRequest request_for(const formats::TestFolder& folder) {
  HandFromMriRequest request;
  request.images = {(folder / "scans").string()};
  request.out = (folder / "anna.hand.glb").string();
  return request;
}

std::string refusal(const HandFromMriRequest& request) {
  return formats::message_of<UsageError>([&] { request.check(); });
}

TEST(HandFromMriRequest, NamesTheSettingItsValueAndWhatIsAllowed) {
  const formats::TestFolder folder;
  HandFromMriRequest request = request_for(folder);
  EXPECT_EQ(refusal(request), "");
  request.out = "anna.glb";
  EXPECT_EQ(refusal(request), "setting \"out\": \"anna.glb\" must end in .hand.glb");
  request = request_for(folder);
  request.images.clear();
  EXPECT_THAT(refusal(request), HasSubstr("setting \"images\""));
  request = request_for(folder);
  request.surfaces.edge_length = 90.0;
  EXPECT_THAT(refusal(request), AllOf(HasSubstr("90"), Not(HasSubstr("--"))));
}

TEST(SelectScans, ImagesThatAreNotThereAreNamed) {
  const std::string message =
      formats::message_of<InputError>([] { select_scans({"nowhere/scans"}, {}, {}); });
  EXPECT_EQ(message, "nowhere/scans: there is no such file or folder");
}

/// A folder as find_mri_surfaces() leaves it, for telling postures apart; its meshes are empty.
void touch_surfaces(const formats::TestFolder& folder, const std::string& name) {
  std::filesystem::create_directories(folder / name);
  std::ofstream(folder / (name + "/scan.json"));
  std::ofstream(folder / (name + "/skin.ply"));
}

TEST(SelectScans, WhatTheUserSaysCountsMoreThanNames) {
  const formats::TestFolder folder;
  touch_surfaces(folder, "reference");
  touch_surfaces(folder, "third");
  const ScanSelection selection =
      select_scans({folder.path().string()}, {{"third", hand::ScanPosture::kGrasp}}, {});
  ASSERT_EQ(selection.scans.size(), 2U);
  EXPECT_EQ(selection.scans[1].posture, hand::ScanPosture::kGrasp);
  EXPECT_TRUE(selection.scans[1].has_surfaces);
}

TEST(SelectScans, ASeriesOfNoPostureIsPassedOverWithAWord) {
  const formats::TestFolder folder;
  touch_surfaces(folder, "reference");
  touch_surfaces(folder, "third");
  const ScanSelection selection = select_scans({folder.path().string()}, {}, {});
  EXPECT_EQ(selection.scans.size(), 1U);
  ASSERT_EQ(selection.notes.size(), 1U);
  EXPECT_THAT(selection.notes[0],
              AllOf(HasSubstr("third"), HasSubstr("setting \"series\" NUMBER=POSTURE")));
}

TEST(SelectScans, AnAssignmentThatFitsNothingIsNamed) {
  const formats::TestFolder folder;
  touch_surfaces(folder, "reference");
  const std::string message = formats::message_of<UsageError>([&] {
    select_scans({folder.path().string()}, {{"9", hand::ScanPosture::kGrasp}}, {});
  });
  EXPECT_THAT(message, HasSubstr("setting \"series\" 9=grasp fits no series; there are"));
}

TEST(SelectScans, WithoutTheReferenceThereIsNoHand) {
  const formats::TestFolder folder;
  touch_surfaces(folder, "reference");
  touch_surfaces(folder, "grasp");
  EXPECT_THAT(formats::message_of<UsageError>([&] {
                select_scans({folder.path().string()}, {}, {hand::ScanPosture::kReference});
              }),
              HasSubstr("none of the series is the reference posture"));
}

}  // namespace
}  // namespace palmar::person_workflow
