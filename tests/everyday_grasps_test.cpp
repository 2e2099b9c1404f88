// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Whether everyday things are held as people hold them: grips by the GRASP taxonomy (Feix et al.
// 2016, IEEE Trans Human-Machine Systems 46:66-77; Cutkosky 1989, IEEE Trans Robotics Automation
// 5:269-279, whose medium wrap holds tools by their handle). Places on the ten scanned products are
// from the list that comes with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/power/placement.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/primitives.h"
#include "palmar/records/product/product_file.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

double depth_of(const grasp::Grasp& grasp, hand::Segment segment) {
  return grasp.stops[static_cast<std::size_t>(segment)].penetration;
}

bool touches(const grasp::Grasp& grasp, hand::Finger finger) {
  for (const auto& segment : hand::segments_of(finger)) {
    if (segment && depth_of(grasp, *segment) > 0.0) return true;
  }
  return false;
}

int fingers_touching(const grasp::Grasp& grasp) {  // thumb not counted
  int count = 0;
  for (int f = 1; f < hand::kFingerCount; ++f)
    count += touches(grasp, static_cast<hand::Finger>(f)) ? 1 : 0;
  return count;
}

Vec3 tip_in_product(const hand::Hand& hand, const grasp::Grasp& grasp, hand::Finger finger) {
  const hand::PosedSkeleton pose = hand::pose_skeleton(hand.skeleton, grasp.posture);
  const auto segments = hand::segments_of(finger);
  const hand::Segment last = finger == hand::Finger::kThumb ? *segments[1] : *segments[2];
  return grasp.product_from_hand * (pose.segment[static_cast<std::size_t>(last)] *
                                    hand.skeleton.fingertips[static_cast<std::size_t>(finger)]);
}

// Deepest that skin of the back of the hand and of the fingers goes into the product, mm.
double deepest_dorsum(const hand::Hand& hand, const product::Product& product,
                      const grasp::Grasp& grasp) {
  const std::vector<Vec3> skin = hand::pose_skin(hand, grasp.posture);
  double depth = 0.0;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.region[v] != hand::Region::kDorsum) continue;
    depth = std::max(depth, -product.distance->at(grasp.product_from_hand * skin[v]).distance);
  }
  return depth;
}

product::Product bar(double diameter, double length) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = length;
  return product::make_cylinder_product(options);
}

product::Product ball(double diameter) {
  product::SphereProductOptions options;
  options.diameter = diameter;
  options.fineness.chordal_error = 0.1;
  return product::make_sphere_product(options);
}

struct EverydayThing {
  const char* file;
  std::vector<grasp::Grip> grips;  ///< any of these
  Vec3 low, high;                  ///< where the grip point lies, shares of the bounding box
  Vec3 axis;                       ///< towards the thumb, product frame; zero: left open
  int fingers;                     ///< at least, beside the thumb
};

const std::vector<EverydayThing>& everyday_things() {
  using enum grasp::Grip;
  static const std::vector<EverydayThing> list = {
      // Handle x from 165 of 260 mm; the blade beyond the thumb.
      {"screwdriver_phillips",
       {kSmallDiameter, kMediumWrap},
       {0.63, 0, 0},
       {1, 1, 1},
       {-1, 0, 0},
       4},
      // Handle: the first 190 of 292 mm; the head beyond the thumb.
      {"rubber_mallet", {kSmallDiameter, kMediumWrap}, {0, 0, 0}, {0.65, 1, 1}, {1, 0, 0}, 4},
      // By the handle, on the +x side, the thumb on top of it.
      {"mug", {kFixedHook}, {0.75, 0.2, 0.2}, {1, 0.9, 0.8}, {0, 0, 1}, 3},
      // Handle: the first 110 of 240 mm; the blade beyond the thumb.
      {"cookie_spatula", {kSmallDiameter, kMediumWrap}, {0, 0, 0}, {0.46, 1, 1}, {1, 0, 0}, 4},
      {"handheld_console", {kLargeDiameter}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 4},
      {"portable_speaker", {kLargeDiameter}, {0.2, 0, 0}, {0.8, 1, 1}, {0, 0, 0}, 4},
      {"portable_drive", {kMediumWrap, kLargeDiameter}, {0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 4},
      // Pistol handle 35 to 100 mm above the foot of 188; the gearbox beyond the thumb.
      {"power_drill", {kMediumWrap}, {0, 0.18, 0}, {1, 0.54, 1}, {0, 1, 0}, 4},
      // By the body, mouth at the thumb's side.
      {"mustard_bottle", {kLargeDiameter}, {0, 0, 0.2}, {1, 1, 0.75}, {0, 0, 1}, 4},
      {"large_marker", {kSmallDiameter}, {0, 0.2, 0}, {1, 0.8, 1}, {0, 0, 0}, 4},
  };
  return list;
}

class EverydayGrasps : public TemplateTest {
 protected:
  static product::Product load(const std::string& name) {
    const std::filesystem::path file =
        std::filesystem::path(PALMAR_SHARED_DIR) / "products" / (name + ".obj");
    return records::load_product(file.string(), {.unit = geometry::LengthUnit::kMillimetre});
  }
  static bool are_here() {
    return std::filesystem::exists(std::filesystem::path(PALMAR_SHARED_DIR) / "products");
  }
};

TEST_F(EverydayGrasps, ThoroughTenProductsAreHeldAsPeopleHoldThem) {
  if (!are_here()) GTEST_SKIP() << "the scanned products are not here";
  for (const EverydayThing& thing : everyday_things()) {
    SCOPED_TRACE(thing.file);
    const product::Product product = load(thing.file);
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product);
    EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
    EXPECT_THAT(thing.grips, ::testing::Contains(grasp.grip)) << name_of(grasp.grip);
    EXPECT_TRUE(touches(grasp, hand::Finger::kThumb));
    EXPECT_GE(fingers_touching(grasp), thing.fingers);
    const Box3 box = product.distance->bounding_box();
    const Vec3 share = (grasp.grip_point - box.min()).cwiseQuotient(box.sizes());
    EXPECT_TRUE((share.array() >= thing.low.array() - 1e-9).all() &&
                (share.array() <= thing.high.array() + 1e-9).all())
        << share.transpose();
    if (thing.axis.norm() > 0.0) {
      EXPECT_GT(grasp.grip_axis.dot(thing.axis), 0.8);
    }
    EXPECT_LT(deepest_dorsum(hand(), product, grasp), 4.0);
    EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, grasp.posture).clamped.empty());
    EXPECT_GT(grasp.candidates, 10);
  }
}

// Hands differ in size, not in how they hold: hands of 158 to 211 mm (the 1st percentile of women
// to beyond the 99th of men, ANSUR II), searching by themselves, take the drill by handle or motor.
TEST_F(EverydayGrasps, HandsOfEverySizeTakeTheSamePart) {
  if (!are_here()) GTEST_SKIP() << "the scanned products are not here";
  for (const char* const name : {"power_drill", "mug", "portable_speaker"}) {
    const product::Product product = load(name);
    const grasp::GraspPlace place(hand(), product);
    const grasp::Grasp& usual = place.reference_grasp();
    for (const double factor : {0.9, 1.05, 1.2}) {
      const auto other = std::make_shared<const hand::Hand>(scaled(hand(), factor));
      const grasp::Grasp kept = place.hold(grasp::GraspingHand(other));
      EXPECT_EQ(kept.status, grasp::GraspStatus::kHeld)
          << name << ' ' << factor << ": " << kept.message;
      EXPECT_LT((kept.grip_point - usual.grip_point).norm(), 15.0) << name << ' ' << factor;
      EXPECT_GT(kept.grip_axis.dot(usual.grip_axis), 0.9) << name << ' ' << factor;
    }
  }
}

TEST_F(EverydayGrasps, TheDrillPointsAwayFromTheForearm) {
  if (!are_here()) GTEST_SKIP() << "the scanned products are not here";
  const product::Product drill = load("power_drill");
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), drill);
  // The chuck is where the gearbox reaches farthest from the handle.
  const Box3 box = drill.distance->bounding_box();
  const double x = grasp.grip_point.x();
  const Vec3 chuck = box.max().x() - x > x - box.min().x() ? Vec3::UnitX() : Vec3(-Vec3::UnitX());
  const Vec3 in_hand = grasp.product_from_hand.rotation.conjugate() * chuck;
  EXPECT_GT(in_hand.dot(Vec3(0.0, 1.0, 1.0).normalized()), 0.5);
  // The index finger is the one at the trigger: the fingers follow in order.
  double before = 1e9;
  for (const hand::Finger finger :
       {hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing, hand::Finger::kLittle}) {
    const double here = grasp.grip_axis.dot(tip_in_product(hand(), grasp, finger));
    EXPECT_LT(here, before) << name_of(finger);
    before = here;
  }
}

TEST_F(EverydayGrasps, TheDriveLiesWithItsFaceInThePalmAndTheConsoleBetweenThumbAndFingers) {
  if (!are_here()) GTEST_SKIP() << "the scanned products are not here";
  const grasp::Grasp drive = grasp::close_power_grasp(hand(), load("portable_drive"));
  const Vec3 face = drive.product_from_hand.rotation.conjugate() * Vec3::UnitX();
  EXPECT_GT(std::abs(face.z()), 0.8);
  const product::Product console = load("handheld_console");
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), console);
  const double middle = console.distance->bounding_box().center().z();
  const double thumb = tip_in_product(hand(), grasp, hand::Finger::kThumb).z() - middle;
  for (const hand::Finger finger : {hand::Finger::kMiddle, hand::Finger::kRing}) {
    EXPECT_LT(thumb * (tip_in_product(hand(), grasp, finger).z() - middle), 0.0);
  }
}

TEST_F(EverydayGrasps, NoSkinOfAFingerComesOutInsideTheMug) {
  if (!are_here()) GTEST_SKIP() << "the scanned products are not here";
  const product::Product mug = load("mug");
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), mug);
  const std::vector<Vec3> skin = hand::pose_skin(hand(), grasp.posture);
  // The cup's axis and mouth from the list's sizes: a cylinder of 38 mm radius well inside it.
  int inside = 0;
  for (const Vec3& p : skin) {
    const Vec3 q = grasp.product_from_hand * p;
    if (q.z() > 15.0 && q.z() < 95.0 && Vec3(q.x() + 17.0, q.y() + 4.0, 0.0).norm() < 34.0)
      ++inside;
  }
  EXPECT_EQ(inside, 0);
}

TEST_F(EverydayGrasps, ABallIsHeldWithFingersSpreadTheMoreTheLargerItIs) {
  double before = -1.0;
  for (const double diameter : {60.0, 95.0}) {
    SCOPED_TRACE(diameter);
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), ball(diameter));
    EXPECT_EQ(grasp.grip, grasp::Grip::kPowerSphere);
    EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
    EXPECT_GE(fingers_touching(grasp), 4);
    // Its pad, or its side with the pad beside it.
    EXPECT_GT(depth_of(grasp, hand::Segment::kThumbDistal), -3.0);
    EXPECT_GT(depth_of(grasp, hand::Segment::kPalm), 1.0);
    const double spread = grasp.posture[hand::Dof::kIndexMcpAbduction] -
                          grasp.posture[hand::Dof::kLittleMcpAbduction];
    if (before > -1.0) {
      EXPECT_GT(spread, before + 5.0 * kDeg);
    }
    before = spread;
  }
}

TEST_F(EverydayGrasps, AHookCarriesInTheFingersAlone) {
  grasp::PowerGraspOptions options;
  options.grip = grasp::Grip::kFixedHook;
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), bar(25.0, 120.0), options);
  EXPECT_EQ(grasp.grip, grasp::Grip::kFixedHook);
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  EXPECT_EQ(fingers_touching(grasp), 4);
  EXPECT_FALSE(touches(grasp, hand::Finger::kThumb));
  EXPECT_THAT(grasp.message, ::testing::Not(HasSubstr("thumb")));
  for (const hand::Finger finger :
       {hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing, hand::Finger::kLittle}) {
    const int first =
        static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * (static_cast<int>(finger) - 1);
    EXPECT_LT(grasp.posture.angle[static_cast<std::size_t>(first)], 25.0 * kDeg);
    EXPECT_GT(grasp.posture.angle[static_cast<std::size_t>(first + 2)], 40.0 * kDeg);
  }
  EXPECT_LT(depth_of(grasp, hand::Segment::kPalm), 4.1);
}

TEST_F(EverydayGrasps, WrapsAreCalledByTheirSize) {
  EXPECT_EQ(grasp::close_power_grasp(hand(), bar(20.0, 160.0)).grip, grasp::Grip::kSmallDiameter);
  EXPECT_EQ(grasp::close_power_grasp(hand(), bar(40.0, 160.0)).grip, grasp::Grip::kMediumWrap);
  EXPECT_EQ(grasp::close_power_grasp(hand(), bar(75.0, 160.0)).grip, grasp::Grip::kLargeDiameter);
}

TEST_F(EverydayGrasps, DistalJointsFollowTheMiddleOnes) {
  for (const double diameter : {25.0, 40.0, 70.0}) {
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), bar(diameter, 160.0));
    for (const hand::Dof pip : {hand::Dof::kIndexPipFlexion, hand::Dof::kMiddlePipFlexion,
                                hand::Dof::kRingPipFlexion, hand::Dof::kLittlePipFlexion}) {
      const auto p = static_cast<std::size_t>(pip);
      const double off = grasp.posture.angle[p + 1] - 2.0 / 3.0 * grasp.posture.angle[p];
      // 25 degrees to lie on the product; opening what went too deep may add a little.
      EXPECT_LT(std::abs(off), 30.0 * kDeg) << diameter << " mm, " << name_of(pip);
    }
  }
}

TEST_F(EverydayGrasps, ARegionIsWhereTheHandGoes) {
  grasp::PowerGraspOptions options;
  const product::Product product = bar(35.0, 400.0);
  options.placement.region = Box3(Vec3(-20.0, -20.0, 100.0), Vec3(20.0, 20.0, 160.0));
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product, options);
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  EXPECT_NEAR(grasp.grip_point.z(), 130.0, 5.0);
  options.placement.region = Box3(Vec3(100.0, 100.0, 0.0), Vec3(120.0, 120.0, 20.0));
  try {
    grasp::close_power_grasp(hand(), product, options);
    FAIL() << "a region beside the product was taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("region holds no part of the surface"));
  }
  options.placement.region = Box3(Vec3(0.0, 0.0, 0.0), Vec3(0.0, 10.0, 10.0));
  EXPECT_THROW(grasp::close_power_grasp(hand(), product, options), UsageError);
}

TEST_F(EverydayGrasps, AGivenPlacementIsKeptAndOnlyTheFingersClose) {
  const product::Product product = bar(45.0, 160.0);
  const grasp::Grasp found = grasp::close_power_grasp(hand(), product);
  grasp::PowerGraspOptions options;
  options.placement.product_from_hand = found.product_from_hand;
  const grasp::Grasp again = grasp::close_power_grasp(hand(), product, options);
  EXPECT_EQ(again.product_from_hand.translation, found.product_from_hand.translation);
  EXPECT_EQ(again.status, grasp::GraspStatus::kHeld) << again.message;
  EXPECT_EQ(again.candidates, 1);
  options.placement.at = Vec3::Zero();
  EXPECT_THROW(grasp::close_power_grasp(hand(), product, options), UsageError);
}

TEST_F(EverydayGrasps, RunnersUpAreOtherWaysOfHoldingBestFirst) {
  product::Product product;
  product.name = "slab";
  product.mesh = geometry::make_box({25.0, 45.0, 140.0}, 8);
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product);
  ASSERT_FALSE(grasp.runners_up.empty());
  double before = grasp.score + 0.2;  // such a difference doesn't change the order
  std::vector<geometry::Rigid3> seen;
  for (const grasp::GraspRunnerUp& other : grasp.runners_up) {
    EXPECT_LE(other.score, before);
    before = std::min(before, other.score + 0.2);
    for (const geometry::Rigid3& placement : seen) {
      EXPECT_TRUE(grasp::differ(hand(), placement, other.product_from_hand));
    }
    seen.push_back(other.product_from_hand);
    EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, other.posture).clamped.empty());
  }
}

TEST_F(EverydayGrasps, FewerCandidatesAreTriedIfSoAsked) {
  grasp::PowerGraspOptions options;
  options.placement.axis = Vec3::UnitZ();  // placed by coordinates: the rest is searched
  grasp::PowerGraspOptions plenty = options;
  options.candidates = 12;
  const product::Product product = bar(45.0, 160.0);
  const grasp::Grasp few = grasp::close_power_grasp(hand(), product, options);
  const grasp::Grasp many = grasp::close_power_grasp(hand(), product, plenty);
  EXPECT_LT(few.candidates, many.candidates);
  // The thumb is added at the end and can turn out a little worse at a better place.
  EXPECT_LE(few.score, 1.01 * many.score);
  options.candidates = 0;
  EXPECT_THROW(grasp::close_power_grasp(hand(), product, options), UsageError);
}

TEST_F(EverydayGrasps, AMirroredWorldIsGraspedTheMirroredWay) {
  product::Product product;
  product.mesh = geometry::make_box({26.0, 36.0, 150.0}, 8);
  for (Vec3& v : product.mesh.vertices) {  // without any symmetry of its own
    v.head<2>() *= 1.0 + 0.001 * (v.z() + 0.4 * v.x() + 0.3 * v.y());
  }
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  product::Product mirror = product;
  for (Vec3& v : mirror.mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mirror.mesh.triangles) std::swap(t[1], t[2]);
  mirror.distance = std::make_shared<geometry::MeshDistance>(mirror.mesh);
  const grasp::Grasp right = grasp::close_power_grasp(hand(), product);
  const grasp::Grasp left = grasp::close_power_grasp(hand::mirrored(hand()), mirror);
  EXPECT_EQ(left.status, right.status);
  EXPECT_EQ(left.candidates, right.candidates);
  // The quick distance keeps single precision: 1e-6 mm, over a phalanx of 20 mm.
  for (std::size_t d = 0; d < right.posture.angle.size(); ++d) {
    EXPECT_NEAR(left.posture.angle[d], right.posture.angle[d], 3e-5)
        << name_of(static_cast<hand::Dof>(d));
  }
  const auto across = [](const Vec3& v) { return Vec3(-v.x(), v.y(), v.z()); };
  for (const Vec3& p : {Vec3(0.0, 0.0, 0.0), Vec3(50.0, 0.0, 0.0), Vec3(0.0, 90.0, 30.0)}) {
    EXPECT_LT((across(left.product_from_hand * across(p)) - right.product_from_hand * p).norm(),
              1e-4);
  }
}

TEST_F(EverydayGrasps, AGripForFingertipsIsRefused) {
  grasp::PowerGraspOptions options;
  options.grip = grasp::Grip::kTripod;
  try {
    grasp::close_power_grasp(hand(), bar(20.0, 120.0), options);
    FAIL() << "a tripod was taken for a power grip";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("tripod is no power grip"));
  }
}

}  // namespace
}  // namespace palmar::tests
