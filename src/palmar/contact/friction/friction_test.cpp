// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/friction/friction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "palmar/contact/contact_test_hand.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::contact {
namespace {

using contact_test::Ball;
using contact_test::ball_hand;
using contact_test::HalfSpace;
using contact_test::Sheet;
using testing::HasSubstr;

constexpr double kBallRadius = 8.0;  // mm

/// Two balls of skin, tips of index finger and thumb, above and below a sheet of 4 mm; each is
/// pressed in by 1 mm.
struct Pinch {
  Sheet sheet{-2.0, 2.0};
  std::shared_ptr<hand::Hand> hand = std::make_shared<hand::Hand>();
  PreparedHand prepared;
  ContactResult contact;

  Pinch() : prepared(make_hand()) {
    contact = solve_hand_contact(prepared, hand->skin.vertices, geometry::Rigid3{}, sheet, {});
  }
  std::shared_ptr<const hand::Hand> make_hand() {
    const geometry::TriangleMesh ball = geometry::make_icosphere(kBallRadius, 3);
    for (const double side : {1.0, -1.0}) {
      const int first = hand->skin.vertex_count();
      const bool is_index = side > 0.0;
      for (const Vec3& v : ball.vertices) {
        hand->skin.vertices.push_back(v + side * (kBallRadius + 1.0) * Vec3::UnitZ());
        hand->region.push_back(is_index ? hand::Region::kIndexDistal : hand::Region::kThumbDistal);
        hand->segment.push_back(is_index ? hand::Segment::kIndexDistal
                                         : hand::Segment::kThumbDistal);
      }
      for (const Triangle& t : ball.triangles) {
        hand->skin.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
    hand->name = "pinch";
    hand->tissue = hand::default_tissue();
    return hand;
  }
  FrictionResult hold(const ProductLoad& load, double coefficient = 0.5) const {
    return solve_friction(prepared, contact, sheet, Vec3::Zero(),
                          {.coefficient = coefficient, .load = load});
  }
  double limit(double coefficient = 0.5) const { return coefficient * contact.total.force; }
};

const Pinch& pinch() {
  static const Pinch one;
  return one;
}

ContactOptions without_swelling(std::optional<double> shear_modulus = std::nullopt) {
  ContactOptions options;
  options.swelling = false;
  options.shear_modulus = shear_modulus;
  return options;
}

Vec3 sum(const std::vector<Vec3>& vectors) {
  Vec3 total = Vec3::Zero();
  for (const Vec3& v : vectors) total += v;
  return total;
}

TEST(Friction, PinchHoldsTwiceTheFrictionOfOneSide) {
  ASSERT_EQ(pinch().contact.status, ContactStatus::kSolved);
  const FrictionResult held =
      pinch().hold({.weight = 0.25 * pinch().limit(), .gravity = Vec3(1, 0, 0)});
  EXPECT_EQ(held.status, FrictionStatus::kHeld);
  EXPECT_NEAR(held.load_factor.value(), 4.0, 1e-4);
  EXPECT_NEAR(held.margin, 0.75, 1e-4);
  EXPECT_LT(held.balance_error, 1e-8);
  EXPECT_LT((sum(held.force) + held.load.force).norm(), 1e-8 * held.load.force.norm());
  // Pulled down, it sinks, and each finger carries half.
  EXPECT_GT(held.motion.translation.x(), 0.0);
  ASSERT_EQ(held.regions.size(), 2u);
  EXPECT_NEAR(held.regions[0].force.x() / held.regions[1].force.x(), 1.0, 0.02);
  EXPECT_EQ(held.regions[0].region, hand::Region::kThumbDistal);
  EXPECT_NEAR(held.regions[0].limit + held.regions[1].limit, pinch().limit(), 1e-6);
  // Both sides press alike: nothing is left over.
  EXPECT_LT(held.grip.force.norm(), 0.01 * pinch().contact.total.force);
}

TEST(Friction, MobilisedIsTheShareOfTheLimitVertexByVertex) {
  const FrictionResult held =
      pinch().hold({.weight = 0.6 * pinch().limit(), .gravity = Vec3(1, 2, 0)});
  ASSERT_EQ(held.mobilised.size(), pinch().contact.force.size());
  int slipping = 0;
  for (std::size_t v = 0; v < held.mobilised.size(); ++v) {
    EXPECT_LE(held.mobilised[v], 1.0);
    EXPECT_NEAR(held.force[v].norm(), 0.5 * held.mobilised[v] * pinch().contact.force[v], 1e-9);
    EXPECT_NEAR(held.force[v].z(), 0.0, 1e-9);  // in the plane of the sheet
    if (held.mobilised[v] > 0.9999) ++slipping;
  }
  // The rim of the contact slips first, the middle last.
  EXPECT_GT(slipping, 0);
  EXPECT_GT(held.slipping_share, 0.0);
  EXPECT_LT(held.slipping_share, 1.0);
}

TEST(Friction, HeavierIsNeverSafer) {
  double margin = 1.0, slipping = 0.0;
  for (const double share : {0.1, 0.3, 0.5, 0.8, 0.95}) {
    const FrictionResult held =
        pinch().hold({.weight = share * pinch().limit(), .gravity = Vec3(0, 1, 0)});
    EXPECT_EQ(held.status, FrictionStatus::kHeld);
    EXPECT_LT(held.margin, margin);
    EXPECT_GE(held.slipping_share, slipping);
    margin = held.margin;
    slipping = held.slipping_share;
  }
}

TEST(Friction, TooHeavySlipsAndReportsHowMuchIsHeld) {
  const FrictionResult slips =
      pinch().hold({.weight = 2.0 * pinch().limit(), .gravity = Vec3(1, 0, 0)});
  EXPECT_EQ(slips.status, FrictionStatus::kSlips);
  EXPECT_NEAR(slips.load_factor.value(), 0.5, 1e-5);
  EXPECT_EQ(slips.margin, 0.0);
  EXPECT_LT((sum(slips.force) + 0.5 * slips.load.force).norm(), 1e-4 * slips.load.force.norm());
  EXPECT_NEAR(slips.slip.translation.x(), 1.0, 1e-3);  // along the load, 1 mm
  for (const RegionFriction& region : slips.regions) EXPECT_LT(region.margin, 1e-4);
}

TEST(Friction, WithoutLoadThereAreNoTractions) {
  const FrictionResult free = pinch().hold({});
  EXPECT_EQ(free.status, FrictionStatus::kHeld);
  EXPECT_FALSE(free.load_factor.has_value());
  EXPECT_EQ(free.margin, 1.0);
  for (const Vec3& force : free.force) EXPECT_EQ(force.norm(), 0.0);
  for (const double share : free.mobilised) EXPECT_EQ(share, 0.0);
}

TEST(Friction, HoldsNothingAcrossTheSheet) {
  const FrictionResult slips = pinch().hold({.force = {0, 0, 1}});
  EXPECT_EQ(slips.status, FrictionStatus::kSlips);
  EXPECT_LT(slips.load_factor.value(), 1e-6);
}

TEST(Friction, TorqueTurnsAboutTheLineBetweenTheFingers) {
  const FrictionResult held = pinch().hold({.torque = {0, 0, 0.3 * pinch().limit()}});
  EXPECT_EQ(held.status, FrictionStatus::kHeld);
  EXPECT_GT(held.motion.rotation.z(), 0.0);
  // The limit of a pad is mu sum p r; the pads are as wide as their load.
  double expected = 0.0;
  for (std::size_t v = 0; v < held.force.size(); ++v) {
    expected += 0.5 * pinch().contact.force[v] * pinch().contact.deformed[v].head<2>().norm();
  }
  EXPECT_NEAR(0.3 * pinch().limit() * held.load_factor.value() / expected, 1.0, 0.01);
}

TEST(Friction, BallOnAPlaneIsCattaneosContact) {
  // Hertz: a = sqrt(R d), P = 16/3 G sqrt(R) d^1.5; Mindlin: delta = 3 mu P (2 - nu) / (16 G a)
  // (1 - (1 - Q / mu P)^(2/3)). Through the whole chain, mesh and contact included: 5 %.
  constexpr double kRadius = 10.0, kDepth = 1.0, kModulus = 0.03, kMu = 0.6;
  const auto hand = ball_hand(kRadius, 4);
  const PreparedHand prepared(hand);
  const HalfSpace plane(-kRadius + kDepth);
  const ContactResult contact = solve_hand_contact(
      prepared, hand->skin.vertices, geometry::Rigid3{}, plane, without_swelling(kModulus));
  ASSERT_EQ(contact.status, ContactStatus::kSolved);
  const double slip_force = kMu * contact.total.force;
  const double a = std::sqrt(kRadius * kDepth);
  const FrictionResult held =
      solve_friction(prepared, contact, plane, contact.total.centre,
                     {.coefficient = kMu, .load = {.force = {0.5 * slip_force, 0, 0}}});
  ASSERT_EQ(held.status, FrictionStatus::kHeld);
  EXPECT_NEAR(held.load_factor.value(), 2.0, 1e-4);
  const double expected =
      3.0 * slip_force * 1.5 / (16.0 * kModulus * a) * (1.0 - std::pow(0.5, 2.0 / 3.0));
  EXPECT_NEAR(held.motion.translation.x() / expected, 1.0, 0.05);
}

TEST(Friction, NormalsAreThoseOfTheContact) {
  const auto hand = ball_hand(12.0, 3);
  const PreparedHand prepared(hand);
  const Ball ball(Vec3(3, 2, -20), 10.0);
  const ContactResult contact =
      solve_hand_contact(prepared, hand->skin.vertices, geometry::Rigid3{}, ball, {});
  ASSERT_EQ(contact.status, ContactStatus::kSolved);
  const FrictionResult held = solve_friction(prepared, contact, ball, Vec3::Zero(),
                                             {.coefficient = 1.0, .load = {.torque = {1, 0, 0}}});
  EXPECT_LT((held.grip.force - contact.total.force_vector).norm(),
            1e-3 * contact.total.force_vector.norm());
  for (std::size_t v = 0; v < held.force.size(); ++v) {
    const Vec3 normal = (contact.deformed[v] - Vec3(3, 2, -20)).normalized();
    EXPECT_NEAR(held.force[v].dot(normal), 0.0, 1e-5 * (1.0 + held.force[v].norm()));
  }
}

TEST(Friction, HandAndProductMovedTogetherChangeNothing) {
  const auto hand = ball_hand(10.0, 3);
  const PreparedHand prepared(hand);
  const HalfSpace plane(-9.0);
  const geometry::Rigid3 move{Quat(Eigen::AngleAxisd(0.8, Vec3(1, 2, -1).normalized())),
                              Vec3(40, -7, 12)};
  std::vector<Vec3> moved;
  for (const Vec3& v : hand->skin.vertices) moved.push_back(move * v);
  const ContactResult here = solve_hand_contact(prepared, hand->skin.vertices, geometry::Rigid3{},
                                                plane, without_swelling());
  const ContactResult there =
      solve_hand_contact(prepared, moved, move.inverse(), plane, without_swelling());
  const double limit = 0.5 * here.total.force;
  const FrictionOptions options{
      .coefficient = 0.5,
      .load = {.force = {0.4 * limit, 0.2 * limit, 0}, .torque = {0, 0, 0.3 * limit}}};
  const FrictionResult a = solve_friction(prepared, here, plane, here.total.centre, options);
  const FrictionResult b = solve_friction(prepared, there, plane, there.total.centre, options);
  ASSERT_EQ(a.status, FrictionStatus::kHeld);
  EXPECT_NEAR(a.load_factor.value() / b.load_factor.value(), 1.0, 1e-5);
  EXPECT_LT((a.motion.translation - b.motion.translation).norm(),
            1e-4 * a.motion.translation.norm());
}

TEST(Friction, SameBytesForOneThreadAndTwo) {
  const auto solve = [&](int threads) {
    set_thread_count(threads);
    FrictionResult result =
        pinch().hold({.weight = 0.5 * pinch().limit(), .gravity = Vec3(1, 0, 0)});
    set_thread_count(0);
    return result;
  };
  const FrictionResult one = solve(1), two = solve(2);
  EXPECT_TRUE(one.force == two.force);
  EXPECT_EQ(one.load_factor.value(), two.load_factor.value());
}

TEST(Friction, OffAndWithoutContact) {
  EXPECT_EQ(pinch().hold({.weight = 5.0}, 0.0).status, FrictionStatus::kOff);
  const auto hand = ball_hand(10.0, 2);
  const PreparedHand prepared(hand);
  const HalfSpace far(-30.0);
  const ContactResult apart =
      solve_hand_contact(prepared, hand->skin.vertices, geometry::Rigid3{}, far, {});
  const FrictionResult none = solve_friction(prepared, apart, far, Vec3::Zero(),
                                             {.coefficient = 0.5, .load = {.weight = 1.0}});
  EXPECT_EQ(none.status, FrictionStatus::kNoContact);
  EXPECT_THAT(none.message, HasSubstr("nothing is touched"));
}

TEST(Friction, WrenchOfALoad) {
  const Wrench wrench = wrench_of({.weight = 3.0,
                                   .gravity = Vec3(0, 0, -2),
                                   .mass_centre = Vec3(1, 0, 0),
                                   .force = {0, 1, 0},
                                   .torque = {0, 0, 7},
                                   .force_at = Vec3(0, 0, 5)},
                                  Vec3(9, 9, 9));
  EXPECT_LT((wrench.force - Vec3(0, 1, -3)).norm(), 1e-12);
  EXPECT_LT((wrench.moment - Vec3(-5, 3, 7)).norm(), 1e-12);
}

TEST(Friction, RefusesWrongInput) {
  const auto message = [](const FrictionOptions& options) -> std::string {
    try {
      options.check();
    } catch (const UsageError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(message({.coefficient = -0.1, .load = {}}), HasSubstr("at most 5 is required"));
  EXPECT_THAT(message({.coefficient = std::nan(""), .load = {}}), HasSubstr("coefficient is nan"));
  EXPECT_THAT(message({.coefficient = 0.5, .load = {.weight = -1.0}}),
              HasSubstr("weight is -1.000000 N"));
  EXPECT_THAT(message({.coefficient = 0.5, .load = {.weight = 1.0, .gravity = Vec3::Zero()}}),
              HasSubstr("gravity is 0, 0, 0; a direction is required"));
  EXPECT_THAT(message({.coefficient = 0.5,
                       .load = {.force = {0, std::numeric_limits<double>::infinity(), 0}}}),
              HasSubstr("force is 0.000000, inf, 0.000000 N; finite values are required"));
  EXPECT_EQ(message({.coefficient = 1.2, .load = {.weight = 10.0}}), "no error");
}

}  // namespace
}  // namespace palmar::contact
