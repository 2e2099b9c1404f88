// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "hands/person_workflow/phantom/phantom_mri.h"
#include "hands/person_workflow/phantom/phantom_photos.h"
#include "hands/person_workflow/phantom/phantom_scan.h"
#include "hands/person_workflow/phantom/phantom_sheet.h"
#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

// Requests for synthetic persons: refusals and cancelling; the persons themselves are tested where
// they are made, the files with the whole program.

namespace palmar::person_workflow {
namespace {

using ::testing::HasSubstr;

template <typename Request>
std::string refusal(const Request& request) {
  return formats::message_of<UsageError>([&] { request.check(); });
}

/// A request for files in the folder, and what it says without a folder.
template <typename Request>
Request request_in(const formats::TestFolder& folder) {
  Request request;
  EXPECT_THAT(refusal(request), HasSubstr("setting \"out\" is empty"));
  request.out = (folder / "person").string();
  EXPECT_EQ(refusal(request), "");
  return request;
}

TEST(PhantomRequests, NameTheSettingItsValueAndWhatIsAllowed) {
  const formats::TestFolder folder;
  auto mri = request_in<PhantomMriRequest>(folder);
  mri.grid.pixel = 90.0;
  EXPECT_THAT(refusal(mri), HasSubstr("90"));
  auto scan = request_in<PhantomScanRequest>(folder);
  scan.format = "stl";
  EXPECT_THAT(refusal(scan), HasSubstr("setting \"format\": \"stl\" is neither ply"));
  auto photos = request_in<PhantomPhotosRequest>(folder);
  photos.calibration = 300;
  EXPECT_EQ(refusal(photos), "setting \"calibration\" 300; 0 to 200 is allowed");
  photos.calibration = 12;
  photos.jpeg = -1;
  EXPECT_EQ(refusal(photos), "setting \"jpeg\" -1; 0 (PNG) to 100 is allowed");
  auto sheet = request_in<PhantomSheetRequest>(folder);
  sheet.sheet = "a5";
  EXPECT_THAT(refusal(sheet), HasSubstr("a4, letter and card are allowed"));
}

TEST(PhantomRequests, CancelledOnesLeaveNothing) {
  const formats::TestFolder folder;
  const std::atomic<bool> cancel{true};
  const Progress progress{.report = {}, .cancel = &cancel};
  EXPECT_THROW(make_phantom_mri(request_in<PhantomMriRequest>(folder), progress), Cancelled);
  EXPECT_THROW(make_phantom_scan(request_in<PhantomScanRequest>(folder), progress), Cancelled);
  EXPECT_THROW(make_phantom_photos(request_in<PhantomPhotosRequest>(folder), progress), Cancelled);
  EXPECT_THROW(make_phantom_sheet(request_in<PhantomSheetRequest>(folder), progress), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(folder / "person"));
}

TEST(PhantomRequests, AHandToStartFromThatIsNotThereIsNamed) {
  const formats::TestFolder folder;
  auto request = request_in<PhantomSheetRequest>(folder);
  request.base = "nowhere/base.hand.glb";
  EXPECT_THAT(formats::message_of<InputError>([&] { make_phantom_sheet(request); }),
              HasSubstr("nowhere/base.hand.glb"));
}

TEST(SortedPostures, ComeOnceAndInOrder) {
  EXPECT_EQ(sorted_postures({hand::ScanPosture::kGrasp, hand::ScanPosture::kReference,
                             hand::ScanPosture::kGrasp}),
            (std::vector{hand::ScanPosture::kReference, hand::ScanPosture::kGrasp}));
  EXPECT_EQ(sorted_postures({}).size(), static_cast<std::size_t>(hand::kScanPostureCount));
}

}  // namespace
}  // namespace palmar::person_workflow
