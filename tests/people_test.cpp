// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// People's hands on the template: populations against its own dimensions, and what grasps of it ask
// of their owner.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <map>

#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/population/hand_profile.h"
#include "palmar/population/segment_regressions.h"
#include "palmar/product/primitives.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/grasp_demand.h"
#include "palmar/study/statistics/exclusion.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using People = TemplateTest;

TEST_F(People, RegressionsStandInTheTemplatesProportions) {
  const hand::HandDimensions measured = hand::measure_hand(hand());
  for (const hand::HandDimension one : hand::all_hand_dimensions()) {
    EXPECT_NEAR(hand::value_of(population::template_proportions(), one),
                hand::value_of(measured, one), 0.15)
        << name_of(one);  // mm; rounding, and a template built again
  }
}

// Hands as drawn can be made: their dimensions don't contradict each other.
TEST_F(People, HandsAsDrawnCanBeMade) {
  const hand::HandInstanceMaker maker(hand());
  for (const char* name : {"xie2014", "ansur2", "japanese", "delhi_men", "nigerian", "indian_women",
                           "dutch_over_80", "dutch_children_4"}) {
    population::SamplingOptions options;
    options.hands = 6;
    for (const population::HandSample& person :
         population::sample_hands(population::population_named(name), options)) {
      EXPECT_LT(maker.make(person.dimensions).largest_miss, 0.1) << name << " " << person.label;
    }
    options.design = population::SamplingDesign::kBoundary;
    options.boundary_points = 4;
    for (const population::HandSample& person :
         population::sample_hands(population::population_named(name), options)) {
      EXPECT_LT(maker.make(person.dimensions).largest_miss, 0.1) << name << " " << person.label;
    }
  }
}

struct Held {
  product::Product product;
  study::Assessment assessment;
  study::GraspDemand demand;
  study::StudyRecord record;
};

// A cylinder in the hand's power grasp, with its demand judged on the whole range.
Held make_held(const hand::Hand& whole, double range_share, double diameter, double weight) {
  Held held;
  product::CylinderProductOptions shape;
  shape.diameter = diameter;
  shape.fineness.chordal_error = 0.05;
  held.product = product::make_cylinder_product(shape);
  const contact::PreparedHand prepared(
      std::make_shared<const hand::Hand>(population::with_range_share(whole, range_share)));
  study::AssessOptions options;
  options.balance.is_on = false;
  options.indices.is_on = false;
  options.footprint = false;
  held.assessment = study::assess(prepared, held.product, options);
  const study::Assessment& a = held.assessment;
  study::StrengthQuestion question;
  question.load.weight = weight;
  question.grip = a.grasp.grip;
  held.demand = study::demand_of(whole, held.product, {a.grasp, a.balance, a.contact, a.posed_skin},
                                 question);
  held.record.outcome = a.grasp.status == grasp::GraspStatus::kHeld
                            ? study::StudyOutcome::kHeld
                            : study::StudyOutcome::kNotGraspable;
  held.record.force = a.contact.total.force;
  held.record.demand = held.demand;
  return held;
}

// The same, held once for all tests.
const Held& hold(const hand::Hand& whole, double range_share, double diameter) {
  constexpr double kWeight = 20.0;  // N
  static std::map<std::pair<double, double>, Held> known;
  const auto [found, is_new] = known.try_emplace({range_share, diameter});
  if (is_new) found->second = make_held(whole, range_share, diameter, kWeight);
  return found->second;
}

constexpr std::array<double, 3> kShares = {1.0, 0.7, 0.45};
constexpr std::array<double, 2> kDiameters = {24.0, 56.0};  // mm

TEST_F(People, GraspsOfAReducedRangeAskForNoMoreThanIt) {
  for (const double diameter : kDiameters) {
    for (const double share : kShares) {
      const Held& held = hold(hand(), share, diameter);
      EXPECT_LE(held.demand.range_share, share + 1e-9) << diameter << " mm, share " << share;
      // And the reduced hand of exactly that share can take the posture.
      const hand::Hand just =
          population::with_range_share(hand(), std::min(1.0, held.demand.range_share + 1e-9));
      EXPECT_TRUE(
          hand::clamp_to_range(just.skeleton, held.assessment.grasp.posture).clamped.empty());
    }
  }
}

TEST_F(People, LessRangeOrStrengthNeverIncludesMoreOnRealGrasps) {
  for (const double diameter : kDiameters) {
    std::vector<study::StudyRecord> records;
    for (const double share : kShares) {
      records.push_back(hold(hand(), share, diameter).record);
    }
    std::vector<const study::StudyRecord*> ways;
    for (const study::StudyRecord& record : records) ways.push_back(&record);
    int before = 0;
    for (const double strength : {20.0, 40.0, 80.0, 160.0, 320.0, 640.0}) {
      int included = 0;
      bool is_out = false;  // once excluded, with still less range too
      for (std::size_t k = 0; k < kShares.size(); ++k) {
        const study::ExclusionCause cause =
            study::exclusion_of(ways, ways[k], {kShares[k], strength, 0.0});
        EXPECT_FALSE(is_out && cause == study::ExclusionCause::kNone);
        is_out = is_out || cause != study::ExclusionCause::kNone;
        included += cause == study::ExclusionCause::kNone ? 1 : 0;
      }
      EXPECT_GE(included, before) << diameter << " mm, " << strength << " N";
      before = included;
    }
    EXPECT_GE(before, 1) << "640 N hold 20 N";
  }
}

// Friction is linear: twice the load needs twice the strength; without load none is needed.
TEST_F(People, StrengthNeededGrowsWithTheLoad) {
  const Held& one = hold(hand(), 1.0, 24.0);
  ASSERT_TRUE(std::isfinite(one.demand.grip_strength));
  EXPECT_GT(one.demand.grip_strength, 0.0);
  const study::Assessment& a = one.assessment;
  const auto needed = [&](double weight, double friction) {
    study::StrengthQuestion question;
    question.load.weight = weight;
    question.friction = friction;
    return study::strength_needed(hand(), a.contact, question);
  };
  EXPECT_EQ(needed(0.0, 0.5), 0.0);
  EXPECT_NEAR(needed(10.0, 0.5), 2.0 * needed(5.0, 0.5), 1e-6 * needed(10.0, 0.5));
  EXPECT_GT(needed(5.0, 0.3), needed(5.0, 0.5));
  // The forces that hold it along the cylinder must at least carry mu times their sum, and the sum
  // is at most pi times the grip force: strength >= weight / (pi mu).
  EXPECT_GT(needed(5.0, 0.5), 5.0 / (M_PI * 0.5) - 1e-9);
}

// The muscles' own share decides: a hand that holds 80 N with 40 % of 1.2 times the mean strength
// needs 96 N of grip strength for 40 N, and a stated grip force counts like one that a load needs.
TEST_F(People, StrengthNeededIsWhatTheMusclesTakeForTheTasksForce) {
  const study::Assessment& a = hold(hand(), 1.0, 24.0).assessment;
  grasp::Balance rest;
  rest.status = grasp::BalanceStatus::kBalanced;
  rest.strength_use = 0.4;
  rest.grip_force = 80.0;
  study::StrengthQuestion question;
  question.muscle_strength = 1.2;
  question.stated_force = 40.0;
  EXPECT_NEAR(study::strength_needed(hand(), a.contact, question, &rest),
              0.4 * 40.0 / 80.0 * 1.2 * grasp::usual_grip_strength(), 1e-9);
  // By a dynamometer where muscles give no answer: 40 N of a power grip.
  EXPECT_NEAR(study::strength_needed(hand(), a.contact, question), 40.0, 1e-9);
  rest.strength_use.reset();
  EXPECT_NEAR(study::strength_needed(hand(), a.contact, question, &rest), 40.0, 1e-9);
  question.load.weight = 200.0;
  EXPECT_GT(study::strength_needed(hand(), a.contact, question), 40.0);
}

// A wall perpendicular to the middle finger of the flat hand, 10 mm beyond the farthest nail's
// root: there is room for 10 mm.
TEST_F(People, NailsEndAtTheProduct) {
  const hand::Posture flat = hand::named_posture(hand().skeleton, "flat").value();
  const std::vector<Vec3> skin = hand::pose_skin(hand(), flat);
  double farthest = -1e9;
  for (const Vec3& p : skin) farthest = std::max(farthest, p.y());
  product::Product wall;
  wall.distance = geometry::make_half_space_distance();  // solid below z = 0
  // The hand's y axis runs into the wall: product z = offset - y.
  const auto facing = [](double y) {
    geometry::Rigid3 motion;
    motion.rotation = Quat(Eigen::AngleAxisd(-0.5 * M_PI, Vec3::UnitX()));
    // Rotation takes y to -z and z to y.
    motion.translation = Vec3(0.0, 0.0, y);
    return motion;
  };
  const double near = study::nail_room_of(hand(), flat, skin, facing(farthest + 10.0), wall);
  // A nail perpendicular to a phalanx that isn't quite perpendicular to the wall begins a little
  // before or behind the fingertip's front.
  EXPECT_NEAR(near, 10.0, 1.5);
  EXPECT_NEAR(study::nail_room_of(hand(), flat, skin, facing(farthest + 15.0), wall) - near, 5.0,
              0.2);
  EXPECT_EQ(study::nail_room_of(hand(), flat, skin, facing(farthest - 20.0), wall), 0.0);
  // Nothing near: as long as anybody asks.
  EXPECT_EQ(study::nail_room_of(hand(), flat, skin, facing(farthest + 500.0), wall),
            study::kLongestNail);
}

// Fingers bent into the palm have no room for nails; the same without any product.
TEST_F(People, NailsOfAFistMeetThePalm) {
  const hand::Posture fist = hand::named_posture(hand().skeleton, "fist").value();
  const std::vector<Vec3> skin = hand::pose_skin(hand(), fist);
  product::Product far;
  far.distance = geometry::make_sphere_distance(1.0);
  geometry::Rigid3 away;
  away.translation = Vec3(0.0, 0.0, 1000.0);
  EXPECT_LT(study::nail_room_of(hand(), fist, skin, away, far), 15.0);
}

}  // namespace
}  // namespace palmar::tests
