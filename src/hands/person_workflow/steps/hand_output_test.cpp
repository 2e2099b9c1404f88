// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/hand_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

namespace palmar::person_workflow {
namespace {

using ::testing::HasSubstr;

TEST(HandOutput, FilesBesideAHandBearItsName) {
  EXPECT_EQ(hand_name_of("folder/anna.hand.glb"), "anna");
  EXPECT_EQ(beside_hand("folder/anna.hand.glb", ".mri"), "folder/anna.mri");
  EXPECT_EQ(folder_of("anna.hand.glb"), ".");
}

TEST(HandOutput, AHandFileHasItsEnding) {
  for (const char* const name : {"anna.glb", ".hand.glb", ""}) {
    EXPECT_THAT(formats::message_of<UsageError>([&] { check_hand_output(name); }),
                HasSubstr("must end in .hand.glb"));
  }
  EXPECT_NO_THROW(check_hand_output("a.hand.glb"));
}

TEST(HandOutput, AFolderThatIsNotThereIsRefusedBeforeTheWork) {
  EXPECT_EQ(formats::message_of<OutputError>([] { require_writable("nowhere"); }),
            "nowhere: there is no such folder to write to");
}

TEST(HandOutput, AnInputReachedByAnotherNameIsNoOutput) {
  const formats::TestFolder folder;
  std::ofstream(folder / "scan.ply");
  std::filesystem::create_symlink(folder / "scan.ply", folder / "link.ply");
  EXPECT_THAT(formats::message_of<UsageError>([&] {
                refuse_overwriting((folder / "scan.ply").string(), (folder / "link.ply").string(),
                                   "scan");
              }),
              HasSubstr("is the scan itself"));
  EXPECT_NO_THROW(
      refuse_overwriting((folder / "scan.ply").string(), (folder / "other.ply").string(), "scan"));
}

TEST(WorkFolder, GoesIfNothingWasLeftInIt) {
  const formats::TestFolder folder;
  { const WorkFolder work(folder / "empty"); }
  EXPECT_FALSE(std::filesystem::exists(folder / "empty"));
  {
    const WorkFolder work(folder / "used");
    std::ofstream(folder / "used/result.json");
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "used/result.json"));
}

}  // namespace
}  // namespace palmar::person_workflow
