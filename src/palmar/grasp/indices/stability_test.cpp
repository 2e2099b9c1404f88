// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/stability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A hand of loose skin vertices, each pressing on the product with a force along -`outward`.
struct Patches {
  hand::Hand hand;
  contact::ContactResult contact;

  void add(hand::Region region, const Vec3& position, const Vec3& outward, double force) {
    hand.region.push_back(region);
    contact.deformed.push_back(position);
    contact.undeformed.push_back(position - outward);  // it was pushed out by 1 mm
    contact.force.push_back(force);
    contact.pressure.push_back(force);
    contact.status = contact::ContactStatus::kSolved;
  }

  /// A disc of skin, `rings` deep, with the same force on every vertex.
  void add_disc(hand::Region region, const Vec3& centre, const Vec3& outward, double radius,
                double force, int cells = 40) {
    const Vec3 a = outward.unitOrthogonal(), b = outward.cross(a);
    int count = 0;
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = -cells; i <= cells; ++i) {
        for (int k = -cells; k <= cells; ++k) {
          if (i * i + k * k > cells * cells) continue;
          if (pass == 0) {
            ++count;
          } else {
            add(region, centre + radius / cells * (i * a + k * b), outward, force / count);
          }
        }
      }
    }
  }
};

GraspContact finger(const Vec3& position, const Vec3& normal, double friction, double force,
                    double torsion = 0.0) {
  GraspContact one;
  one.position = position;
  one.normal = normal;
  one.friction = friction;
  one.torsion = torsion;
  one.normal_force = force;
  return one;
}

std::vector<GraspContact> pinch(double friction, double force_a, double force_b,
                                double torsion = 0.0) {
  return {finger({20, 0, 0}, {-1, 0, 0}, friction, force_a, torsion),
          finger({-20, 0, 0}, {1, 0, 0}, friction, force_b, torsion)};
}

contact::Wrench weight(double newton) { return {Vec3(0, 0, -newton), Vec3::Zero()}; }

TEST(ReduceContact, DiscUnderEvenPressureTwistsLikeADisc) {
  Patches patches;
  patches.add_disc(hand::Region::kIndexDistal, {20, 3, 0}, Vec3::UnitX(), 6.0, 12.0);
  ReductionOptions options;
  options.per_region = 1;
  options.friction = 0.6;
  const auto contacts = reduce_contact(patches.hand, patches.contact, options);
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_NEAR((contacts[0].position - Vec3(20, 3, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((contacts[0].normal + Vec3::UnitX()).norm(), 0.0, 1e-9);
  EXPECT_NEAR(contacts[0].normal_force, 12.0, 1e-9);
  EXPECT_EQ(contacts[0].region, hand::Region::kIndexDistal);
  EXPECT_NEAR(contacts[0].torsion, 0.6 * 2.0 / 3.0 * 6.0, 0.02);  // 2/3 mu a; 1 % for the grid
}

TEST(ReduceContact, TwoPatchesOfOneRegionBecomeTwoContacts) {
  Patches patches;
  patches.add_disc(hand::Region::kThenar, {0, 0, 0}, Vec3::UnitZ(), 3.0, 2.0, 6);
  patches.add_disc(hand::Region::kThenar, {30, 0, 0}, Vec3::UnitZ(), 3.0, 5.0, 6);
  const auto contacts = reduce_contact(patches.hand, patches.contact);
  ASSERT_EQ(contacts.size(), 2u);
  EXPECT_NEAR(contacts[0].position.x() + contacts[1].position.x(), 30.0, 1e-9);
  EXPECT_NEAR(contacts[0].normal_force + contacts[1].normal_force, 7.0, 1e-9);
}

TEST(ReduceContact, RegionsOfLeastForceGoWithout) {
  Patches patches;
  for (int r = 1; r <= 9; ++r) {
    patches.add(static_cast<hand::Region>(r), Vec3(10.0 * r, 0, 0), Vec3::UnitZ(), 1.0 + r);
  }
  ReductionOptions options;
  options.max_contacts = 4;
  const auto contacts = reduce_contact(patches.hand, patches.contact, options);
  ASSERT_EQ(contacts.size(), 4u);
  for (const GraspContact& one : contacts) EXPECT_GE(one.normal_force, 7.0);
}

TEST(ReduceContact, HardFingerHasNoTorsion) {
  Patches patches;
  patches.add_disc(hand::Region::kThenar, {0, 0, 0}, Vec3::UnitZ(), 3.0, 2.0, 6);
  ReductionOptions options;
  options.soft_finger = false;
  for (const GraspContact& one : reduce_contact(patches.hand, patches.contact, options)) {
    EXPECT_EQ(one.torsion, 0.0);
  }
}

TEST(LeastGripForce, PinchHoldsAWeightByFriction) {
  // Each finger carries half of W = 6 N by friction: mu p = W / 2. Eight sides have an edge
  // upright.
  const GripForce grip = least_grip_force(pinch(0.5, 10.0, 10.0), weight(6.0), Vec3::Zero());
  ASSERT_EQ(grip.status, GripForceStatus::kHeld);
  EXPECT_NEAR(grip.sum, 12.0, 1e-9);
  EXPECT_LT(grip.balance_error, 1e-9);
  ASSERT_TRUE(grip.factor.has_value());
  EXPECT_NEAR(*grip.factor, 0.6, 1e-9);  // 2 mu p lambda = W
  Vec3 sum = Vec3(0, 0, -6.0);
  for (const Vec3& force : grip.force) sum += force;
  EXPECT_LT(sum.norm(), 1e-9);
}

TEST(LeastGripForce, GrowsInProportionToTheLoad) {
  const GripForce one = least_grip_force(pinch(0.4, 5, 5, 2.0), weight(3.0), Vec3(2, 0, 1));
  const GripForce ten = least_grip_force(pinch(0.4, 5, 5, 2.0), weight(30.0), Vec3(2, 0, 1));
  ASSERT_EQ(one.status, GripForceStatus::kHeld);
  EXPECT_NEAR(ten.sum, 10.0 * one.sum, 1e-8);
}

TEST(LeastGripForce, UnevenPinchCannotKeepItsShares) {
  // Friction doesn't act along the line between the fingers, so 5 N against 8 N never balance;
  // other forces do.
  const GripForce grip = least_grip_force(pinch(0.5, 5.0, 8.0), weight(6.0), Vec3::Zero());
  EXPECT_EQ(grip.status, GripForceStatus::kHeld);
  EXPECT_NEAR(grip.sum, 12.0, 1e-9);
  EXPECT_FALSE(grip.factor.has_value());
}

TEST(LeastGripForce, OneFrictionlessPalmCarriesFromBelow) {
  const std::vector<GraspContact> palm = {finger({0, 0, -10}, {0, 0, 1}, 0.0, 1.0)};
  const GripForce grip = least_grip_force(palm, weight(4.0), Vec3::Zero());
  ASSERT_EQ(grip.status, GripForceStatus::kHeld);
  EXPECT_NEAR(grip.sum, 4.0, 1e-9);
  EXPECT_NEAR(grip.factor.value_or(0.0), 4.0, 1e-9);
}

TEST(LeastGripForce, LoadThatNothingMeetsNamesTheWayOut) {
  const std::vector<GraspContact> palm = {finger({0, 0, -10}, {0, 0, 1}, 0.0, 1.0)};
  const GripForce grip = least_grip_force(palm, weight(-4.0), Vec3::Zero());  // pulled up
  ASSERT_EQ(grip.status, GripForceStatus::kNotHoldable);
  EXPECT_FALSE(grip.factor.has_value());
  EXPECT_GT(grip.escape.translation.z(), 0.0);
  EXPECT_THAT(grip.message, HasSubstr("the product moves along (0.00, 0.00, 1.00)"));
  double fastest = 0.0;
  for (const GraspContact& one : palm) {
    fastest = std::max(fastest, grip.escape.at(one.position).norm());
  }
  EXPECT_NEAR(fastest, 1.0, 1e-9);
}

TEST(LeastGripForce, HardPinchLetsTheProductSpin) {
  const contact::Wrench twist{Vec3::Zero(),
                              Vec3(50.0, 0, 0)};  // N mm about the line of the fingers
  const GripForce hard = least_grip_force(pinch(0.5, 10, 10), twist, Vec3::Zero());
  ASSERT_EQ(hard.status, GripForceStatus::kNotHoldable);
  EXPECT_GT(hard.escape.rotation.x(), 0.0);
  EXPECT_THAT(hard.message, HasSubstr("about (1.00, 0.00, 0.00)"));
  // Soft fingers of torsion 2 mm hold it: 2 (p) x 2 mm = 50 N mm, so p = 12.5 N each.
  const GripForce soft = least_grip_force(pinch(0.5, 10, 10, 2.0), twist, Vec3::Zero());
  ASSERT_EQ(soft.status, GripForceStatus::kHeld);
  EXPECT_NEAR(soft.sum, 25.0, 1e-9);
  EXPECT_NEAR(soft.factor.value_or(0.0), 1.25, 1e-9);
}

TEST(LeastGripForce, MoreFrictionNeverAsksForMoreForce) {
  double last = std::numeric_limits<double>::infinity();
  for (double mu = 0.1; mu < 1.0; mu += 0.1) {
    const GripForce grip =
        least_grip_force(pinch(mu, 5, 5, 3.0 * mu), {Vec3(0, 1, -3), Vec3(5, 0, 0)}, Vec3(1, 0, 1));
    ASSERT_EQ(grip.status, GripForceStatus::kHeld);
    EXPECT_LE(grip.sum, last + 1e-9);
    last = grip.sum;
  }
}

TEST(LeastGripForce, NoLoadNeedsNoForce) {
  const GripForce grip = least_grip_force(pinch(0.5, 5, 5), weight(0.0), Vec3::Zero());
  EXPECT_EQ(grip.status, GripForceStatus::kNoLoad);
  EXPECT_EQ(grip.sum, 0.0);
}

/// Skin round a bar along z: eight discs on its sides at two heights.
Patches round_grip() {
  Patches patches;
  for (int k = 0; k < 8; ++k) {
    const double angle = 0.8 * k;
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    patches.add_disc(static_cast<hand::Region>(1 + k),
                     15.0 * outward + Vec3(0, 0, k % 2 ? 20.0 : -25.0), outward, 4.0, 5.0 + k, 8);
  }
  return patches;
}

TEST(AssessStability, TurnedWorldChangesNothing) {
  const Patches here = round_grip();
  Patches there = here;
  const Quat turn(Eigen::AngleAxisd(2.1, Vec3(0.3, -1, 0.4).normalized()));
  const Vec3 shift(12, 100, -7);
  for (Vec3& p : there.contact.deformed) p = turn * p + shift;
  for (Vec3& p : there.contact.undeformed) p = turn * p + shift;
  StabilityOptions options;
  options.reduction.max_contacts = 8;
  options.load = contact::ProductLoad{.weight = 5.0, .gravity = Vec3(0, 1, -1)};
  const StabilityResult a = assess_stability(here.hand, here.contact, Vec3(1, 2, 3), options);
  options.load->gravity = turn * *options.load->gravity;
  const StabilityResult b =
      assess_stability(there.hand, there.contact, turn * Vec3(1, 2, 3) + shift, options);
  const GraspIndices rows_a = to_indices(a), rows_b = to_indices(b);
  ASSERT_EQ(rows_a.size(), rows_b.size());
  for (std::size_t k = 0; k < rows_a.size(); ++k) {
    ASSERT_EQ(rows_a[k].value.has_value(), rows_b[k].value.has_value()) << rows_a[k].key;
    if (!rows_a[k].value) continue;
    // The facets of these may run out: their bounds are compared below.
    if (rows_a[k].key == "wrench_volume_l1" || rows_a[k].key == "epsilon_linf") continue;
    // Bounds within a thousandth are where the search ends.
    EXPECT_NEAR(*rows_a[k].value, *rows_b[k].value, 2e-3 * std::abs(*rows_a[k].value))
        << rows_a[k].key;
  }
  EXPECT_EQ(a.l1.status, ClosureStatus::kForceClosure);
  EXPECT_LE(a.linf.body.distance_lower, b.linf.body.distance + 1e-6);
  EXPECT_LE(b.linf.body.distance_lower, a.linf.body.distance + 1e-6);
  ASSERT_TRUE(a.volume && b.volume);
  const double rounding = 1.0 + 1e-6;
  EXPECT_LE(a.volume->body.volume, b.volume->body.volume_upper * rounding);
  EXPECT_LE(b.volume->body.volume, a.volume->body.volume_upper * rounding);
}

TEST(AssessStability, EveryRowExplainsItself) {
  const Patches patches = round_grip();
  StabilityOptions options;
  options.load = contact::ProductLoad{.weight = 5.0};
  const StabilityResult result =
      assess_stability(patches.hand, patches.contact, Vec3::Zero(), options);
  for (const GraspIndex& row : to_indices(result)) {
    EXPECT_EQ(row.group, "stability");
    EXPECT_FALSE(row.name.empty()) << row.key;
    EXPECT_FALSE(row.definition.empty()) << row.key;
    EXPECT_FALSE(row.source.empty()) << row.key;
    if (!row.value) {
      EXPECT_FALSE(row.remark.empty()) << row.key;
      continue;
    }
    if (row.lowest) {
      EXPECT_GE(*row.value, *row.lowest) << row.key;
    }
    if (row.highest) {
      EXPECT_LE(*row.value, *row.highest) << row.key;
    }
  }
}

TEST(AssessStability, GripWithoutFrictionIsNamed) {
  const Patches patches = round_grip();
  StabilityOptions options;
  options.reduction.friction = 0.0;
  const StabilityResult result =
      assess_stability(patches.hand, patches.contact, Vec3::Zero(), options);
  EXPECT_NE(result.l1.status, ClosureStatus::kForceClosure);
  EXPECT_EQ(result.l1.epsilon, 0.0);
  EXPECT_THAT(result.message, HasSubstr("there is no friction"));
}

TEST(AssessStability, NothingTouchedIsNamed) {
  Patches patches = round_grip();
  for (double& force : patches.contact.force) force = 0.0;
  const StabilityResult result = assess_stability(patches.hand, patches.contact, Vec3::Zero());
  EXPECT_EQ(result.l1.status, ClosureStatus::kNoContact);
  EXPECT_THAT(result.contacts, IsEmpty());
  EXPECT_THAT(result.message, HasSubstr("nothing is touched"));
  for (const GraspIndex& row : to_indices(result)) {
    EXPECT_FALSE(row.value.has_value()) << row.key;
    EXPECT_THAT(row.remark, HasSubstr("nothing is touched")) << row.key;
  }
}

TEST(AssessStability, BadOptionsAreNamed) {
  const Patches patches = round_grip();
  const auto message = [&](const StabilityOptions& options) {
    try {
      assess_stability(patches.hand, patches.contact, Vec3::Zero(), options);
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  StabilityOptions options;
  options.reduction.max_contacts = 3;
  EXPECT_THAT(message(options), HasSubstr("contacts in all are 3; 4 to 64 are allowed"));
  options = {};
  options.reduction.friction = 7.0;
  EXPECT_THAT(message(options), HasSubstr("friction coefficient"));
  options = {};
  options.volume_contacts = 0;
  EXPECT_THAT(message(options), HasSubstr("contacts for the volume are 0"));
}

}  // namespace
}  // namespace palmar::grasp
