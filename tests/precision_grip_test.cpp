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

namespace palmar {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

Product of_mesh(TriangleMesh mesh, const std::string& name) {
  Product product;
  product.name = name;
  product.mesh = std::move(mesh);
  product.distance = std::make_shared<MeshDistance>(product.mesh);
  return product;
}

/// A small bottle stopper, say: no symmetry but one plane, so that the best place is one place.
Product wedge() {
  TriangleMesh mesh = make_box({24.0, 60.0, 36.0}, 10);
  for (Vec3& v : mesh.vertices) {
    const double t = v.y() / 60.0 + 0.5;
    v.x() *= 0.7 + 0.3 * t;
    v.z() = v.z() * (0.8 + 0.2 * t) + 6.0 * t * t;
  }
  return of_mesh(std::move(mesh), "wedge");
}

Product moved(const Product& product, const Rigid3& motion) {
  TriangleMesh mesh = product.mesh;
  for (Vec3& v : mesh.vertices) v = motion * v;
  return of_mesh(std::move(mesh), product.name);
}

Product mirrored_product(const Product& product) {
  TriangleMesh mesh = product.mesh;
  for (Vec3& v : mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return of_mesh(std::move(mesh), product.name);
}

Product cylinder(double diameter, double length) {
  CylinderProductOptions options;
  options.diameter = diameter;
  options.length = length;
  return make_cylinder_product(options);
}

Grasp close(const Hand& hand, const Product& product, Grip grip,
            std::vector<FingertipTarget> targets = {}) {
  PrecisionGripOptions options;
  options.grip = grip;
  options.targets = std::move(targets);
  return close_precision_grip(hand, product, options);
}

std::string message_of(const Hand& hand, const Product& product,
                       const PrecisionGripOptions& options) {
  try {
    close_precision_grip(hand, product, options);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

/// Deepest skin of a segment in the product, from the whole posed skin.
double deepest(const Hand& hand, const Product& product, const Grasp& grasp, Segment segment) {
  const std::vector<Vec3> skin = pose_skin(hand, grasp.posture);
  double depth = -1e9;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.segment[v] != segment) continue;
    depth = std::max(depth, -product.distance->at(grasp.product_from_hand * skin[v]).distance);
  }
  return depth;
}

Posture random_posture(const Skeleton& skeleton, std::mt19937& random) {
  Posture posture = reference_posture(skeleton);
  for (int d = static_cast<int>(Dof::kThumbCmcFlexion); d < kDofCount; ++d) {
    const JointDof& dof = skeleton.dof(static_cast<Dof>(d));
    std::uniform_real_distribution<double> angle(dof.lower, dof.upper);
    posture[dof.dof] = angle(random);
  }
  return posture;
}

/// Where a fingertip point is by the skin itself.
Vec3 on_skin(const Hand& hand, const FingertipPoint& tip, const Posture& posture) {
  const std::vector<Vec3> corner =
      pose_skin_vertices(hand, posture, {tip.triangle[0], tip.triangle[1], tip.triangle[2]});
  return tip.weight[0] * corner[0] + tip.weight[1] * corner[1] + tip.weight[2] * corner[2];
}

using FingertipKinematics = TemplateTest;

TEST_F(FingertipKinematics, DerivativesAreThoseOfThePosedSkeleton) {
  const Skeleton& skeleton = hand().skeleton;
  std::mt19937 random(7);
  constexpr double kStep = 1e-5;  // rad
  for (int sample = 0; sample < 10; ++sample) {
    const Posture posture = random_posture(skeleton, random);
    const FingerMotion motion(skeleton, posture);
    for (int s = 1; s < kSegmentCount; ++s) {
      const auto segment = static_cast<Segment>(s);
      const Vec3 at(12.0, 150.0, 25.0);  // any point, carried along
      for (const DofMotion& column : motion.moving(segment)) {
        Posture up = posture, down = posture;
        up[column.dof] += kStep;
        down[column.dof] -= kStep;
        const auto k = static_cast<std::size_t>(s);
        const Vec3 x = motion.posed().segment[k] * at;
        const Vec3 numeric = (pose_skeleton(skeleton, up).segment[k] * at -
                              pose_skeleton(skeleton, down).segment[k] * at) /
                             (2.0 * kStep);
        // Second-order differences of arms of 200 mm: 200 * step^2 and rounding.
        EXPECT_LT((column.of_point(x) - numeric).norm(), 1e-5)
            << name_of(segment) << " " << name_of(column.dof);
      }
    }
  }
}

TEST_F(FingertipKinematics, FingertipPointsLieOnTheSkinOfTheirPhalanx) {
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    for (const FingertipPart part : {FingertipPart::kPad, FingertipPart::kTip}) {
      const FingertipPoint tip = fingertip_point(hand(), finger, part);
      SCOPED_TRACE(std::string(name_of(finger)) + " " + std::string(name_of(part)));
      const Posture reference = reference_posture(hand().skeleton);
      EXPECT_LT((on_skin(hand(), tip, reference) - tip.point).norm(), 1e-9);
      EXPECT_LT((tip.point - hand().skeleton.fingertips[static_cast<std::size_t>(f)]).norm(), 25.0);
      if (finger != Finger::kThumb) {
        EXPECT_GT(tip.normal.z(), 0.3);
      }  // palmar
    }
  }
}

TEST_F(FingertipKinematics, LeftHandHasTheMirroredPoints) {
  const Hand left = mirrored(hand());
  for (int f = 0; f < kFingerCount; ++f) {
    for (const FingertipPart part :
         {FingertipPart::kPad, FingertipPart::kTip, FingertipPart::kRadialSide}) {
      if (f == 0 && part == FingertipPart::kRadialSide) continue;
      const FingertipPoint a = fingertip_point(hand(), static_cast<Finger>(f), part);
      const FingertipPoint b = fingertip_point(left, static_cast<Finger>(f), part);
      EXPECT_LT((Vec3(-a.point.x(), a.point.y(), a.point.z()) - b.point).norm(), 1e-9);
      EXPECT_LT((Vec3(-a.normal.x(), a.normal.y(), a.normal.z()) - b.normal).norm(), 1e-9);
    }
  }
}

TEST_F(FingertipKinematics, PointsMadeByAnotherPostureAreReached) {
  std::mt19937 random(3);
  const FingertipIk ik(hand());
  const Posture relaxed = *named_posture(hand().skeleton, "relaxed");
  int reached = 0;
  constexpr int kSamples = 40;
  for (int sample = 0; sample < kSamples; ++sample) {
    // Fingers anywhere in their ranges, the hand turned by up to 30 degrees.
    const Posture truth = random_posture(hand().skeleton, random);
    std::uniform_real_distribution<double> part(-1.0, 1.0);
    Rigid3 placed;
    placed.rotation = Quat(Eigen::AngleAxisd(
        0.5 * part(random), Vec3(part(random), part(random), part(random)).normalized()));
    placed.translation = 20.0 * Vec3(part(random), part(random), part(random));
    FingertipProblem problem;
    problem.natural = relaxed;
    problem.start = relaxed;
    problem.max_iterations = 240;
    for (int f = 0; f < kFingerCount; ++f) {
      FingertipGoal& goal = problem.goals.emplace_back();
      goal.fingertip = fingertip_point(hand(), static_cast<Finger>(f), FingertipPart::kPad);
      goal.point = placed * on_skin(hand(), goal.fingertip, truth);
    }
    const FingertipSolution solution = ik.solve(problem);
    EXPECT_TRUE(clamp_to_range(hand().skeleton, solution.posture).clamped.empty());
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
  const Product bar = cylinder(18.0, 110.0);
  const Grasp grasp = close(hand(), bar, Grip::kTripod);
  ASSERT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  ASSERT_EQ(grasp.fingertips.size(), 3u);
  for (const Segment segment :
       {Segment::kThumbDistal, Segment::kIndexDistal, Segment::kMiddleDistal}) {
    EXPECT_NEAR(deepest(hand(), bar, grasp, segment), 2.0, 0.1) << name_of(segment);
  }
  for (const Segment segment : {Segment::kPalm, Segment::kRingDistal, Segment::kLittleDistal,
                                Segment::kIndexProximal, Segment::kThumbProximal}) {
    EXPECT_LT(deepest(hand(), bar, grasp, segment), 0.5) << name_of(segment);
  }
  // The thumb presses from the other side.
  const Vec3 push = grasp.fingertips[1].normal + grasp.fingertips[2].normal;
  EXPECT_LT(grasp.fingertips[0].normal.dot(push.normalized()), -0.8);
  EXPECT_TRUE(clamp_to_range(hand().skeleton, grasp.posture).clamped.empty());
  EXPECT_GE(grasp.runners_up.size(), 1u);
  EXPECT_LE(grasp.runners_up.front().score, grasp.score + 1e-6);  // ties by rounding
  EXPECT_GE(grasp.candidates, 200);
}

TEST_F(PrecisionGrip, EveryGripHoldsSomethingMadeForIt) {
  struct Case {
    Grip grip;
    Product product;
    std::size_t fingers;
  };
  SphereProductOptions ball;
  ball.diameter = 60.0;
  SphereProductOptions bead;
  bead.diameter = 9.0;
  const std::vector<Case> cases = {
      {Grip::kTipPinch, make_sphere_product(bead), 2},
      {Grip::kPalmarPinch, of_mesh(make_box({50.0, 30.0, 10.0}, 12), "tablet"), 2},
      {Grip::kLateral, of_mesh(make_box({22.0, 55.0, 4.0}, 16), "key"), 2},
      {Grip::kPrecisionSphere, make_sphere_product(ball), 5}};
  for (const Case& one : cases) {
    SCOPED_TRACE(std::string(name_of(one.grip)));
    const Grasp grasp = close(hand(), one.product, one.grip);
    EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
    EXPECT_EQ(grasp.grip, one.grip);
    ASSERT_EQ(grasp.fingertips.size(), one.fingers);
    for (const FingertipContact& tip : grasp.fingertips) {
      EXPECT_LT(tip.miss, 1.0) << name_of(tip.finger);
      EXPECT_LT(std::abs(one.product.distance->at(tip.target).distance), 0.01);
    }
  }
}

TEST_F(PrecisionGrip, PadsArePressedOnThinThingsAsOnThickOnes) {
  // A pad flattens on a card as it does on a box; only the flesh beyond knows what is behind it.
  for (const double thickness : {0.8, 12.0}) {
    const Product card = of_mesh(make_box({85.0, 54.0, thickness}, 24), "card");
    const Grasp grasp = close(hand(), card, Grip::kPalmarPinch);
    ASSERT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
    for (const Segment segment : {Segment::kThumbDistal, Segment::kIndexDistal}) {
      EXPECT_NEAR(grasp.stops[static_cast<std::size_t>(segment)].penetration, 2.0, 0.1)
          << name_of(segment) << " " << thickness;
    }
  }
}

TEST_F(PrecisionGrip, FiveFingertipsHaveNoRoomOnABead) {
  SphereProductOptions bead;
  bead.diameter = 4.0;
  const Grasp grasp = close(hand(), make_sphere_product(bead), Grip::kPrecisionSphere);
  EXPECT_EQ(grasp.status, GraspStatus::kTooSmall);
  EXPECT_THAT(grasp.message, HasSubstr("in each other"));
}

TEST_F(PrecisionGrip, WhatNoHandSpansIsNotGraspable) {
  const Product block = of_mesh(make_box({220.0, 230.0, 240.0}, 6), "block");
  const Grasp grasp = close(hand(), block, Grip::kPalmarPinch);
  EXPECT_EQ(grasp.status, GraspStatus::kNotGraspable);
  EXPECT_THAT(grasp.message, HasSubstr("span"));
  EXPECT_GT(-deepest(hand(), block, grasp, Segment::kPalm), 10.0);  // shown beside it
}

TEST_F(PrecisionGrip, LeftHandHoldsTheMirroredProductMirrored) {
  const Product right = wedge(), left = mirrored_product(right);
  const Grasp a = close(hand(), right, Grip::kTripod);
  const Grasp b = close(mirrored(hand()), left, Grip::kTripod);
  EXPECT_EQ(a.status, b.status);
  EXPECT_NEAR(a.score, b.score, 1e-4);
  for (int d = 0; d < kDofCount; ++d) {
    const auto dof = static_cast<Dof>(d);
    EXPECT_NEAR(a.posture[dof], b.posture[dof], 0.2 * kDeg) << name_of(dof);
  }
  for (std::size_t k = 0; k < a.fingertips.size(); ++k) {
    const Vec3& p = a.fingertips[k].reached;
    EXPECT_LT((Vec3(-p.x(), p.y(), p.z()) - b.fingertips[k].reached).norm(), 0.2);
  }
}

TEST_F(PrecisionGrip, TurnedProductIsHeldTheSameWay) {
  const Product still = wedge();
  Rigid3 motion;
  motion.rotation = Quat(Eigen::AngleAxisd(1.1, Vec3(0.3, -0.8, 0.52).normalized()));
  motion.translation = {40.0, -25.0, 300.0};
  const Product turned = moved(still, motion);
  const Grasp a = close(hand(), still, Grip::kPalmarPinch);
  const Grasp b = close(hand(), turned, Grip::kPalmarPinch);
  EXPECT_NEAR(a.score, b.score, 1e-4);
  for (int d = 0; d < kDofCount; ++d) {
    const auto dof = static_cast<Dof>(d);
    EXPECT_NEAR(a.posture[dof], b.posture[dof], 0.2 * kDeg) << name_of(dof);
  }
  const Rigid3 expected = motion * a.product_from_hand;
  EXPECT_LT((expected.translation - b.product_from_hand.translation).norm(), 0.5);
  EXPECT_LT(expected.rotation.angularDistance(b.product_from_hand.rotation), 0.2 * kDeg);
  // Given points move along, too.
  std::vector<FingertipTarget> targets, moved_targets;
  for (const FingertipContact& tip : a.fingertips) {
    targets.push_back({tip.finger, tip.target});
    moved_targets.push_back({tip.finger, motion * tip.target});
  }
  const Grasp c = close(hand(), still, Grip::kPalmarPinch, targets);
  const Grasp d = close(hand(), turned, Grip::kPalmarPinch, moved_targets);
  EXPECT_EQ(c.status, GraspStatus::kHeld) << c.message;
  EXPECT_NEAR(c.score, d.score, 1e-3);
  EXPECT_LT(((motion * c.product_from_hand).translation - d.product_from_hand.translation).norm(),
            0.5);
}

TEST_F(PrecisionGrip, GivenPointsAreReachedWithinAMillimetre) {
  const Product bar = cylinder(20.0, 100.0);
  const Grasp grasp = close(hand(), bar, Grip::kTripod,
                            {{Finger::kThumb, {0.0, -10.0, 2.0}},
                             {Finger::kIndex, {1.5, 9.89, 10.0}},
                             {Finger::kMiddle, {-1.5, 9.89, -9.0}}});
  EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  for (const FingertipContact& tip : grasp.fingertips) {
    EXPECT_LT(tip.miss, 1.0) << name_of(tip.finger);
  }
}

TEST_F(PrecisionGrip, FingerThatCannotReachIsNamedWithItsMiss) {
  const Product bar = cylinder(20.0, 400.0);
  const Grasp grasp = close(hand(), bar, Grip::kTripod,
                            {{Finger::kThumb, {0.0, -10.0, 0.0}},
                             {Finger::kIndex, {0.0, 10.0, 8.0}},
                             {Finger::kMiddle, {0.0, 10.0, -190.0}}});
  EXPECT_NE(grasp.status, GraspStatus::kHeld);
  EXPECT_THAT(grasp.message, HasSubstr("misses its point by"));
  double worst = 0.0;
  for (const FingertipContact& tip : grasp.fingertips) worst = std::max(worst, tip.miss);
  EXPECT_GT(worst, 10.0);
}

TEST_F(PrecisionGrip, BadPointsAreRefusedByName) {
  const Product bar = cylinder(20.0, 100.0);
  PrecisionGripOptions options;
  options.grip = Grip::kPalmarPinch;
  options.targets = {{Finger::kThumb, {0.0, -10.0, 0.0}}, {Finger::kIndex, {0.0, 16.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options),
              HasSubstr("index finger (0, 16, 0 mm) is 6.0 mm off"));
  options.targets[1].point = {0.0, 5.0, 0.0};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("5.0 mm below the surface"));
  options.targets[1] = {Finger::kThumb, {0.0, 10.0, 0.0}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("the thumb has two"));
  options.targets = {{Finger::kIndex, {0.0, 10.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("there is none for the thumb"));
  options.targets = {{Finger::kRing, {0.0, 10.0, 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options),
              HasSubstr("ring finger takes no part in grip palmar_pinch"));
  options.targets = {{Finger::kThumb, {0.0, std::nan(""), 0.0}}};
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("not finite"));
  options.targets.clear();
  options.fingertip_depth = 9.0;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("fingertip depth is 9 mm"));
  options.fingertip_depth = 2.0;
  options.grip = Grip::kMediumWrap;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("medium_wrap is no precision grip"));
  options.grip = Grip::kTripod;
  options.placement.turn = 1.0;
  EXPECT_THAT(message_of(hand(), bar, options), HasSubstr("turn"));
}

TEST_F(PrecisionGrip, MarkerIsTakenNearItsEndAndDriveNearItsMiddle) {
  const std::string folder = PALMAR_SHARED_DIR "/products/";
  if (!std::filesystem::exists(folder + "large_marker.obj")) {
    GTEST_SKIP() << "the products are not there: " << folder;
  }
  const Product marker =
      load_product(folder + "large_marker.obj", {.unit = LengthUnit::kMillimetre});
  const Grasp pen = close(hand(), marker, Grip::kTripod);
  EXPECT_EQ(pen.status, GraspStatus::kHeld) << pen.message;
  const Box3 box = marker.distance->bounding_box();
  const double from_middle = std::abs(pen.grip_point.y() - box.center().y()) / box.sizes().y();
  EXPECT_GT(from_middle, 0.1);
  EXPECT_LT(from_middle, 0.4);
}

}  // namespace
}  // namespace palmar
