// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/person_workflow/steps/posture_files.h"
#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

// Requests that are refused; scans and what is made of them are tested with the whole program.

namespace palmar::person_workflow {
namespace {

using ::testing::HasSubstr;
using Files = std::map<hand::ScanPosture, std::string>;

std::string refusal(const HandFromScanRequest& request) {
  return formats::message_of<UsageError>([&] { request.check(); });
}

TEST(HandFromScanRequest, NamesTheSettingItsValueAndWhatIsAllowed) {
  HandFromScanRequest request;
  request.scans = {"natural.ply"};
  request.hand.out = "anna.hand.glb";
  EXPECT_EQ(refusal(request), "");
  request.hand.inks.dot_diameter = -1.0;
  EXPECT_THAT(refusal(request), HasSubstr("-1"));
  request.hand.inks = {};
  request.hand.out = "anna.ply";
  EXPECT_EQ(refusal(request), "setting \"out\": \"anna.ply\" must end in .hand.glb");
}

TEST(HandFromScanRequest, TheScanItselfIsNoOutput) {
  HandFromScanRequest request;
  request.scans = {"anna.hand.glb"};
  request.hand.out = "anna.hand.glb";
  EXPECT_EQ(refusal(request),
            "setting \"out\" anna.hand.glb: is the scan itself; the original stays as it is, name "
            "another file");
}

TEST(FilesByPosture, NamesReportPosturesAlsoInShort) {
  const Files files = files_by_posture({"a/natural.ply", "a/fist.ply", "a/spread.ply"}, {}, "scan");
  EXPECT_EQ(files, (Files{{hand::ScanPosture::kReference, "a/natural.ply"},
                          {hand::ScanPosture::kFingerFlexion, "a/fist.ply"},
                          {hand::ScanPosture::kFingerAbduction, "a/spread.ply"}}));
}

TEST(FilesByPosture, ASingleFileIsTheReference) {
  EXPECT_EQ(files_by_posture({"anna.ply"}, {}, "scan"),
            (Files{{hand::ScanPosture::kReference, "anna.ply"}}));
}

TEST(FilesByPosture, WhatIsStatedCountsMoreThanNames) {
  EXPECT_EQ(files_by_posture({"natural.ply", "flexed.ply"},
                             {{"flexed.ply", hand::ScanPosture::kThumbFlexion}}, "scan")
                .at(hand::ScanPosture::kThumbFlexion),
            "flexed.ply");
}

TEST(FilesByPosture, RefusalsNameTheSettingThatHelps) {
  const auto message = [](const std::vector<std::string>& paths,
                          const std::map<std::string, hand::ScanPosture>& stated) {
    return formats::message_of<UsageError>([&] { files_by_posture(paths, stated, "folder"); });
  };
  EXPECT_THAT(message({"a", "b"}, {}), HasSubstr("setting \"posture\" FILE=POSTURE does"));
  EXPECT_THAT(message({"open", "natural"}, {}), HasSubstr("both show the posture reference"));
  EXPECT_THAT(message({"open"}, {{"c", hand::ScanPosture::kGrasp}}),
              HasSubstr("setting \"posture\": \"c\" isn't among the folders"));
  EXPECT_THAT(message({"flexed", "spread"}, {}), HasSubstr("no folder shows the reference"));
}

}  // namespace
}  // namespace palmar::person_workflow
