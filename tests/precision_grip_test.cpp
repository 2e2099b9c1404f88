// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Precision grips of the template hand. Stands here because reading the hand's asset does not
// belong to what the grasp module may include.
#include "palmar/grasp/precision/precision_grip.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/power/finger_motion.h"
#include "palmar/grasp/precision/fingertip_ik.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/primitives.h"
#include "palmar/records/product/product_file.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

product::Product of_mesh(geometry::TriangleMesh mesh, const std::string& name) {
  product::Product product;
  product.name = name;
  product.mesh = std::move(mesh);
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  return product;
}

/// A small bottle stopper, say: no symmetry but one plane, so that the best place is one place.
product::Product wedge() {
  geometry::TriangleMesh mesh = geometry::make_box({24.0, 60.0, 36.0}, 10);
  for (Vec3& v : mesh.vertices) {
    const double t = v.y() / 60.0 + 0.5;
    v.x() *= 0.7 + 0.3 * t;
    v.z() = v.z() * (0.8 + 0.2 * t) + 6.0 * t * t;
  }
  return of_mesh(std::move(mesh), "wedge");
}

product::Product moved(const product::Product& product, const geometry::Rigid3& motion) {
  geometry::TriangleMesh mesh = product.mesh;
  for (Vec3& v : mesh.vertices) v = motion * v;
  return of_mesh(std::move(mesh), product.name);
}

product::Product mirrored_product(const product::Product& product) {
  geometry::TriangleMesh mesh = product.mesh;
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return of_mesh(std::move(mesh), product.name);
}

product::Product cylinder(double diameter, double length) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = length;
  return product::make_cylinder_product(options);
}

grasp::Grasp close(const hand::Hand& hand, const product::Product& product, grasp::Grip grip,
                   std::vector<grasp::FingertipTarget> targets = {}) {
  grasp::PrecisionGripOptions options;
  options.grip = grip;
  options.targets = std::move(targets);
  return grasp::close_precision_grip(hand, product, options);
}

std::string message_of(const hand::Hand& hand, const product::Product& product,
                       const grasp::PrecisionGripOptions& options) {
  try {
    grasp::close_precision_grip(hand, product, options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

/// Deepest skin of a segment in the product, from the whole posed skin.
double deepest(const hand::Hand& hand, const product::Product& product, const grasp::Grasp& grasp,
               hand::Segment segment) {
  const std::vector<Vec3> skin = hand::pose_skin(hand, grasp.posture);
  double depth = -1e9;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.segment[v] != segment) continue;
    depth = std::max(depth, -product.distance->at(grasp.product_from_hand * skin[v]).distance);
  }
  return depth;
}

hand::Posture random_posture(const hand::Skeleton& skeleton, std::mt19937& random) {
  hand::Posture posture = hand::reference_posture(skeleton);
  for (int d = static_cast<int>(hand::Dof::kThumbCmcFlexion); d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = skeleton.dof(static_cast<hand::Dof>(d));
    std::uniform_real_distribution<double> angle(dof.lower, dof.upper);
    posture[dof.dof] = angle(random);
  }
  return posture;
}

/// Where a fingertip point is by the skin itself.
Vec3 on_skin(const hand::Hand& hand, const grasp::FingertipPoint& tip,
             const hand::Posture& posture) {
  const std::vector<Vec3> corner =
      hand::pose_skin_vertices(hand, posture, {tip.triangle[0], tip.triangle[1], tip.triangle[2]});
  return tip.weight[0] * corner[0] + tip.weight[1] * corner[1] + tip.weight[2] * corner[2];
}

using FingertipKinematics = TemplateTest;

TEST_F(FingertipKinematics, DerivativesAreThoseOfThePosedSkeleton) {
  const hand::Skeleton& skeleton = hand().skeleton;
  std::mt19937 random(7);
  constexpr double kStep = 1e-5;  // rad
  for (int sample = 0; sample < 10; ++sample) {
    const hand::Posture posture = random_posture(skeleton, random);
    const grasp::FingerMotion motion(skeleton, posture);
    for (int s = 1; s < hand::kSegmentCount; ++s) {
      const auto segment = static_cast<hand::Segment>(s);
      const Vec3 at(12.0, 150.0, 25.0);  // any point, carried along
      for (const grasp::DofMotion& column : motion.moving(segment)) {
        hand::Posture up = posture, down = posture;
        up[column.dof] += kStep;
        down[column.dof] -= kStep;
        const auto k = static_cast<std::size_t>(s);
        const Vec3 x = motion.posed().segment[k] * at;
        const Vec3 numeric = (hand::pose_skeleton(skeleton, up).segment[k] * at -
                              hand::pose_skeleton(skeleton, down).segment[k] * at) /
                             (2.0 * kStep);
        // Second-order differences of arms of 200 mm: 200 * step^2 and rounding.
        EXPECT_LT((column.of_point(x) - numeric).norm(), 1e-5)
            << name_of(segment) << " " << name_of(column.dof);
      }
    }
  }
}

TEST_F(FingertipKinematics, FingertipPointsLieOnTheSkinOfTheirPhalanx) {
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    for (const grasp::FingertipPart part :
         {grasp::FingertipPart::kPad, grasp::FingertipPart::kTip}) {
      const grasp::FingertipPoint tip = grasp::fingertip_point(hand(), finger, part);
      SCOPED_TRACE(std::string(name_of(finger)) + " " + std::string(name_of(part)));
      const hand::Posture reference = hand::reference_posture(hand().skeleton);
      EXPECT_LT((on_skin(hand(), tip, reference) - tip.point).norm(), 1e-9);
      EXPECT_LT((tip.point - hand().skeleton.fingertips[static_cast<std::size_t>(f)]).norm(), 25.0);
      if (finger != hand::Finger::kThumb) {
        EXPECT_GT(tip.normal.z(), 0.3);
      }  // palmar
    }
  }
}

TEST_F(FingertipKinematics, LeftHandHasTheMirroredPoints) {
  const hand::Hand left = hand::mirrored(hand());
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (const grasp::FingertipPart part : {grasp::FingertipPart::kPad, grasp::FingertipPart::kTip,
                                            grasp::FingertipPart::kRadialSide}) {
      if (f == 0 && part == grasp::FingertipPart::kRadialSide) continue;
      const grasp::FingertipPoint a =
          grasp::fingertip_point(hand(), static_cast<hand::Finger>(f), part);
      const grasp::FingertipPoint b =
          grasp::fingertip_point(left, static_cast<hand::Finger>(f), part);
      EXPECT_LT((Vec3(-a.point.x(), a.point.y(), a.point.z()) - b.point).norm(), 1e-9);
      EXPECT_LT((Vec3(-a.normal.x(), a.normal.y(), a.normal.z()) - b.normal).norm(), 1e-9);
    }
  }
}

TEST_F(FingertipKinematics, PointsMadeByAnotherPostureAreReached) {
  std::mt19937 random(3);
  const grasp::FingertipIk ik(hand());
  const hand::Posture relaxed = *hand::named_posture(hand().skeleton, "relaxed");
  int reached = 0;
  constexpr int kSamples = 40;
  for (int sample = 0; sample < kSamples; ++sample) {
    // Fingers anywhere in their ranges, the hand turned by up to 30 degrees.
    const hand::Posture truth = random_posture(hand().skeleton, random);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    geometry::Rigid3 placed;
    placed.rotation = Quat(Eigen::AngleAxisd(
        0.5 * part(random), Vec3(part(random), part(random), part(random)).normalized()));
    placed.translation = 20.0 * Vec3(part(random), part(random), part(random));
    grasp::FingertipProblem problem;
    problem.natural = relaxed;
    problem.start = relaxed;
    problem.max_iterations = 240;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      grasp::FingertipGoal& goal = problem.goals.emplace_back();
      goal.fingertip =
          grasp::fingertip_point(hand(), static_cast<hand::Finger>(f), grasp::FingertipPart::kPad);
      goal.point = placed * on_skin(hand(), goal.fingertip, truth);
    }
    const grasp::FingertipSolution solution = ik.solve(problem);
    EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, solution.posture).clamped.empty());
    for (std::size_t k = 0; k < problem.goals.size(); ++k) {
      // The claim is about skin, not about the rigid phalanx that the solver moves.
      const Vec3 skin = solution.product_from_hand *
                        on_skin(hand(), problem.goals[k].fingertip, solution.posture);
      EXPECT_LT((skin - solution.reached[k]).norm(), 0.05);
    }
    if (solution.worst_miss < 1.0) ++reached;
  }
  // Random postures may have crossed fingers among them, which the solver refuses.
  EXPECT_GE(reached, kSamples * 19 / 20);
}

using PrecisionGrip = TemplateTest;

TEST_F(PrecisionGrip, TripodHoldsABarWithThreePadsPressedIn) {
  const product::Product bar = cylinder(18.0, 110.0);
  const grasp::Grasp grasp = close(hand(), bar, grasp::Grip::kTripod);
  ASSERT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  ASSERT_EQ(grasp.fingertips.size(), 3u);
  for (const hand::Segment segment :
       {hand::Segment::kThumbDistal, hand::Segment::kIndexDistal, hand::Segment::kMiddleDistal}) {
    EXPECT_NEAR(deepest(hand(), bar, grasp, segment), 2.0, 0.1) << name_of(segment);
  }
  for (const hand::Segment segment :
       {hand::Segment::kPalm, hand::Segment::kRingDistal, hand::Segment::kLittleDistal,
        hand::Segment::kIndexProximal, hand::Segment::kThumbProximal}) {
    EXPECT_LT(deepest(hand(), bar, grasp, segment), 0.5) << name_of(segment);
  }
  // The thumb presses from the other side.
  const Vec3 push = grasp.fingertips[1].normal + grasp.fingertips[2].normal;
  EXPECT_LT(grasp.fingertips[0].normal.dot(push.normalized()), -0.8);
  EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, grasp.posture).clamped.empty());
  EXPECT_GE(grasp.runners_up.size(), 1u);
  EXPECT_LE(grasp.runners_up.front().score, grasp.score + 1e-6);  // ties by rounding
  EXPECT_GE(grasp.candidates, 200);
}

TEST_F(PrecisionGrip, EveryGripHoldsSomethingMadeForIt) {
  struct Case {
    grasp::Grip grip;
    product::Product product;
    std::size_t fingers;
  };
  product::SphereProductOptions ball;
  ball.diameter = 60.0;
  product::SphereProductOptions bead;
  bead.diameter = 9.0;
  const std::vector<Case> cases = {
      {grasp::Grip::kTipPinch, product::make_sphere_product(bead), 2},
      {grasp::Grip::kPalmarPinch, of_mesh(geometry::make_box({50.0, 30.0, 10.0}, 12), "tablet"), 2},
      {grasp::Grip::kLateral, of_mesh(geometry::make_box({22.0, 55.0, 4.0}, 16), "key"), 2},
      {grasp::Grip::kPrecisionSphere, product::make_sphere_product(ball), 5}};
  for (const Case& one : cases) {
    SCOPED_TRACE(std::string(name_of(one.grip)));
    const grasp::Grasp grasp = close(hand(), one.product, one.grip);
    EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
    EXPECT_EQ(grasp.grip, one.grip);
    ASSERT_EQ(grasp.fingertips.size(), one.fingers);
    for (const grasp::FingertipContact& tip : grasp.fingertips) {
      EXPECT_LT(tip.miss, 1.0) << name_of(tip.finger);
      EXPECT_LT(std::abs(one.product.distance->at(tip.target).distance), 0.01);
    }
  }
}

TEST_F(PrecisionGrip, PadsArePressedOnThinThingsAsOnThickOnes) {
  // A pad flattens on a card as it does on a box; only the flesh beyond knows what is behind it.
  for (const double thickness : {0.8, 12.0}) {
    const product::Product card = of_mesh(geometry::make_box({85.0, 54.0, thickness}, 24), "card");
    const grasp::Grasp grasp = close(hand(), card, grasp::Grip::kPalmarPinch);
    ASSERT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
    for (const hand::Segment segment : {hand::Segment::kThumbDistal, hand::Segment::kIndexDistal}) {
      EXPECT_NEAR(grasp.stops[static_cast<std::size_t>(segment)].penetration, 2.0, 0.1)
          << name_of(segment) << " " << thickness;
    }
  }
}

TEST_F(PrecisionGrip, FiveFingertipsHaveNoRoomOnABead) {
  product::SphereProductOptions bead;
  bead.diameter = 4.0;
  const grasp::Grasp grasp =
      close(hand(), product::make_sphere_product(bead), grasp::Grip::kPrecisionSphere);
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kTooSmall);
  EXPECT_THAT(grasp.message, HasSubstr("in each other"));
}

TEST_F(PrecisionGrip, WhatNoHandSpansIsNotGraspable) {
  const product::Product block = of_mesh(geometry::make_box({220.0, 230.0, 240.0}, 6), "block");
  const grasp::Grasp grasp = close(hand(), block, grasp::Grip::kPalmarPinch);
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kNotGraspable);
  EXPECT_THAT(grasp.message, HasSubstr("span"));
  EXPECT_GT(-deepest(hand(), block, grasp, hand::Segment::kPalm), 10.0);  // shown beside it
}

TEST_F(PrecisionGrip, LeftHandHoldsTheMirroredProductMirrored) {
  const product::Product right = wedge(), left = mirrored_product(right);
  const grasp::Grasp a = close(hand(), right, grasp::Grip::kTripod);
  const grasp::Grasp b = close(hand::mirrored(hand()), left, grasp::Grip::kTripod);
  EXPECT_EQ(a.status, b.status);
  EXPECT_NEAR(a.score, b.score, 1e-4);
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    EXPECT_NEAR(a.posture[dof], b.posture[dof], 0.2 * kDeg) << name_of(dof);
  }
  for (std::size_t k = 0; k < a.fingertips.size(); ++k) {
    const Vec3& p = a.fingertips[k].reached;
    EXPECT_LT((Vec3(-p.x(), p.y(), p.z()) - b.fingertips[k].reached).norm(), 0.2);
  }
}

TEST_F(PrecisionGrip, TurnedProductIsHeldTheSameWay) {
  const product::Product still = wedge();
  geometry::Rigid3 motion;
  motion.rotation = Quat(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.52).normalized()));
  motion.translation = {40.0, -25.0, 300.0};
  const product::Product turned = moved(still, motion);
  const grasp::Grasp a = close(hand(), still, grasp::Grip::kPalmarPinch);
  const grasp::Grasp b = close(hand(), turned, grasp::Grip::kPalmarPinch);
  EXPECT_NEAR(a.score, b.score, 1e-4);
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    EXPECT_NEAR(a.posture[dof], b.posture[dof], 0.2 * kDeg) << name_of(dof);
  }
  const geometry::Rigid3 expected = motion * a.product_from_hand;
  EXPECT_LT((expected.translation - b.product_from_hand.translation).norm(), 0.5);
  EXPECT_LT(expected.rotation.angularDistance(b.product_from_hand.rotation), 0.2 * kDeg);
  // Given points move along, too.
  std::vector<grasp::FingertipTarget> targets, moved_targets;
  for (const grasp::FingertipContact& tip : a.fingertips) {
    targets.push_back({tip.finger, tip.target});
    moved_targets.push_back({tip.finger, motion * tip.target});
  }
  const grasp::Grasp c = close(hand(), still, grasp::Grip::kPalmarPinch, targets);
  const grasp::Grasp d = close(hand(), turned, grasp::Grip::kPalmarPinch, moved_targets);
  EXPECT_EQ(c.status, grasp::GraspStatus::kHeld) << c.message;
  EXPECT_NEAR(c.score, d.score, 1e-3);
  EXPECT_LT(((motion * c.product_from_hand).translation - d.product_from_hand.translation).norm(),
            0.5);
}

TEST_F(PrecisionGrip, GivenPointsAreReachedWithinAMillimetre) {
  const product::Product bar = cylinder(20.0, 100.0);
  const grasp::Grasp grasp = close(hand(), bar, grasp::Grip::kTripod,
                                   {{hand::Finger::kThumb, {0.0, -10.0, 2.0}},
                                    {hand::Finger::kIndex, {1.5, 9.89, 10.0}},
                                    {hand::Finger::kMiddle, {-1.5, 9.89, -9.0}}});
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  for (const grasp::FingertipContact& tip : grasp.fingertips) {
    EXPECT_LT(tip.miss, 1.0) << name_of(tip.finger);
  }
}

TEST_F(PrecisionGrip, FingerThatCannotReachIsNamedWithItsMiss) {
  const product::Product bar = cylinder(20.0, 400.0);
  const grasp::Grasp grasp = close(hand(), bar, grasp::Grip::kTripod,
                                   {{hand::Finger::kThumb, {0.0, -10.0, 0.0}},
                                    {hand::Finger::kIndex, {0.0, 10.0, 8.0}},
                                    {hand::Finger::kMiddle, {0.0, 10.0, -190.0}}});
  EXPECT_NE(grasp.status, grasp::GraspStatus::kHeld);
  EXPECT_THAT(grasp.message, HasSubstr("misses its point by"));
  double worst = 0.0;
  for (const grasp::FingertipContact& tip : grasp.fingertips) worst = std::max(worst, tip.miss);
  EXPECT_GT(worst, 10.0);
}

TEST_F(PrecisionGrip, BadPointsAreRefusedByName) {
  const product::Product bar = cylinder(20.0, 100.0);
  grasp::PrecisionGripOptions options;
  options.grip = grasp::Grip::kPalmarPinch;
  options.targets = {{hand::Finger::kThumb, {0.0, -10.0, 0.0}},
                     {hand::Finger::kIndex, {0.0, 16.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options),
              HasSubstr("index finger (0, 16, 0 mm) is 6.0 mm off"));
  options.targets[1].point = {0.0, 5.0, 0.0};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("5.0 mm below the surface"));
  options.targets[1] = {hand::Finger::kThumb, {0.0, 10.0, 0.0}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("the thumb has two"));
  options.targets = {{hand::Finger::kIndex, {0.0, 10.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("there is none for the thumb"));
  options.targets = {{hand::Finger::kRing, {0.0, 10.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options),
              HasSubstr("ring finger takes no part in grip palmar_pinch"));
  options.targets = {{hand::Finger::kThumb, {0.0, std::nan(""), 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("not finite"));
  options.targets.clear();
  options.fingertip_depth = 9.0;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("fingertip depth is 9 mm"));
  options.fingertip_depth = 2.0;
  options.grip = grasp::Grip::kMediumWrap;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("medium_wrap is no precision grip"));
  options.grip = grasp::Grip::kTripod;
  options.placement.turn = 1.0;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("turn"));
}

TEST_F(PrecisionGrip, MarkerIsTakenNearItsEndAndDriveNearItsMiddle) {
  const std::string folder = PALMAR_SHARED_DIR "/products/";
  if (!std::filesystem::exists(folder + "large_marker.obj")) {
    GTEST_SKIP() << "the products are not there: " << folder;
  }
  const product::Product marker = records::load_product(
      folder + "large_marker.obj", {.unit = geometry::LengthUnit::kMillimetre});
  const grasp::Grasp pen = close(hand(), marker, grasp::Grip::kTripod);
  EXPECT_EQ(pen.status, grasp::GraspStatus::kHeld) << pen.message;
  const Box3 box = marker.distance->bounding_box();
  const double from_middle = std::abs(pen.grip_point.y() - box.center().y()) / box.sizes().y();
  EXPECT_GT(from_middle, 0.1);
  EXPECT_LT(from_middle, 0.4);
}

}  // namespace
}  // namespace palmar::tests
