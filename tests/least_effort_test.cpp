// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand holds a bar with least effort (grasp/equilibrium/least_effort.h).
#include "palmar/grasp/equilibrium/least_effort.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "palmar/contact/contact_normals.h"
#include "palmar/contact/prepared/coarse_hand.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/grasp/equilibrium/nearby_rests.h"
#include "palmar/grasp/equilibrium/volar_gaps.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/tendons/joint_limits.h"
#include "palmar/product/primitives.h"
#include "template_fixture.h"
#include "template_on_bone.h"

namespace palmar::tests {
namespace {

class LeastEffort : public TemplateTest {
 protected:
  static const contact::PreparedHand& prepared() {
    static const contact::PreparedHand made(std::make_shared<const hand::Hand>(hand()));
    return made;
  }
  static product::Product cylinder(double diameter) {
    return product::make_cylinder_product({.diameter = diameter, .length = 150.0});
  }
  static const product::Product& bar() {
    static const product::Product made = cylinder(48.0);
    return made;
  }
  static const grasp::GripState& closed() {
    static const grasp::GripState made = [] {
      const grasp::Grasp grasp = grasp::close_power_grasp(hand(), bar());
      return grasp::GripState{grasp.posture, grasp.product_from_hand};
    }();
    return made;
  }
  static grasp::EffortRest rest(double grip_force, const contact::Wrench& load = {}) {
    return grasp::rest_with_least_effort(prepared(), bar(), closed(),
                                         {.force = grip_force, .load = load}, {});
  }
};

/// What pushes the product, added up anew from the solved contact and the friction: N, and N mm
/// about the origin; product frame.
contact::Wrench wrench_on_bar(const contact::PreparedHand& prepared, const product::Product& bar,
                              const grasp::EffortRest& rest) {
  const contact::ContactResult contact =
      contact::solve_hand_contact(prepared, hand::pose_skin(prepared.hand(), rest.state.posture),
                                  rest.state.product_from_hand, *bar.distance);
  const std::vector<int> loaded = contact::loaded_vertices(contact);
  const std::vector<Vec3> normals = contact::contact_normals(contact, *bar.distance, loaded);
  contact::Wrench sum;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const int v = loaded[k];
    const Vec3 force = rest.friction_force[v] - contact.force[v] * normals[k];
    sum.force += force;
    sum.moment += contact.undeformed[v].cross(force);
  }
  return sum;
}

TEST_F(LeastEffort, MeritFallsInEveryStepAndForcesAddUpToNothing) {
  constexpr double kGripForce = 107.0;  // N
  const grasp::EffortRest found = rest(kGripForce);
  ASSERT_EQ(found.status, grasp::EffortRest::Status::kSolved);
  for (std::size_t i = 1; i < found.merit.size(); ++i) {
    EXPECT_LT(found.merit[i], found.merit[i - 1]) << i;
  }
  EXPECT_NEAR(found.grip.force, kGripForce, 0.005 * kGripForce);
  EXPECT_GE(found.activation.minCoeff(), 0.0);
  EXPECT_LE(found.activation.maxCoeff(), 1.0);
  EXPECT_LT(found.missing.lpNorm<Eigen::Infinity>(), 0.02 * found.strongest_moment);
  const contact::Wrench left = wrench_on_bar(prepared(), bar(), found);
  EXPECT_LT(left.force.norm(), 0.01 * kGripForce);
  EXPECT_LT(left.moment.norm(), 0.01 * kGripForce * found.arm);
  // Ligaments keep joints near their ranges.
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    const hand::JointDof& dof = hand().skeleton.dof(grasp::grip_dof(j));
    EXPECT_GT(found.state.posture[dof.dof], dof.lower - 0.2) << name_of(dof.dof);
    EXPECT_LT(found.state.posture[dof.dof], dof.upper + hand::kPassiveRange) << name_of(dof.dof);
  }
}

// Statics: what hangs pulls with its weight, and its centre of mass is below what carries it.
TEST_F(LeastEffort, WhatHooksCarryTurnsUntilItHangs) {
  const contact::PreparedHand& hand = hand_on_bone();
  const product::Product thin = cylinder(25.0);
  grasp::PowerGraspOptions hook;
  hook.grip = grasp::Grip::kFixedHook;
  const grasp::Grasp closed = grasp::close_power_grasp(hand.hand(), thin, hook);
  const hand::Skeleton& skeleton = hand.hand().skeleton;
  const Vec3 distal = (skeleton.joint(hand::JointId::kMiddleMcp).centre -
                       skeleton.joint(hand::JointId::kWrist).centre)
                          .normalized();
  const Vec3 below = closed.product_from_hand.rotation * distal;
  const Vec3 across = closed.grip_axis.cross(below).normalized();
  for (const double weight : {4.0, 20.0, 60.0}) {
    for (const double aside : {-30.0, 0.0, 30.0}) {  // mm
      grasp::EffortTask task{.measure = grasp::EffortMeasure::kHang,
                             .hangs_at = closed.grip_point + 100.0 * below + aside * across,
                             .force = weight};
      task.takes_part.setZero();
      for (int s = static_cast<int>(hand::Segment::kIndexProximal); s < hand::kSegmentCount; ++s) {
        task.takes_part[s - 1] = 1.0;
      }
      const grasp::EffortRest found = grasp::rest_with_least_effort(
          hand, thin, {closed.posture, closed.product_from_hand}, task, {});
      ASSERT_EQ(found.status, grasp::EffortRest::Status::kSolved);
      const contact::Wrench carried = wrench_on_bar(hand, thin, found);
      EXPECT_NEAR(carried.force.norm(), weight, 0.02 * weight) << aside;
      const Vec3 moment = carried.moment - task.hangs_at.cross(carried.force);
      EXPECT_LT(moment.norm(), weight * 1.0) << weight << " N, " << aside << " mm";
      EXPECT_LT((found.force_on_product - carried.force).norm(), 0.02 * weight) << aside;
    }
  }
}

TEST_F(LeastEffort, FrictionDragsTheProductAlongWithTheSkinAndKeepsItsBound) {
  const grasp::EffortRest found = rest(90.0);
  const contact::ContactResult contact =
      contact::solve_hand_contact(prepared(), hand::pose_skin(hand(), found.state.posture),
                                  found.state.product_from_hand, *bar().distance);
  const std::vector<Vec3> start = hand::pose_skin(hand(), found.start.posture);
  const std::vector<int> loaded = contact::loaded_vertices(contact);
  const std::vector<Vec3> normals = contact::contact_normals(contact, *bar().distance, loaded);
  double power = 0.0, most = 0.0;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const auto v = static_cast<std::size_t>(loaded[k]);
    const Vec3& friction = found.friction_force[v];
    EXPECT_LE(friction.norm(), 0.5 * contact.force[v] * 1.01 + 1e-6);
    EXPECT_NEAR(friction.dot(normals[k]), 0.0, 1e-3 * contact.force[v] + 1e-6);
    const Vec3 way = contact.undeformed[v] - found.start.product_from_hand * start[v];
    power += friction.dot(way);
    most += friction.norm() * (way - way.dot(normals[k]) * normals[k]).norm();
  }
  EXPECT_GT(power, 0.99 * most);
  EXPECT_GT(most, 0.0);
}

TEST_F(LeastEffort, FirmerGripsTakeMoreEffortAndTouchMore) {
  double effort = 0.0, sum = 0.0;
  for (const double grip_force : {30.0, 90.0}) {
    const grasp::EffortRest found = rest(grip_force);
    EXPECT_GT(found.activation.array().cube().sum(), effort) << grip_force;
    EXPECT_GT(found.grip.sum_of_normals, sum) << grip_force;
    effort = found.activation.array().cube().sum();
    sum = found.grip.sum_of_normals;
  }
}

/// Force of each digit and of the palm on a bar, N.
std::array<double, hand::kFingerCount + 1> forces_on_bar(const contact::PreparedHand& prepared,
                                                         double diameter, double grip_force) {
  const product::Product bar = product::make_cylinder_product(
      {.diameter = diameter, .length = 150.0, .fineness = {.chordal_error = 0.02}});
  const grasp::Grasp closed = grasp::close_power_grasp(prepared.hand(), bar);
  const grasp::EffortRest rest = grasp::rest_with_least_effort(
      prepared, bar, {closed.posture, closed.product_from_hand}, {.force = grip_force}, {});
  EXPECT_LT(rest.missing.lpNorm<Eigen::Infinity>(), 0.02 * rest.strongest_moment) << diameter;
  const contact::ContactResult contact =
      contact::solve_hand_contact(prepared, hand::pose_skin(prepared.hand(), rest.state.posture),
                                  rest.state.product_from_hand, *bar.distance);
  std::array<double, hand::kFingerCount + 1> force{};
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    const auto finger = hand::finger_of(prepared.hand().segment[v]);
    force[finger ? palmar::index_of(*finger) : hand::kFingerCount] += contact.force[v];
  }
  return force;
}

// Until November 2026 three states alternated from 57 to 63 mm, in two of which the index finger
// carried nothing.
TEST_F(LeastEffort, BarsThatDifferALittleAreHeldALittleDifferently) {
  std::array<double, hand::kFingerCount + 1> last{};
  for (const double diameter : {61.0, 62.0, 63.0}) {
    const auto force = forces_on_bar(prepared(), diameter, 107.0);
    double sum = 0.0;
    for (const double one : force) sum += one;
    for (std::size_t k = 0; k < force.size(); ++k) {
      EXPECT_GT(force[k], 0.02 * sum) << diameter << " " << k;
      if (last[0] > 0.0) {
        EXPECT_NEAR(force[k], last[k], 0.02 * sum) << diameter << " " << k;
      }
    }
    last = force;
  }
}

TEST_F(LeastEffort, CarriesALoadThatFrictionCanHold) {
  const Vec3 weight(0.0, 0.0, -10.0);  // N, along the bar
  const grasp::EffortRest found = rest(60.0, {.force = weight});
  ASSERT_EQ(found.status, grasp::EffortRest::Status::kSolved);
  const contact::Wrench held = wrench_on_bar(prepared(), bar(), found);
  EXPECT_LT((held.force + weight).norm(), 0.6);
}

TEST_F(LeastEffort, SameInputGivesTheSameRest) {
  const grasp::EffortRest first = rest(60.0), second = rest(60.0);
  EXPECT_EQ(first.merit, second.merit);
  EXPECT_EQ(first.state.posture.angle, second.state.posture.angle);
  EXPECT_EQ(first.activation, second.activation);
}

// Without friction the contact has an energy: round a small rectangle of two coordinates its forces
// do no work, against what they do along one side.
TEST_F(LeastEffort, ContactForcesDoNoWorkRoundAClosedPath) {
  grasp::ContactForces forces(prepared(), bar(), {}, 0.0, closed());
  const auto force_at = [&](const grasp::GripVector& way) {
    EXPECT_TRUE(forces.look(grasp::moved(closed(), way, Vec3::Zero()), 1e-6));
    grasp::GripVector force = forces.force();
    force.tail<3>() += forces.centre().cross(Vec3(force.segment<3>(grasp::kGripJoints)));
    return force;
  };
  constexpr int kMiddleMcp = 8, kMiddlePip = 10, kShift = grasp::kGripJoints + 1;
  for (const auto& [a, b, step_a, step_b] :
       {std::tuple{kMiddleMcp, kMiddlePip, 0.02, 0.02}, {kMiddlePip, kShift, 0.02, 0.5}}) {
    // Simpson's rule along each side.
    const auto work = [&](grasp::GripVector from, int coordinate, double step) {
      double sum = 0.0;
      for (const double weight : {1.0, 4.0, 1.0}) {
        sum += weight / 6.0 * force_at(from)[coordinate] * step;
        from[coordinate] += 0.5 * step;
      }
      return sum;
    };
    grasp::GripVector at_a = grasp::GripVector::Zero(), at_b = at_a;
    at_a[a] = step_a;
    at_b[b] = step_b;
    const double there = work(grasp::GripVector::Zero(), a, step_a) + work(at_a, b, step_b);
    const double back = work(grasp::GripVector::Zero(), b, step_b) + work(at_b, a, step_a);
    EXPECT_NEAR(there, back, 0.01 * (std::abs(there) + std::abs(back))) << a << " " << b;
  }
}

/// A motion of one coordinate, and how far differences go, mm or rad.
grasp::GripVector one_way(int coordinate, double step) {
  grasp::GripVector way = grasp::GripVector::Zero();
  way[coordinate] = step;
  return way;
}

// Round a thick body the thumb has no room in front of the palm unless it lies nearer to the
// fingers; until November 2026 it met such bodies at their side, and they slipped.
TEST_F(LeastEffort, ThickBarsAreHeldByThumbAndFingersFirmlyAndLightly) {
  for (const double diameter : {90.0, 100.0}) {
    for (const double grip_force : {5.0, 90.0}) {
      const auto force = forces_on_bar(hand_on_bone(), diameter, grip_force);
      double sum = 0.0;
      for (const double one : force) sum += one;
      EXPECT_GT(force[0], 0.15 * sum) << diameter << " " << grip_force;
    }
  }
}

TEST_F(LeastEffort, RoomForTheThumbGrowsWithTheBar) {
  std::optional<Vec3> last;
  double most = 0.0;
  for (double diameter = 80.0; diameter <= 96.0; diameter += 2.0) {
    const product::Product thick = product::make_cylinder_product(
        {.diameter = diameter, .length = 150.0, .fineness = {.chordal_error = 0.02}});
    const grasp::Grasp closed = grasp::close_power_grasp(hand(), thick);
    const Vec3 centre = closed.product_from_hand.inverse() * Vec3(0.0, 0.0, 75.0);
    if (last) most = std::max(most, (centre - *last).norm());
    last = centre;
  }
  EXPECT_LT(most, 4.0);  // mm per 2 mm; half of them are the radius
}

// Contact and friction of a hand at rest: forces with their directions and arms, friction with how
// far it has slid and how deep its region is pressed, skin that turns under the product.
TEST_F(LeastEffort, OnTissueStiffnessIsTheSlopeOfTheForces) {
  const contact::PreparedHand& hand = hand_on_bone();
  const grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), bar());
  const grasp::GripState start{grasp.posture, grasp.product_from_hand};
  const grasp::EffortRest found =
      grasp::rest_with_least_effort(hand, bar(), start, {.force = 90.0}, {});
  grasp::ContactForces forces(hand, bar(), {}, 0.5, start);
  constexpr double kExact = 1e-7;
  ASSERT_TRUE(forces.look(found.state, kExact));
  forces.differentiate();
  const grasp::GripMatrix stiffness = forces.stiffness();
  const Vec3 centre = forces.centre();
  double mean = 0.0;
  for (int c = 0; c < grasp::kGripCoordinates; ++c) {
    const bool is_shift = c >= grasp::kGripJoints && c < grasp::kGripJoints + 3;
    const double step = is_shift ? 0.01 : 2e-4;  // mm, rad
    const auto force_at = [&](double way) {
      EXPECT_TRUE(forces.look(grasp::moved(found.state, one_way(c, way), centre), kExact));
      grasp::GripVector force = forces.force();
      force.tail<3>() +=
          (forces.centre() - centre).cross(Vec3(force.segment<3>(grasp::kGripJoints)));
      return force;
    };
    const grasp::GripVector slope = (force_at(-step) - force_at(step)) / (2.0 * step);
    const auto size = [](grasp::GripVector force) {  // moments count as forces at 30 mm
      force.segment<3>(grasp::kGripJoints) *= 30.0;
      return force.norm();
    };
    const double off = size(stiffness.col(c) - slope) / size(slope);
    EXPECT_LT(off, 0.08) << c;
    mean += off / grasp::kGripCoordinates;
  }
  EXPECT_LT(mean, 0.015);
}

// A change is followed by derivatives: the equilibrium after it is kept to second order.
TEST_F(LeastEffort, WhatFollowsASmallChangeIsAtRestToo) {
  const contact::PreparedHand& hand = hand_on_bone();
  const product::Product product = cylinder(46.0);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), product);
  const grasp::EffortTask task{.force = 100.0};
  const grasp::EffortRest rest = grasp::rest_with_least_effort(
      hand, product, {grasp.posture, grasp.product_from_hand}, task, {});
  ASSERT_LT(rest.missing.segment<3>(grasp::kGripJoints).norm(), 0.5);
  const auto off = [&](const product::Product& changed, double factor) {
    const grasp::GripState state =
        grasp::rest_after_change(hand, product, changed, rest, factor, task, {});
    grasp::ContactForces there(hand, changed, {}, task.friction, rest.start);
    EXPECT_TRUE(there.look(state, 1e-5));
    return std::max(std::abs(there.grip().force / (factor * rest.force) - 1.0),
                    there.force().segment<3>(grasp::kGripJoints).norm() / rest.force);
  };
  // Without following, the force would be off by the whole change.
  EXPECT_LT(off(product, 1.02), 0.005);
  EXPECT_LT(off(product, 0.98), 0.005);
  EXPECT_LT(off(cylinder(46.0 / 1.01), 1.0 / (1.01 * 1.01)), 0.02);
}

// Between 51 and 54 mm the hold goes over from palm and fingers to thumb and fingers.
TEST_F(LeastEffort, ASecondRestIsNamedWhereThereIsOne) {
  const contact::PreparedHand& hand = hand_on_bone();
  const grasp::EffortTask task{.force = 107.0};
  int named = 0;
  for (const double diameter : {52.0, 52.5}) {
    const product::Product product = cylinder(diameter);
    const grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), product);
    const grasp::EffortRest rest = grasp::rest_with_least_effort(
        hand, product, {grasp.posture, grasp.product_from_hand}, task, {});
    const auto other = grasp::other_rest(hand, product, rest, task, {});
    if (!other) continue;
    ++named;
    EXPECT_LT(other->merit.back(), 1.05 * rest.merit.back());
    grasp::ContactForces there(hand, product, {}, task.friction, rest.start);
    ASSERT_TRUE(there.look(other->state, 1e-4));
    EXPECT_NEAR(there.grip().force, 107.0, 1.1);
    EXPECT_LT(there.force().segment<3>(grasp::kGripJoints).norm(), 1.1);
  }
  EXPECT_GT(named, 0);
}

// Round thin bars the thumb lies on the fingers or on the bar.
TEST_F(LeastEffort, TheLowerOfTwoRestsIsTaken) {
  const contact::PreparedHand& hand = hand_on_bone();
  const grasp::EffortTask task{.force = 107.0};
  int lower = 0;
  for (const double diameter : {28.0, 29.0, 30.5}) {
    const product::Product product = cylinder(diameter);
    grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), product);
    const grasp::EffortRest first = grasp::rest_with_least_effort(
        hand, product, {grasp.posture, grasp.product_from_hand}, task, {});
    const auto other = grasp::other_rest(hand, product, first, task, {});
    const bool is_lower = other && other->merit.back() < first.merit.back();
    grasp::BalanceOptions options;
    options.grip_force = 107.0;
    options.looks_beside = true;
    const grasp::Balance balance = grasp::balance_grasp(hand, product, grasp, options);
    EXPECT_EQ(balance.status, grasp::BalanceStatus::kBalanced);
    EXPECT_EQ(grasp.posture.angle, (is_lower ? other->state : first.state).posture.angle);
    lower += is_lower ? 1 : 0;
  }
  EXPECT_GT(lower, 0);
}

// An ellipse of the girth of a circle is turned by its form, too, and not by friction alone.
TEST_F(LeastEffort, AnEllipticHandleTurnsHarderThanARoundOneOfItsGirth) {
  const contact::PreparedHand& hand = hand_on_bone();
  struct Turned {
    double grip = 0.0, sum = 0.0, torque = 0.0;
  };
  // Semi-axes of 25 and 16.6 mm have the girth of a circle of 21 mm, 132 mm.
  const auto turned = [&](double a, double b, double torque) {
    product::Product handle = cylinder(42.0);
    for (Vec3& v : handle.mesh.vertices) v = Vec3(v.x() * a / 21.0, v.y() * b / 21.0, v.z());
    handle.distance = std::make_shared<geometry::MeshDistance>(handle.mesh);
    grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), handle);
    grasp::BalanceOptions options;
    options.turn = torque;
    const grasp::Balance rest = grasp::balance_grasp(hand, handle, grasp, options);
    EXPECT_EQ(rest.status, grasp::BalanceStatus::kBalanced) << rest.message;
    return Turned{rest.grip_force, rest.sum_of_normals, rest.turn.value_or(0.0)};
  };
  constexpr double kTorque = 1500.0;  // N mm
  const Turned round = turned(21.0, 21.0, kTorque), oval = turned(25.0, 16.6, kTorque);
  EXPECT_NEAR(round.torque, kTorque, 0.01 * kTorque);
  EXPECT_NEAR(oval.torque, kTorque, 0.01 * kTorque);
  // What Coulomb asks of a round bar.
  EXPECT_GT(round.sum, kTorque / (0.5 / grasp::kGripMargin * 21.0));
  EXPECT_LT(oval.grip, 0.95 * round.grip);
  constexpr double kTooMuch = 9000.0;
  const double most_round = turned(21.0, 21.0, kTooMuch).torque;
  EXPECT_GT(turned(25.0, 16.6, kTooMuch).torque, 1.2 * most_round);
  EXPECT_GT(most_round, 1500.0);
  EXPECT_LT(most_round, 6000.0);
}

// What is searched on first: near enough that the whole skin finds its rest in a few steps.
TEST_F(LeastEffort, TheCoarseSkinPressesNearlyAsTheWholeSkin) {
  const contact::PreparedHand& hand = hand_on_bone();
  const grasp::Grasp grasp = grasp::close_power_grasp(hand.hand(), bar());
  const grasp::GripState state{grasp.posture, grasp.product_from_hand};
  grasp::ContactForces whole(hand, bar(), {}, 0.5, state);
  grasp::ContactForces coarse(hand.coarse().prepared, bar(), {}, 0.5, state);
  ASSERT_TRUE(whole.look(state, 1e-4));
  ASSERT_TRUE(coarse.look(state, 1e-4));
  const double sum = whole.grip().sum_of_normals;
  EXPECT_NEAR(coarse.grip().sum_of_normals, sum, 0.08 * sum);
  EXPECT_LT((coarse.centre() - whole.centre()).norm(), 2.0);
  EXPECT_LT(
      (coarse.force().head<grasp::kGripJoints>() - whole.force().head<grasp::kGripJoints>()).norm(),
      0.1 * whole.force().head<grasp::kGripJoints>().norm());
}

TEST_F(LeastEffort, RatesOfTheGapsAreTheirSlopes) {
  const hand::Hand& coarse = prepared().coarse().prepared.hand();
  grasp::VolarGaps gaps(prepared(), bar());
  grasp::GripState state = closed();
  for (int k = 0; k < hand::kDigitDofs; ++k) state.posture[grasp::grip_dof(k)] -= 0.1;
  const Vec3 centre(10.0, 50.0, 20.0);
  const auto gaps_at = [&](const grasp::GripState& at) {
    return gaps.look(at, hand::pose_skin(coarse, at.posture));
  };
  gaps_at(state);
  const grasp::VolarRates rates = gaps.rates(state, hand::pose_skin(coarse, state.posture), centre);
  constexpr double kStep = 1e-3;
  for (int c = 0; c < grasp::kGripCoordinates; ++c) {
    const grasp::VolarVector slope = (gaps_at(grasp::moved(state, one_way(c, kStep), centre)) -
                                      gaps_at(grasp::moved(state, one_way(c, -kStep), centre))) /
                                     (2.0 * kStep);
    EXPECT_LT((rates.col(c) - slope).norm(), 0.02 * slope.norm() + 1e-3) << c;
  }
}

// What thumb and fingers do to each other has an energy, sum N D / 5 for N that grows with the
// fourth power of D: moments are its slopes, stiffness theirs.
TEST_F(LeastEffort, DigitsThatMeetPressLikeSomethingElastic) {
  const grasp::DigitMeeting meeting(hand(), hand::reference_posture(hand().skeleton));
  hand::Posture met = closed().posture;
  for (int k = 0; k < hand::kDigitDofs; ++k) {
    const hand::JointDof& dof = hand().skeleton.dof(grasp::grip_dof(k));
    met[dof.dof] = dof.lower + 0.8 * (dof.upper - dof.lower);
  }
  const auto energy = [&](const hand::Posture& posture) {
    double sum = 0.0;
    for (const grasp::DigitPress& press : meeting.presses(posture)) {
      sum += press.force * press.overlap / 5.0;
    }
    return sum;
  };
  const auto moments = [&](const hand::Posture& posture) {
    grasp::GripVector sum = grasp::GripVector::Zero();
    for (const grasp::DigitPress& press : meeting.presses(posture)) {
      sum += press.force * press.moment;
    }
    return sum;
  };
  const grasp::GripVector moment = moments(met);
  const grasp::GripMatrix stiffness = meeting.stiffness(met);
  ASSERT_GT(moment.norm(), 10.0);  // N mm
  constexpr double kStep = 1e-4;
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    hand::Posture more = met, less = met;
    more[grasp::grip_dof(j)] += kStep;
    less[grasp::grip_dof(j)] -= kStep;
    EXPECT_NEAR(moment[j], (energy(less) - energy(more)) / (2.0 * kStep), 0.03 * moment.norm())
        << j;
    EXPECT_LT((stiffness.col(j) - (moments(less) - moments(more)) / (2.0 * kStep)).norm(),
              0.02 * stiffness.norm())
        << j;
  }
}

// A finger bent to the ends of its ranges has its tip in the palm, which opens it again.
TEST_F(LeastEffort, ThePalmHoldsAFingertipOff) {
  const hand::Posture open = hand::reference_posture(hand().skeleton);
  const grasp::DigitMeeting meeting(hand(), open);
  EXPECT_TRUE(meeting.presses(open).empty());
  hand::Posture bent = open;
  const auto dofs = hand::digit_dofs(hand::Finger::kMiddle);
  for (const hand::Dof dof : {dofs[0], dofs[2], dofs[3]}) {
    bent[dof] = hand().skeleton.dof(dof).upper;
  }
  grasp::GripVector moment = grasp::GripVector::Zero();
  for (const grasp::DigitPress& press : meeting.presses(bent)) {
    moment += press.force * press.moment;
  }
  for (int j = 0; j < grasp::kGripJoints; ++j) {
    if (grasp::grip_dof(j) == dofs[2]) EXPECT_LT(moment[j], -10.0);  // N mm
  }
}

}  // namespace
}  // namespace palmar::tests
