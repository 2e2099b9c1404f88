// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Grips of two rings, hands that rest and fingers that push, on the template hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "holds/solid_shapes.h"
#include "holds/tried_products.h"
#include "palmar/contact/contact.h"
#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/precision/laid_hand.h"
#include "palmar/grasp/precision/ring_targets.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/posture/named_postures.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/intake/make_product.h"
#include "template_fixture.h"

namespace palmar {
namespace {

class RingsRestsPushes : public TemplateTest {
 protected:
  static const PreparedHand& prepared() {
    static const PreparedHand ready(std::make_shared<Hand>(hand()));
    return ready;
  }
};

// A box that stands on z = -height, its top at z = 0.
Product box_of(const std::string& name, double length, double width, double height) {
  const Vec3 size(length, width, height);
  const Box3 box(Vec3(-0.5 * length, -0.5 * width, -height), Vec3(0.5 * length, 0.5 * width, 0.0));
  const TriangleMesh mesh =
      net_mesh_of(sdf_rounded_box(Vec3(0, 0, -0.5 * height), size, 1.0), {box, Vec3(5, 5, 5), {}});
  return make_product(name, mesh, UnitDecision{}, "made for a test");
}

// Whether the line of a bone passes through an opening: crosses its plane within its disc.
bool passes_through(const PartOpening& opening, const Vec3& from, const Vec3& to) {
  const double a = opening.axis.dot(from - opening.centre);
  const double b = opening.axis.dot(to - opening.centre);
  if (a * b > 0.0) return false;
  const Vec3 at = from + a / (a - b) * (to - from);
  return (at - opening.centre).norm() < 0.5 * std::max(opening.width, opening.disc);
}

TEST_F(RingsRestsPushes, ThumbAndFingersGoThroughTheRingsOfScissors) {
  const Product scissors = tried_product("scissors");
  const ProductParts parts = find_parts(scissors);
  const std::optional<ScissorRings> rings = scissor_rings(parts, scissors);
  ASSERT_TRUE(rings);
  EXPECT_LT(rings->thumb.width, rings->fingers.width);
  EXPECT_GT(rings->toward.x(), 0.9);  // the blades are at +x
  PrecisionGripOptions options;
  options.grip = Grip::kDistalType;
  options.targets = ring_targets(hand(), scissors, *rings);
  ASSERT_GE(options.targets.size(), 3U);
  const Grasp grasp = close_precision_grip(hand(), scissors, options);
  EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  const PosedSkeleton posed = pose_skeleton(hand().skeleton, grasp.posture);
  const auto there = [&](Segment segment, const Vec3& reference) -> Vec3 {
    return grasp.product_from_hand * (posed.segment[index_of(segment)] * reference);
  };
  const Vec3 thumb_joint =
      there(Segment::kThumbProximal, hand().skeleton.joint(JointId::kThumbMp).centre);
  const Vec3 thumb_tip = there(Segment::kThumbDistal, hand().skeleton.fingertips[0]);
  EXPECT_TRUE(passes_through(rings->thumb, thumb_joint, thumb_tip));
  const Vec3 knuckle =
      there(Segment::kMiddleProximal, hand().skeleton.joint(JointId::kMiddleMcp).centre);
  const Vec3 middle_tip = there(Segment::kMiddleDistal, hand().skeleton.fingertips[2]);
  EXPECT_TRUE(passes_through(rings->fingers, knuckle, middle_tip));
}

TEST_F(RingsRestsPushes, WhatHasNoTwoRingsSaysSo) {
  PrecisionGripOptions options;
  options.grip = Grip::kDistalType;
  const Grasp grasp = close_precision_grip(hand(), tried_product("jug"), options);
  EXPECT_EQ(grasp.status, GraspStatus::kNotGraspable);
  EXPECT_NE(grasp.message.find("no two rings"), std::string::npos) << grasp.message;
  EXPECT_FALSE(scissor_rings(find_parts(tried_product("spade")), tried_product("spade")));
}

TEST_F(RingsRestsPushes, FlatHandsThumbIsBesideThePalm) {
  const Posture flat = *named_posture(hand().skeleton, "flat");
  const std::vector<Vec3> skin = pose_skin(hand(), flat);
  double thumb = -1e9, fingers = -1e9, palm = -1e9;  // how far skin reaches palmar, mm
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand().segment[v] == Segment::kThumbDistal) thumb = std::max(thumb, skin[v].z());
    if (hand().segment[v] == Segment::kIndexProximal) fingers = std::max(fingers, skin[v].z());
    if (hand().segment[v] == Segment::kPalm) palm = std::max(palm, skin[v].z());
  }
  EXPECT_LT(thumb, palm);
  EXPECT_LT(thumb, fingers + 6.0);
}

TEST_F(RingsRestsPushes, AFlatHandLiesOnATableWithAllItHas) {
  const Product table = box_of("table", 400, 300, 30);
  LaidSite site;
  site.up = Vec3::UnitZ();
  site.fingers = Vec3::UnitX();
  site.knuckle = Vec3(0, 0, table.distance->bounding_box().max().z());
  Grasp grasp = close_laid_hand(hand(), table, Grip::kFlatHand, site);
  EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  for (const char* part : {"palm", "thumb", "index", "middle", "ring", "little"}) {
    EXPECT_NE(grasp.message.find(part), std::string::npos) << grasp.message;
  }
  // Its back is up and its fingers point where they are to.
  EXPECT_LT((grasp.product_from_hand.rotation * Vec3::UnitZ()).z(), -0.9);
  EXPECT_GT((grasp.product_from_hand.rotation * Vec3::UnitY()).x(), 0.9);
  const Balance rest = balance_grasp(prepared(), table, grasp);
  EXPECT_EQ(rest.status, BalanceStatus::kSupported) << rest.message;
  EXPECT_NEAR(rest.grip_force, kRestingForce, 0.006 * kRestingForce);
  // The contact that is then solved has that force straight down: nothing else pushes a flat top.
  const ContactResult contact = solve_hand_contact(prepared(), pose_skin(hand(), grasp.posture),
                                                   grasp.product_from_hand, *table.distance, {});
  EXPECT_NEAR(-contact.total.force_vector.z(), kRestingForce, 0.1 * kRestingForce);
}

TEST_F(RingsRestsPushes, AFingerPushesWithTheForceAskedFor) {
  const Product box = box_of("box", 120, 90, 50);
  const Vec3 top(10, -5, box.distance->bounding_box().max().z());
  Grasp grasp = close_finger_push(hand(), box, top);
  EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  ASSERT_EQ(grasp.fingertips.size(), 1U);
  EXPECT_EQ(grasp.fingertips[0].finger, Finger::kIndex);
  EXPECT_LT((grasp.fingertips[0].reached - top).norm(), 1.5);
  for (const double force : {2.0, 10.0}) {
    Grasp pushing = grasp;
    BalanceOptions options;
    options.grip_force = force;
    const Balance rest = balance_grasp(prepared(), box, pushing, options);
    EXPECT_EQ(rest.status, BalanceStatus::kSupported) << rest.message;
    EXPECT_NEAR(rest.grip_force, force, 0.006 * force);
  }
  BalanceOptions too_much;
  too_much.grip_force = 1500.0;
  EXPECT_EQ(balance_grasp(prepared(), box, grasp, too_much).status, BalanceStatus::kNotConverged);
}

TEST_F(RingsRestsPushes, EveryHandTakesTheRestingHoldAtTheSamePlace) {
  const Product mouse = tried_product("computer_mouse");
  GraspOptions asked;
  asked.grip = Grip::kRestingHand;
  const GraspPlace place(hand(), mouse, asked);
  ASSERT_TRUE(place.reference_grasp().hold);
  EXPECT_EQ(place.reference_grasp().status, GraspStatus::kHeld);
  const Hand left = mirrored(hand());
  const GraspingHand other(std::make_shared<Hand>(left));
  const Grasp grasp = place.hold(other);
  EXPECT_EQ(grasp.status, GraspStatus::kHeld) << grasp.message;
  // The same direction of palm and fingers, the thumb on the other side.
  const Quat a = place.reference_grasp().product_from_hand.rotation;
  const Quat b = grasp.product_from_hand.rotation;
  EXPECT_GT((a * Vec3::UnitZ()).dot(b * Vec3::UnitZ()), 0.9);
  EXPECT_GT((a * Vec3::UnitY()).dot(b * Vec3::UnitY()), 0.8);
  EXPECT_LT(place.reference_grasp().grip_axis.dot(grasp.grip_axis), 0.0);
}

TEST(NonPrehensile, GripsHaveNamesAndAreNoPowerGrips) {
  EXPECT_EQ(grip_named("scissors"), Grip::kDistalType);
  EXPECT_EQ(grip_named("Distal Type"), Grip::kDistalType);
  EXPECT_EQ(grip_named("rest"), Grip::kRestingHand);
  EXPECT_EQ(grip_named("push"), Grip::kFingerPush);
  EXPECT_FALSE(is_power(Grip::kDistalType));
  EXPECT_EQ(description_of(Grip::kDistalType).taxonomy_number, 19);  // Feix et al. 2016
  for (const Grip grip : {Grip::kRestingHand, Grip::kFlatHand, Grip::kFingerPush}) {
    EXPECT_FALSE(is_power(grip));
    EXPECT_TRUE(is_non_prehensile(grip));
    EXPECT_EQ(is_laid(grip), grip != Grip::kFingerPush);
  }
}

}  // namespace
}  // namespace palmar
