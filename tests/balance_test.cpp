// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand's grasps come to rest (grasp/rest/balance.h).
#include "palmar/grasp/rest/balance.h"
#include "palmar/grasp/find/find_grasp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "palmar/contact/contact_normals.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/tendons/hand_muscles.h"
#include "palmar/product/primitives.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

product::Product cylinder(double diameter) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = 150.0;
  return product::make_cylinder_product(options);
}

class BalanceTest : public TemplateTest {
 protected:
  static const contact::PreparedHand& prepared() {
    static const contact::PreparedHand made(std::make_shared<const hand::Hand>(hand()));
    return made;
  }
  static const product::Product& bar() {
    static const product::Product made = cylinder(48.0);
    return made;
  }
  static const grasp::Grasp& closed() {
    static const grasp::Grasp made = grasp::close_power_grasp(hand(), bar());
    return made;
  }
  struct Rest {
    grasp::Grasp grasp;
    grasp::Balance balance;
    contact::ContactResult contact;
  };
  static Rest settle(const product::Product& product, grasp::Grasp grasp,
                     const grasp::BalanceOptions& options) {
    Rest rest{.grasp = std::move(grasp), .balance = {}, .contact = {}};
    rest.balance = grasp::balance_grasp(prepared(), product, rest.grasp, options);
    rest.contact =
        contact::solve_hand_contact(prepared(), hand::pose_skin(hand(), rest.grasp.posture),
                                    rest.grasp.product_from_hand, *product.distance);
    return rest;
  }
  static Rest settle(const grasp::BalanceOptions& options = {}) {
    return settle(bar(), closed(), options);
  }
};

/// Sum of normal and friction forces on the product, computed afresh; N and N mm about `centre`.
struct Sums {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};
Sums sums_on_product(const contact::ContactResult& contact, const grasp::Balance& balance,
                     const product::Product& product, const Vec3& centre) {
  Sums sums;
  const std::vector<int> loaded = contact::loaded_vertices(contact);
  const std::vector<Vec3> normals = contact::contact_normals(contact, *product.distance, loaded);
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const auto v = static_cast<std::size_t>(loaded[k]);
    const Vec3 force = balance.friction_force[v] - contact.force[v] * normals[k];
    sums.force += force;
    sums.moment += (contact.undeformed[v] - centre).cross(force);
  }
  return sums;
}

TEST_F(BalanceTest, ForcesAndMomentsOnTheProductAddUpToNothing) {
  const Rest rest = settle();
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  const Sums sums = sums_on_product(rest.contact, rest.balance, bar(), rest.contact.total.centre);
  EXPECT_LT(sums.force.norm(), 0.01 * rest.balance.grip_force);
  EXPECT_LT(sums.moment.norm(), 0.01 * rest.balance.grip_force * 40.0);
  EXPECT_NEAR(grasp::grip_force(rest.contact, *bar().distance).force, rest.balance.grip_force,
              0.01 * rest.balance.grip_force);
}

TEST_F(BalanceTest, FrictionIsTangentialAndWithinItsLimit) {
  const Rest rest = settle();
  const std::vector<int> loaded = contact::loaded_vertices(rest.contact);
  const std::vector<Vec3> normals = contact::contact_normals(rest.contact, *bar().distance, loaded);
  double largest = 0.0;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const auto v = static_cast<std::size_t>(loaded[k]);
    const Vec3& t = rest.balance.friction_force[v];
    EXPECT_LE(t.norm(), rest.balance.friction * rest.contact.force[v] * 1.01 + 1e-6);
    EXPECT_NEAR(t.dot(normals[k]), 0.0, 1e-3 * rest.contact.force[v] + 1e-6);
    largest = std::max(largest, t.norm());
  }
  EXPECT_GT(largest, 0.0);
}

TEST_F(BalanceTest, JointsCarryTheMomentsOfTheMuscles) {
  // Rigid phalanges instead of the skin's own motion: moments of all contact forces beyond a joint
  // about its axis, by the skeleton.
  grasp::BalanceOptions options;
  options.friction = 0.0;
  options.grip_force = 40.0;
  const Rest rest = settle(options);
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  const std::vector<int> loaded = contact::loaded_vertices(rest.contact);
  const std::vector<Vec3> normals = contact::contact_normals(rest.contact, *bar().distance, loaded);
  const geometry::Rigid3 hand_from_product = rest.grasp.product_from_hand.inverse();
  const hand::PosedSkeleton posed = hand::pose_skeleton(hand().skeleton, rest.grasp.posture);
  int looked_at = 0;
  for (const auto& [dof, parent, first, last] :
       {std::tuple{hand::Dof::kMiddleMcpFlexion, hand::Segment::kPalm,
                   hand::Segment::kMiddleProximal, hand::Segment::kMiddleDistal},
        {hand::Dof::kRingMcpFlexion, hand::Segment::kPalm, hand::Segment::kRingProximal,
         hand::Segment::kRingDistal}}) {
    const hand::JointDof& joint = hand().skeleton.dof(dof);
    if (rest.grasp.posture[dof] > joint.upper - 1e-3) continue;  // the joint's end carries a part
    const geometry::Rigid3& base = posed.segment[static_cast<std::size_t>(parent)];
    const Vec3 axis = base.rotation * joint.axis, centre = base * joint.centre;
    double moment = 0.0;
    for (std::size_t k = 0; k < loaded.size(); ++k) {
      const auto v = static_cast<std::size_t>(loaded[k]);
      const hand::Segment segment = hand().segment[v];
      if (segment < first || segment > last) continue;
      const Vec3 force = hand_from_product.rotation * (rest.contact.force[v] * normals[k]);
      const Vec3 point = hand_from_product * rest.contact.undeformed[v];
      moment += axis.dot((point - centre).cross(force));
    }
    const double load =
        rest.balance.joint_load->digit[palmar::index_of(*hand::finger_of(first))][0];
    EXPECT_NEAR(moment, load, 0.15 * std::abs(load)) << name_of(dof);
    EXPECT_LT(load, 0.0);  // the product opens the hand
    ++looked_at;
  }
  EXPECT_GT(looked_at, 0);
}

TEST_F(BalanceTest, StrengthInUseIsTheStrengthThatItTakes) {
  grasp::BalanceOptions options;
  options.grip_force = 80.0;
  const Rest rest = settle(options);
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  const double use = *rest.balance.strength_use;
  EXPECT_GT(use, 0.1);
  EXPECT_LT(use, 1.0);
  // A person with a little more than that holds it; with much less no other posture helps.
  options.strength = 1.2 * use;
  const Rest enough = settle(options);
  EXPECT_EQ(enough.balance.status, grasp::BalanceStatus::kBalanced) << enough.balance.message;
  EXPECT_NEAR(enough.balance.grip_force, 80.0, 0.8);
  options.strength = 0.35 * use;
  EXPECT_LT(settle(options).balance.grip_force, 70.0);
}

TEST_F(BalanceTest, AWeakHandStaysBelowTheForceAskedFor) {
  grasp::BalanceOptions options;
  options.grip_force = 120.0;
  options.strength = 0.4;
  const Rest rest = settle(options);
  EXPECT_LT(rest.balance.grip_force, 110.0) << rest.balance.message;
  if (rest.balance.strength_use) {
    EXPECT_LT(*rest.balance.strength_use, 1.02);
  }
}

TEST_F(BalanceTest, ReachesTheGripForceAskedFor) {
  double last_area = 0.0, last_use = 0.0;
  for (const double force : {20.0, 60.0, 150.0}) {
    grasp::BalanceOptions options;
    options.grip_force = force;
    const Rest rest = settle(options);
    ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
    EXPECT_NEAR(rest.balance.grip_force, force, 0.01 * force);
    EXPECT_GT(rest.contact.total.area, last_area);
    EXPECT_GT(*rest.balance.strength_use, last_use);
    last_area = rest.contact.total.area;
    last_use = *rest.balance.strength_use;
  }
}

TEST_F(BalanceTest, WithoutFrictionNormalForcesAloneBalance) {
  grasp::BalanceOptions options;
  options.friction = 0.0;
  options.grip_force = 40.0;
  const Rest rest = settle(options);
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  EXPECT_LT(rest.contact.total.force_vector.norm(), 0.01 * 40.0);
  EXPECT_EQ(rest.balance.friction_use, 0.0);
}

TEST_F(BalanceTest, CarriesALoadThatFrictionCanHold) {
  grasp::BalanceOptions options;
  options.load.weight = 8.0;
  options.load.gravity = closed().grip_axis;
  const Rest rest = settle(options);
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  const Sums sums = sums_on_product(rest.contact, rest.balance, bar(), rest.contact.total.centre);
  EXPECT_LT((sums.force + 8.0 * closed().grip_axis).norm(), 0.01 * rest.balance.grip_force);
}

TEST_F(BalanceTest, ASmoothBarSlipsOutAlongItsLoad) {
  for (const double sign : {1.0, -1.0}) {
    grasp::BalanceOptions options;
    options.friction = 0.0;
    options.load.weight = 20.0;
    options.load.gravity = sign * closed().grip_axis;
    grasp::Grasp grasp = closed();
    const grasp::Balance balance = grasp::balance_grasp(prepared(), bar(), grasp, options);
    ASSERT_EQ(balance.status, grasp::BalanceStatus::kSlipsOut) << balance.message;
    const Vec3 pull = closed().product_from_hand.rotation.conjugate() * options.load.down();
    ASSERT_TRUE(balance.slip);
    EXPECT_GT(balance.slip->dot(pull), 0.8);
    EXPECT_THAT(balance.message, HasSubstr("slips out, towards "));
  }
}

TEST_F(BalanceTest, AGripForceOutOfReachIsNoSlip) {
  // Without a load nothing can slip under it, however far the hand stays below what was asked for.
  const product::Product thin = cylinder(20.0);
  grasp::BalanceOptions options;
  options.grip_force = 250.0;
  const Rest rest = settle(thin, grasp::close_power_grasp(hand(), thin), options);
  EXPECT_THAT(rest.balance.message, ::testing::Not(HasSubstr("under its load")));
  EXPECT_NEAR(rest.balance.slip.value_or(Vec3::UnitX()).norm(), 1.0, 1e-9);
}

TEST_F(BalanceTest, ATorqueAloneIsALoad) {
  grasp::BalanceOptions options;
  options.load.torque = 100.0 * closed().grip_axis;
  const Rest rest = settle(options);
  ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
  const Sums sums = sums_on_product(rest.contact, rest.balance, bar(), rest.contact.total.centre);
  EXPECT_LT((sums.moment + options.load.torque).norm(), 0.01 * rest.balance.grip_force * 40.0);
}

TEST_F(BalanceTest, NothingTouchedIsSaid) {
  grasp::Grasp away = closed();
  away.product_from_hand.translation += Vec3(500.0, 0.0, 0.0);
  EXPECT_EQ(grasp::balance_grasp(prepared(), bar(), away).status, grasp::BalanceStatus::kNoContact);
}

TEST_F(BalanceTest, IsTheSameWithAnyNumberOfThreads) {
  set_thread_count(1);
  const Rest one = settle();
  set_thread_count(2);
  const Rest two = settle();
  set_thread_count(0);
  EXPECT_EQ(one.grasp.posture.angle, two.grasp.posture.angle);
  EXPECT_EQ(one.grasp.product_from_hand.translation, two.grasp.product_from_hand.translation);
}

TEST_F(BalanceTest, TurningTheWorldChangesNothing) {
  const geometry::Rigid3 turn =
      geometry::Rigid3::about_axis(Vec3(0.3, -0.5, 0.8).normalized(), Vec3(10, 4, -7), 1.1);
  product::Product turned = bar();
  for (Vec3& v : turned.mesh.vertices) v = turn * v;
  turned.distance = std::make_shared<geometry::MeshDistance>(turned.mesh);
  grasp::Grasp grasp = closed();
  grasp.product_from_hand = turn * grasp.product_from_hand;
  grasp::BalanceOptions options;
  options.load.weight = 5.0;
  options.load.gravity = Vec3(0.0, 1.0, -1.0);
  const Rest here = settle(bar(), closed(), options);
  options.load.gravity = turn.rotation * *options.load.gravity;
  const Rest there = settle(turned, grasp, options);
  EXPECT_NEAR(there.balance.grip_force, here.balance.grip_force, 0.01 * here.balance.grip_force);
  EXPECT_NEAR(there.contact.total.force, here.contact.total.force, 0.01 * here.contact.total.force);
  EXPECT_NEAR(there.balance.moved, here.balance.moved, 0.2);
}

TEST_F(BalanceTest, NormalForcesAndSharesOfPhalangesAreThoseOfPeople) {
  // Sum of normal forces over grip force on a 51 mm handle: 2.50, SD 0.18, ten measured
  // conditions; shares of phalanges over three cylinders: Manugraphy, J Hand Ther 2017
  // 30(4):529-537, 152 adults.
  std::array<double, 3> distal{}, proximal{};
  const std::array<double, 3> diameters = {32.0, 48.0, 64.0};
  for (std::size_t i = 0; i < 3; ++i) {
    const product::Product product = cylinder(diameters[i]);
    const Rest rest = settle(product, grasp::close_power_grasp(hand(), product), {});
    ASSERT_EQ(rest.balance.status, grasp::BalanceStatus::kBalanced) << rest.balance.message;
    double sum = 0.0;
    for (const contact::RegionContact& region : rest.contact.regions) {
      sum += region.force;
      const auto place =
          static_cast<int>(region.region) - static_cast<int>(hand::Region::kIndexProximal);
      if (place < 0 || place >= 12) continue;
      if (place % 3 == 0) proximal[i] += region.force;
      if (place % 3 == 2) distal[i] += region.force;
    }
    distal[i] /= sum;
    proximal[i] /= sum;
  }
  // People's distal share rises with the diameter, ours doesn't: a row that validate misses (G5).
  EXPECT_GT(proximal[0], proximal[1]);
  EXPECT_GT(proximal[1], proximal[2]);

  const product::Product handle = cylinder(51.0);
  grasp::BalanceOptions usual;
  usual.grip_force = 107.0;
  const Rest rest = settle(handle, grasp::close_power_grasp(hand(), handle), usual);
  const double ratio = rest.balance.sum_of_normals / rest.balance.grip_force;
  EXPECT_GE(ratio, 2.1);
  EXPECT_LE(ratio, 2.9);
}

TEST(BalanceOptionsTest, RefusesWhatMakesNoSense) {
  const auto message = [](const grasp::BalanceOptions& options) {
    try {
      options.check();
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  grasp::BalanceOptions options;
  options.friction = -0.1;
  EXPECT_THAT(message(options), HasSubstr("friction is -0.1; 0 to 5"));
  options.friction = 0.5;
  options.grip_force = 0.0;
  EXPECT_THAT(message(options), HasSubstr("grip force is 0 N"));
  options.grip_force = 1e4;
  EXPECT_THAT(message(options), HasSubstr("at most 2000 N"));
  grasp::BalanceOptions floating;
  floating.load.weight = 3.0;
  floating.load.gravity = Vec3::Zero();
  EXPECT_THAT(message(floating), HasSubstr("gravity is 0, 0, 0"));
}

TEST(JointStrengthTest, GripStrengthKnowsSexAndAge) {
  EXPECT_NEAR(*grasp::grip_strength(grasp::Sex::kMale, 30.0), 53.5 * 9.80665, 1e-9);
  EXPECT_NEAR(*grasp::grip_strength(grasp::Sex::kFemale, 82.0), 22.1 * 9.80665, 1e-9);
  EXPECT_FALSE(grasp::grip_strength(grasp::Sex::kMale, 12.0).has_value());
  EXPECT_FALSE(grasp::grip_strength(grasp::Sex::kMale, 120.0).has_value());
  EXPECT_LT(*grasp::grip_strength(grasp::Sex::kFemale, 40.0),
            *grasp::grip_strength(grasp::Sex::kMale, 40.0));
}

}  // namespace
}  // namespace palmar::tests
