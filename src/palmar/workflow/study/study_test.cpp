// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/workflow/hand/workflow_test_hand.h"
#include "palmar/workflow/study/study_report.h"
#include "palmar/workflow/study/study_shards.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using workflow_test::TemporaryFolder;

/// A handle in three hands, two of them in the second shard's way, run once for all tests.
class StudyWorkflow : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    hand_ = (*folder_ / "coarse.hand.glb").string();
    records::write_hand(hand_, *workflow_test::coarse_hand());
    whole_ = new StudyRunOutcome(run_study(run_into("whole.palmar")));
  }
  static void TearDownTestSuite() {
    delete whole_;
    delete folder_;
  }

  static StudyRunRequest run_into(const std::string& file, study::StudyShard shard = {}) {
    QuickStudy quick;
    quick.products = {"made: cylinder diameter_mm=42"};
    quick.hands = 3;
    quick.hand = hand_;
    StudyRunRequest request;
    request.study = study_of(quick);
    request.study.settings.emplace_back();
    request.study.settings.back().indices = false;
    request.out = *folder_ / file;
    request.shard = shard;
    return request;
  }

  static TemporaryFolder* folder_;
  static std::string hand_;
  static StudyRunOutcome* whole_;
};
TemporaryFolder* StudyWorkflow::folder_ = nullptr;
std::string StudyWorkflow::hand_;
StudyRunOutcome* StudyWorkflow::whole_ = nullptr;

TEST_F(StudyWorkflow, EveryGraspIsRunAndCounted) {
  EXPECT_EQ(whole_->grasps, 3);
  EXPECT_EQ(whole_->run_now, 3);
  std::int64_t counted = 0;
  for (const auto& [outcome, count] : whole_->outcomes) counted += count;
  EXPECT_EQ(counted, 3);
  EXPECT_EQ(whole_->digest.size(), 64U);  // SHA-256
}

TEST_F(StudyWorkflow, HandsOfAllSizesGripWithOneForce) {
  const study::StudySetting& setting = whole_->plan.settings.front();
  EXPECT_EQ(setting.strength_share, 0.25);
  // 53.0 and 34.1 kg (Steiber 2016, men and women of 45 to 49 years).
  const double strength = 0.5 * (53.0 + 34.1) * 9.80665;
  EXPECT_NEAR(setting.strength.value_or(0.0), strength, 1e-9);
  EXPECT_LT(setting.least_grip_force, 5.0);  // a handle of 42 mm is light enough
  const StudyCompareOutcome outcome = compare_study(
      {.store = *folder_ / "whole.palmar", .quantities = {"grip_force_n"}, .comparison = {}});
  int at_rest = 0;
  for (const study::StudyRecord& record : outcome.results.records) {
    if (!record.is_balanced) continue;
    ++at_rest;
    EXPECT_NEAR(record.grip_force, 0.25 * strength, 0.01 * 0.25 * strength);
  }
  EXPECT_GE(at_rest, 2);  // of 3
}

TEST_F(StudyWorkflow, GripForceIsRaisedForAllByTheHeaviestProduct) {
  QuickStudy quick;
  quick.products = {"made: cylinder diameter_mm=42", "made: cylinder diameter_mm=30"};
  quick.hands = 2;
  quick.hand = hand_;
  records::StudyRequest study = study_of(quick);
  study.products.front().held.mass = 9.0;  // kg
  const records::LoadedStudy loaded = load_study(study, NoteSink());
  ASSERT_EQ(loaded.plan.settings.size(), 1U);
  const study::StudySetting& setting = loaded.plan.settings.front();
  // 1.4 times what two sides with mu 0.5 hold.
  EXPECT_NEAR(setting.least_grip_force, 1.4 * 9.0 * 9.80665, 1e-9);
  EXPECT_NEAR(study::share_of_strength(setting, 0.0).force(grasp::Grip::kMediumWrap),
              1.4 * 9.0 * 9.80665, 1e-9);
  EXPECT_THAT(loaded.notes,
              testing::Contains(HasSubstr("raised from 107 N to hold the 88.3 N of")));
  study.settings.emplace_back();
  study.settings.back().limit_depths = true;
  EXPECT_FALSE(load_study(study, NoteSink()).plan.settings.front().strength_share);
}

TEST_F(StudyWorkflow, WhatIsCarriedAsksForTheForceOfItsWeight) {
  QuickStudy quick;
  quick.products = {"made: cylinder diameter_mm=42"};
  quick.hands = 2;
  quick.hand = hand_;
  quick.mass = 1.5;
  quick.task = grasp::HandTask::kCarry;
  StudyRunRequest request;
  request.study = study_of(quick);
  request.out = *folder_ / "carried.palmar";
  run_study(request);
  const StudyCompareOutcome outcome =
      compare_study({.store = request.out, .quantities = {"grip_force_n"}, .comparison = {}});
  EXPECT_EQ(outcome.results.plan.settings.front().task, grasp::HandTask::kCarry);
  ASSERT_EQ(outcome.results.records.size(), 2U);
  // 1.4 times what two sides with mu 0.5 hold of a load that is a fifth heavier in walking.
  const double asked = 1.4 * 1.2 * 1.5 * 9.80665;
  for (const study::StudyRecord& record : outcome.results.records) {
    ASSERT_TRUE(record.is_balanced) << record.reason;
    EXPECT_NEAR(record.grip_force, asked, 0.02 * asked);
  }
}

TEST_F(StudyWorkflow, ATaskThatSaysHowFirmlyExcludesAForce) {
  QuickStudy quick;
  quick.products = {"made: cylinder diameter_mm=42"};
  quick.hand = hand_;
  quick.task = grasp::HandTask::kHold;
  quick.grip_force = 60.0;
  EXPECT_THAT([&] { load_study(study_of(quick), NoteSink()); },
              testing::ThrowsMessage<UsageError>(HasSubstr(
                  "its task, hold, says how firmly to grip; grip force isn't allowed with it")));
  quick.grip_force = std::nullopt;
  quick.task = grasp::HandTask::kTurn;
  EXPECT_THAT([&] { load_study(study_of(quick), NoteSink()); },
              testing::ThrowsMessage<UsageError>(HasSubstr("its task is turn; a torque is")));
}

TEST_F(StudyWorkflow, RunAgainNothingIsLeftToDo) {
  const StudyRunOutcome again = run_study(run_into("whole.palmar"));
  EXPECT_EQ(again.run_now, 0);
  EXPECT_EQ(again.digest, whole_->digest);
}

TEST_F(StudyWorkflow, ShardsJoinToWhatOneRunWrote) {
  run_study(run_into("shard-1.palmar", {1, 2}));
  const StudyStatus half = study_status({*folder_ / "shard-1.palmar"});
  EXPECT_THAT(half.absent_shards, ElementsAre("2/2"));
  EXPECT_EQ(half.done, 2);
  run_study(run_into("shard-2.palmar", {2, 2}));
  const StudyMergeOutcome merged = merge_shards(
      {*folder_ / "shard-1.palmar", *folder_ / "shard-2.palmar"}, *folder_ / "merged.palmar");
  EXPECT_EQ(merged.digest, whole_->digest);
}

TEST_F(StudyWorkflow, CancelledRunKeepsWhatIsDoneAndGoesOnToTheSameResults) {
  std::atomic<bool> cancel = false;
  const Progress progress{.report =
                              [&](double share, const std::string&) {
                                if (share > 0.4 && share < 1.0) cancel = true;
                              },
                          .cancel = &cancel};
  try {
    run_study(run_into("stopped.palmar"), progress);
    FAIL() << "the run wasn't stopped";
  } catch (const Cancelled& error) {
    EXPECT_THAT(error.what(), HasSubstr("of 3 grasps are kept"));
  }
  const fs::path path = *folder_ / "stopped.palmar";
  const StudyStatus status = study_status({path});
  EXPECT_EQ(status.stores.front().state, "stopped");
  EXPECT_LT(status.done, 3);
  const StudyRunOutcome rest = resume_study(path);
  EXPECT_EQ(rest.run_now, 3 - status.done);
  EXPECT_EQ(rest.digest, whole_->digest);
}

TEST_F(StudyWorkflow, StoreOfAnotherStudyIsLeftAlone) {
  StudyRunRequest other = run_into("whole.palmar");
  other.study.products.front().file = "made: cylinder diameter_mm=30";
  EXPECT_THROW(run_study(other), UsageError);
  EXPECT_EQ(study_status({*folder_ / "whole.palmar"}).done, 3);
}

TEST_F(StudyWorkflow, PageNamesTheResultsThatItIsMadeOf) {
  StudyReportRequest request;
  request.store = *folder_ / "whole.palmar";
  request.folder = (*folder_ / "report").string();
  request.report.most_grasps = 0;
  request.report.pictures = request.report.figure_files = false;
  const fs::path page = report_study(request);
  EXPECT_EQ(page, *folder_ / "report" / "report.html");
  EXPECT_THAT(formats::read_file(page), HasSubstr(whole_->digest));
  request.report.threshold = -0.001;
  try {
    report_study(request);
    FAIL() << "a pressure below nothing was taken";
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "setting \"threshold\" is -1 kPa; 0 to 100000 kPa are allowed");
  }
}

TEST_F(StudyWorkflow, ComparisonCountsTheHandsThatHold) {
  const StudyCompareOutcome outcome = compare_study(
      {.store = *folder_ / "whole.palmar", .quantities = {"force_n"}, .comparison = {}});
  ASSERT_FALSE(outcome.conditions.empty());
  const ComparedQuantity& force = outcome.conditions.front().quantities.front();
  EXPECT_EQ(force.quantity.unit, "N");
  EXPECT_TRUE(force.pairs.empty());  // of one product
  ASSERT_EQ(force.products.size(), 1U);
  const study::QuantitySummary* summary = study::summary_of(force.products.front(), "force_n");
  ASSERT_NE(summary, nullptr);
  double sum = 0.0;
  int held = 0;
  for (const study::StudyRecord& record : outcome.results.records) {
    if (!study::is_in_hand(record)) continue;
    sum += record.force;
    ++held;
  }
  EXPECT_EQ(summary->summary.n, held);
  EXPECT_NEAR(summary->summary.mean, sum / held, 1e-9 * sum);  // N; rounding
}

TEST(StudyOf, UnknownNamesAndWhatDoesNotGoTogetherAreRefused) {
  QuickStudy quick;
  EXPECT_THROW(study_of(quick), UsageError);
  quick.products = {"mug.stl"};
  quick.populations = {"hands.csv"};
  quick.hands = 5;
  try {
    study_of(quick);
    FAIL() << "given hands were drawn";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("setting \"hands\" has no meaning with the given hands of hands.csv"));
  }
  quick.hands = 0;
  quick.grips = {"tripot"};
  try {
    study_of(quick);
    FAIL() << "tripot was taken for a grip";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("tripod"));
  }
}

TEST(StudyOf, HowFirmlyIsSaidOnce) {
  QuickStudy quick;
  quick.products = {"mug.stl"};
  EXPECT_TRUE(study_of(quick).settings.empty());
  quick.limit_depths = true;
  ASSERT_EQ(study_of(quick).settings.size(), 1U);
  EXPECT_TRUE(study_of(quick).settings.front().limit_depths);
  quick.grip_force = 40.0;
  try {
    study_of(quick);
    FAIL() << "two grip forces were taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("setting \"grip force\", setting \"strength share\" and setting \"limit "
                          "depths\" is given; one is allowed"));
  }
  quick.limit_depths = false;
  quick.grip_force = 1e6;
  EXPECT_THROW(study_of(quick), UsageError);
}

TEST(StudyOf, FirstProductNamesTheStudyAndTheUsualPopulationHoldsIt) {
  QuickStudy quick;
  quick.products = {"parts/mug.stl", "jug.stl"};
  const records::StudyRequest study = study_of(quick);
  EXPECT_EQ(study.name, "mug");
  ASSERT_EQ(study.populations.size(), 1U);
  EXPECT_EQ(study.populations.front().preset, "xie2014");
}

TEST(StudyStatus, FolderWithoutStoresIsNamed) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "empty");
  try {
    study_status({folder / "empty"});
    FAIL() << "a study was found in an empty folder";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("empty: holds no study"));
  }
}

}  // namespace
}  // namespace palmar::workflow
