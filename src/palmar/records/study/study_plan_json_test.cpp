// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_plan_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"
#include "palmar/records/study/study_store_fixture.h"

namespace palmar::records {
namespace {

using study_fixture::small_study;
using study_fixture::Study;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(StudyPlanJson, KeepsHowAProductIsHeld) {
  Study study = small_study();
  const std::string without = format_plan(study.plan);
  EXPECT_THAT(without, Not(HasSubstr("holding")));  // as before there was anything to say
  grasp::HoldRequest& asked = study.plan.products[1].holding;
  asked.hold = grasp::Hold{};
  asked.hold->grip = grasp::Grip::kTripod;
  asked.hold->turn = 0.1 + 0.2;
  asked.hold->fingertips = {
      {hand::Finger::kIndex, {.along = 0.3, .turn = -1.0 / 3.0, .height = 7.5}}};
  asked.part = 3;
  asked.part_name = "lid";
  asked.along = 0.25;
  asked.toward = Vec3(0.0, 0.6, 0.8);
  asked.purpose = grasp::HoldPurpose::kHandOver;
  const study::StudyPlan back = parse_plan(format_plan(study.plan), "plan");
  EXPECT_EQ(format_plan(back), format_plan(study.plan));
  const grasp::HoldRequest& read = back.products[1].holding;
  ASSERT_TRUE(read.hold.has_value());
  EXPECT_EQ(read.hold->grip, grasp::Grip::kTripod);
  EXPECT_EQ(read.hold->turn, 0.1 + 0.2);
  ASSERT_EQ(read.hold->fingertips.size(), 1U);
  EXPECT_EQ(read.hold->fingertips[0].place.turn, -1.0 / 3.0);
  EXPECT_EQ(read.part, 3);
  EXPECT_EQ(read.part_name, "lid");
  EXPECT_EQ(read.along, 0.25);
  EXPECT_EQ(read.toward, Vec3(0.0, 0.6, 0.8));
  EXPECT_EQ(read.purpose, grasp::HoldPurpose::kHandOver);
  EXPECT_TRUE(back.products[0].holding.is_empty());
  EXPECT_FALSE(plan_differences(study.plan, parse_plan(without, "plan")).empty());
}

TEST(StudyPlanJson, ReadsBackAndReportsWhatDiffers) {
  const Study study = small_study();
  const study::StudyPlan back = parse_plan(format_plan(study.plan), "plan");
  EXPECT_EQ(format_plan(back), format_plan(study.plan));
  EXPECT_TRUE(plan_differences(study.plan, back).empty());
  study::StudyPlan now = study.plan;
  now.settings[0].limit_depths = true;
  EXPECT_THAT(plan_differences(study.plan, now),
              testing::ElementsAre("setting \"default\": limit_depths was false, now true"));
  now.settings[0].limit_depths = false;
  now.settings[0].task = grasp::HandTask::kTurn;
  now.settings[0].turn = -2.5;
  const study::StudySetting turned = parse_plan(format_plan(now), "plan").settings.at(0);
  EXPECT_EQ(turned.task, grasp::HandTask::kTurn);
  EXPECT_EQ(turned.turn, -2.5);
  EXPECT_THAT(plan_differences(study.plan, now),
              testing::ElementsAre("setting \"default\": task was not set, now \"turn\"",
                                   "setting \"default\": turn_n_m was not set, now -2.5"));
  EXPECT_THAT(plan_differences(now, study.plan),
              testing::ElementsAre("setting \"default\": task was \"turn\", now not set",
                                   "setting \"default\": turn_n_m was -2.5, now not set"));
  now = study.plan;
  now.products[1].content_hash = std::string(64, '0');
  now.hands[3].sample.dimensions[0].value += 1e-9;
  now.seed = 8;
  now.grips.pop_back();
  EXPECT_THAT(
      plan_differences(study.plan, now),
      testing::ElementsAre("seed was 7, now 8",
                           "product \"tetrahedron\": its shape has changed "
                           "(tetrahedron.stl)",
                           "had 2 grips, now 1", "hand \"person 3\": its dimensions have changed"));
  EXPECT_THAT(formats::message_of<InputError>([&] { parse_plan("{\"name\": 3}", "x.palmar"); }),
              HasSubstr("x.palmar: its plan can't be read"));
}

TEST(StudyPlanJson, OlderPlanWithoutAForceWasHeldAtLimitDepths) {
  nlohmann::json plan = nlohmann::json::parse(format_plan(small_study().plan));
  nlohmann::json& setting = plan.at("settings").at(0);
  for (const char* key : {"limit_depths", "strength_n", "least_grip_force_n"}) setting.erase(key);
  const study::StudySetting old = parse_plan(plan.dump(), "plan").settings.at(0);
  EXPECT_TRUE(old.limit_depths);
  EXPECT_FALSE(old.grip_force || old.strength_share || old.strength);
  setting["grip_force_n"] = 40.0;
  EXPECT_FALSE(parse_plan(plan.dump(), "plan").settings.at(0).limit_depths);
}

}  // namespace
}  // namespace palmar::records
