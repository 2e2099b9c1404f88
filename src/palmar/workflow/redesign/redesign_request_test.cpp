// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What requests of redesigns refuse, and that they stop when asked to.
#include "palmar/workflow/redesign/redesign_request.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/workflow/redesign/redesign_feature.h"
#include "palmar/workflow/redesign/redesign_press.h"
#include "palmar/workflow/redesign/redesign_region.h"

namespace palmar::workflow {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

RedesignRequest of_a_prism() {
  RedesignRequest request;
  request.product = "made: prism width_mm=35 depth_mm=35 length_mm=100 fillet_mm=3";
  request.out = std::filesystem::path(::testing::TempDir()) / "redesign_that_is_never_made";
  return request;
}

template <typename Request, typename Change>
void expect_refused(const Change& change, const std::string& message) {
  Request request;
  request.redesign = of_a_prism();
  change(request);
  EXPECT_THAT([&] { request.check(); }, ThrowsMessage<UsageError>(HasSubstr(message)));
}

TEST(RedesignRequest, IsFineAsItIsWithAProductAndAFolder) { of_a_prism().check(); }

TEST(RedesignRequest, NamesTheFieldItsValueAndWhatIsAllowed) {
  const auto refuses = [](const auto& change, const std::string& message) {
    RedesignRequest request = of_a_prism();
    change(request);
    EXPECT_THAT([&] { request.check(); }, ThrowsMessage<UsageError>(HasSubstr(message)));
  };
  refuses([](RedesignRequest& r) { r.product.clear(); }, "setting \"product\" is empty");
  refuses([](RedesignRequest& r) { r.out.clear(); },
          "setting \"out\" is empty; a folder is required");
  refuses([](RedesignRequest& r) { r.populations.clear(); }, "setting \"populations\" is empty");
  refuses([](RedesignRequest& r) { r.hands = 0; },
          "setting \"hands\" is 0; 1 to 100000 are allowed");
  refuses(
      [](RedesignRequest& r) {
        r.posture = RedesignPosture::kNew;
        r.grip_force = 501.0;
      },
      "setting \"grip force\" is 501 N; 0 (the usual one) to 500 N are allowed");
  refuses(
      [](RedesignRequest& r) {
        r.posture = RedesignPosture::kKept;
        r.grip_force = 20.0;
      },
      "setting \"posture\" new goes with it");
}

TEST(RedesignRequest, PosturesHaveNames) {
  EXPECT_EQ(redesign_posture("kept"), RedesignPosture::kKept);
  EXPECT_EQ(redesign_posture(name_of(RedesignPosture::kNew)), RedesignPosture::kNew);
  EXPECT_THAT(
      [] { redesign_posture("other"); },
      ThrowsMessage<UsageError>("setting \"posture\" is \"other\"; kept or new is allowed"));
}

TEST(RedesignPressRequest, RefusesWhatNoShapeCanBe) {
  using Request = RedesignPressRequest;
  expect_refused<Request>([](Request& r) { r.shape.share = 1.5; }, "1.5; 0 to 1");
  expect_refused<Request>([](Request& r) { r.formats = {"step"}; },
                          "setting \"formats\" has \"step\"; stl, obj and ply are allowed");
  expect_refused<Request>([](Request& r) { r.formats.clear(); }, "setting \"formats\" is empty");
  expect_refused<Request>([](Request& r) { r.redesign.hands = -1; }, "setting \"hands\" is -1");
}

TEST(RedesignPressRequest, SaysHowHandsAreCombinedInWords) {
  for (const char* words : {"mean", "75", "mean-of-touching", "12.5-of-touching"}) {
    EXPECT_EQ(name_of(combine_options(words)), words);
  }
  EXPECT_EQ(combine_options("90").percentile, 90.0);
  EXPECT_TRUE(combine_options("90-of-touching").is_among_touching);
  EXPECT_THAT([] { combine_options("most"); },
              ThrowsMessage<UsageError>(HasSubstr("setting \"over\" is \"most\"")));
}

TEST(RedesignRegionRequest, RefusesSharesAndLengthsThatCantBe) {
  using Request = RedesignRegionRequest;
  expect_refused<Request>([](Request& r) { r.threshold = -0.1; },
                          "setting \"threshold\" is -0.1; 0 MPa");
  expect_refused<Request>([](Request& r) { r.pressed_share = 2; },
                          "setting \"pressed share\" is 2; 0 to 1");
  expect_refused<Request>([](Request& r) { r.relief_share = -1; },
                          "setting \"relief share\" is -1; 0 to 1");
  expect_refused<Request>([](Request& r) { r.smallest_patch = -5; },
                          "setting \"smallest patch\" is -5");
  expect_refused<Request>([](Request& r) { r.junction_radius = 60; },
                          "setting \"junction radius\" is 60; 0 to 50 mm is allowed");
}

TEST(RedesignFeatureRequest, RefusesLimitsThatCantBe) {
  using Request = RedesignFeatureRequest;
  expect_refused<Request>([](Request&) {}, "setting \"vary\" is needed");
  const auto refuses = [](const auto& change, const std::string& message) {
    expect_refused<Request>(
        [&](Request& r) {
          r.vary = {"fillet:long=1:15"};
          change(r);
        },
        message);
  };
  refuses([](Request& r) { r.limits.largest_offset = 0; },
          "setting \"largest offset\" is 0; above 0");
  refuses([](Request& r) { r.limits.smallest_radius = -1; },
          "setting \"smallest radius\" is -1; 0 or more");
  refuses([](Request& r) { r.limits.smallest_volume = 0; },
          "setting \"smallest volume\" is 0; above 0");
  refuses([](Request& r) { r.limits.largest_volume = -1; },
          "setting \"largest volume\" is -1; above 0");
  refuses([](Request& r) { r.limits.least_grip_force = 2; },
          "setting \"least grip force\" is 2; 0 to 1");
  refuses([](Request& r) { r.limits.lost_hands = 1.1; }, "setting \"lost hands\" is 1.1; 0 to 1");
  refuses([](Request& r) { r.search.evaluations = 1; }, "evaluations is 1");
}

TEST(FeatureSetting, ReadsRangesAndSingleValues) {
  const FeatureSetting fillet = feature_setting("fillet:long=1:15");
  EXPECT_EQ(fillet.name, "fillet:long");
  EXPECT_EQ(fillet.lowest, 1.0);
  EXPECT_EQ(fillet.highest, 15.0);
  EXPECT_TRUE(fillet.varies());
  const FeatureSetting ring = feature_setting("groove:at=40=1.5", {.radius = 8.0});
  EXPECT_EQ(ring.feature.ring_at, 40.0);
  EXPECT_EQ(ring.feature.section_radius, 8.0);
  EXPECT_FALSE(ring.varies());
  EXPECT_THAT(
      [] { feature_setting("groove:at=0=9", {.radius = 8.0}); },
      ThrowsMessage<UsageError>(HasSubstr("setting \"vary\" \"groove:at=0=9\": a depth of 0 to")));
  EXPECT_THAT([] { feature_setting("fillet:long=15:1"); },
              ThrowsMessage<UsageError>(HasSubstr("from the smaller to the larger one")));
}

TEST(Redesign, StopsWhenAskedToBeforeAnythingIsWritten) {
  const std::atomic<bool> stops = true;
  Progress progress;
  progress.cancel = &stops;
  const RedesignRequest prism = of_a_prism();
  RedesignPressRequest press;
  press.redesign = prism;
  EXPECT_THROW(redesign_press(press, progress), Cancelled);
  RedesignRegionRequest region;
  region.redesign = prism;
  EXPECT_THROW(redesign_region(region, progress), Cancelled);
  RedesignFeatureRequest features;
  features.redesign = prism;
  features.vary = {"fillet:long=1:15"};
  EXPECT_THROW(redesign_features(features, progress), Cancelled);
  EXPECT_FALSE(std::filesystem::exists(prism.out));
}

}  // namespace
}  // namespace palmar::workflow
