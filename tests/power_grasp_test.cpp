// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The power grasp of the template hand. Stands here because reading the hand's asset does not
// belong to what the grasp module may include.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/power/posable_skin.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"
#include "palmar/records/product/product_file.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

constexpr double kDeg = std::numbers::pi / 180.0;

product::Product cylinder(double diameter, double length = 160.0) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = length;
  options.fineness.chordal_error = 0.05;
  return product::make_cylinder_product(options);
}

product::Product box(const Vec3& size, int divisions = 8) {
  product::Product product;
  product.name = "box";
  product.mesh = geometry::make_box(size, divisions);
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  return product;
}

product::Product moved(const product::Product& product, const geometry::Rigid3& motion) {
  product::Product result = product;
  for (Vec3& v : result.mesh.vertices) v = motion * v;
  result.distance = std::make_shared<geometry::MeshDistance>(result.mesh);
  return result;
}

double penetration(const grasp::Grasp& grasp, hand::Segment segment) {
  return grasp.stops[static_cast<std::size_t>(segment)].penetration;
}

// Deepest palmar skin of one segment by the product's own distance, mm.
double deepest(const hand::Hand& hand, const product::Product& product, const grasp::Grasp& grasp,
               hand::Segment segment) {
  const std::vector<Vec3> skin = hand::pose_skin(hand, grasp.posture);
  double depth = -1e9;
  for (std::size_t v = 0; v < skin.size(); ++v) {
    if (hand.segment[v] != segment || hand.region[v] == hand::Region::kDorsum) continue;
    depth = std::max(depth, -product.distance->at(grasp.product_from_hand * skin[v]).distance);
  }
  return depth;
}

class PowerGrasp : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(PALMAR_HAND_ASSET)) {
      GTEST_SKIP() << "the generic hand is not installed (npm ci fetches it)";
    }
  }
  /// Coarser than the default, so that the sanitized build stays quick.
  static const hand::Hand& hand() {
    static const hand::Hand made =
        hand::build_template(records::read_hand_asset(PALMAR_HAND_ASSET), {.edge_length = 3.5});
    return made;
  }
};

TEST_F(PowerGrasp, CylindersAreHeldByAllFingersWithinTheLimits) {
  for (const double diameter : {35.0, 48.0, 60.0}) {
    SCOPED_TRACE(diameter);
    const product::Product product = cylinder(diameter);
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product);
    ASSERT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
    EXPECT_NEAR(grasp.grip_girth, std::numbers::pi * diameter, 0.5);
    EXPECT_GT(std::abs(grasp.grip_axis.z()), 0.999);
    for (int s = 0; s < hand::kSegmentCount; ++s) {
      const auto segment = static_cast<hand::Segment>(s);
      const double limit = segment == hand::Segment::kPalm ? 7.0 : 4.0;
      const double depth = deepest(hand(), product, grasp, segment);
      EXPECT_LE(depth, limit + 0.05) << name_of(segment);
      if (depth < -5.0) continue;  // far skin isn't measured
      EXPECT_NEAR(depth, penetration(grasp, segment), 0.3) << name_of(segment);
    }
    EXPECT_GT(penetration(grasp, hand::Segment::kPalm), 3.0);
    for (const hand::Segment tip : {hand::Segment::kIndexDistal, hand::Segment::kMiddleDistal,
                                    hand::Segment::kRingDistal, hand::Segment::kLittleDistal}) {
      EXPECT_GT(penetration(grasp, tip), 1.0) << name_of(tip);
    }
    // The thumb came until it met the product or, round thin bars, the fingers.
    const grasp::SegmentStop& thumb =
        grasp.stops[static_cast<std::size_t>(hand::Segment::kThumbDistal)];
    EXPECT_NE(thumb.reason, grasp::StopReason::kRangeOfMotion);
    EXPECT_NE(thumb.reason, grasp::StopReason::kNotReached);
  }
}

TEST_F(PowerGrasp, HundredMillimetreCylinderIsStillHeld) {
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(100.0));
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
}

TEST_F(PowerGrasp, GripAxisLiesObliquelyAcrossThePalm) {
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(35.0));
  const Vec3 axis = grasp.product_from_hand.rotation.conjugate() * grasp.grip_axis;
  const Vec3 heads = (hand().skeleton.joint(hand::JointId::kIndexMcp).centre -
                      hand().skeleton.joint(hand::JointId::kLittleMcp).centre)
                         .normalized();
  // 10-25 degrees to the line of the metacarpal heads; the slope of the palm adds some.
  const double angle = std::acos(std::min(1.0, std::abs(axis.dot(heads)))) / kDeg;
  EXPECT_GT(angle, 5.0);
  EXPECT_LT(angle, 32.0);
  EXPECT_GT(axis.x(), 0.5);  // towards the thumb side of a right hand
}

TEST_F(PowerGrasp, ThumbAndFingertipsPressFromDifferentSides) {
  const product::Product product = cylinder(60.0);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product);
  const hand::PosedSkeleton pose = hand::pose_skeleton(hand().skeleton, grasp.posture);
  const auto outward = [&](hand::Segment segment, hand::Finger finger) {
    const Vec3 tip = pose.segment[static_cast<std::size_t>(segment)] *
                     hand().skeleton.fingertips[static_cast<std::size_t>(finger)];
    Vec3 r = grasp.product_from_hand * tip - grasp.grip_point;
    r -= grasp.grip_axis * grasp.grip_axis.dot(r);
    return Vec3(r.normalized());
  };
  const Vec3 thumb = outward(hand::Segment::kThumbDistal, hand::Finger::kThumb);
  const Vec3 middle = outward(hand::Segment::kMiddleDistal, hand::Finger::kMiddle);
  EXPECT_GT(std::acos(thumb.dot(middle)) / kDeg, 40.0);
}

TEST_F(PowerGrasp, PostureStaysInsideTheRangeOfMotion) {
  for (const double diameter : {20.0, 48.0}) {
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(diameter));
    EXPECT_TRUE(hand::clamp_to_range(hand().skeleton, grasp.posture).clamped.empty());
  }
}

TEST_F(PowerGrasp, SmallerLimitsAreKept) {
  grasp::PowerGraspOptions options;
  options.palm_limit_depth = 3.0;
  options.finger_limit_depth = 2.0;
  const product::Product product = cylinder(40.0);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product, options);
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const auto segment = static_cast<hand::Segment>(s);
    EXPECT_LE(deepest(hand(), product, grasp, segment), (s == 0 ? 3.0 : 2.0) + 0.05);
  }
}

TEST_F(PowerGrasp, AskedPlaceAndAxisAreKept) {
  grasp::PowerGraspOptions options;
  options.placement.at = Vec3(0.0, 0.0, 30.0);
  options.placement.axis = Vec3(0.0, 0.0, -2.0);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(40.0, 220.0), options);
  EXPECT_EQ(grasp.grip_axis, Vec3(0.0, 0.0, -1.0));
  EXPECT_LT((grasp.grip_point - *options.placement.at).norm(), 1e-9);
}

TEST_F(PowerGrasp, AskedTurnFacesThePalm) {
  const product::Product product = box({30.0, 40.0, 150.0});
  grasp::PowerGraspOptions options;
  options.placement.axis = Vec3::UnitZ();
  for (const double turn : {0.0, std::numbers::pi / 2, -std::numbers::pi / 2}) {
    options.placement.turn = turn;
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), product, options);
    // At zero the product's x axis points to the palm, that is against the palmar direction.
    const Vec3 facing = Eigen::AngleAxisd(turn, Vec3::UnitZ()) * Vec3::UnitX();
    const Vec3 in_hand = grasp.product_from_hand.rotation.conjugate() * facing;
    EXPECT_LT(in_hand.z(), -0.9);
  }
}

TEST_F(PowerGrasp, HugeSphereIsTooLarge) {
  product::SphereProductOptions options;
  options.diameter = 300.0;
  options.fineness.chordal_error = 1.0;
  options.fineness.longest_edge = 15.0;
  const grasp::Grasp grasp =
      grasp::close_power_grasp(hand(), product::make_sphere_product(options));
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kTooLarge) << grasp.message;
  EXPECT_THAT(grasp.message, HasSubstr("girth"));
}

TEST_F(PowerGrasp, WireIsTooSmall) {
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(2.0, 300.0));
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kTooSmall) << grasp.message;
  EXPECT_THAT(grasp.message, HasSubstr("mm thick"));
}

TEST_F(PowerGrasp, SheetIsNotGraspable) {
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), box({300.0, 200.0, 1.0}, 1));
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kNotGraspable) << grasp.message;
  EXPECT_THAT(grasp.message, HasSubstr("sheet"));
}

TEST_F(PowerGrasp, ForceAndAreaFollowTheDiameterWithoutJumps) {
  const contact::PreparedHand prepared(std::make_shared<const hand::Hand>(hand()));
  for (const double first : {36.0, 56.0}) {
    double force = 0.0, area = 0.0;
    for (double diameter = first; diameter < first + 5.0; diameter += 2.0) {
      SCOPED_TRACE(diameter);
      const contact::RegionContact total =
          study::assess(prepared, cylinder(diameter)).contact.total;
      if (diameter > first) {
        EXPECT_NEAR(total.force / force, 1.0,
                    0.18);  // 0.167 from 58 to 60 mm, which is kept in place
        EXPECT_NEAR(total.area / area, 1.0, 0.12);
      }
      force = total.force;
      area = total.area;
    }
  }
}

TEST_F(PowerGrasp, ProximalPhalangesCarryLessOfALargerHandle) {
  // Manugraphy of 152 adults on handles of 100, 150 and 200 mm girth: the share of the proximal
  // phalanges falls as the handle grows.
  const contact::PreparedHand prepared(std::make_shared<const hand::Hand>(hand()));
  double before = 1.0;
  for (const double diameter : {32.0, 48.0, 64.0}) {
    const contact::ContactResult contact = study::assess(prepared, cylinder(diameter)).contact;
    double proximal = 0.0, all = 0.0;
    for (const contact::RegionContact& region : contact.regions) {
      all += region.force;
      for (const hand::Region r : {hand::Region::kIndexProximal, hand::Region::kMiddleProximal,
                                   hand::Region::kRingProximal, hand::Region::kLittleProximal}) {
        if (region.region == r) proximal += region.force;
      }
    }
    EXPECT_LT(proximal / all, before) << diameter;
    before = proximal / all;
  }
}

TEST_F(PowerGrasp, DrillIsHeldAtItsPistolHandle) {
  const std::filesystem::path file =
      std::filesystem::path(PALMAR_SHARED_DIR) / "products" / "power_drill.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the scanned products are not here";
  const product::Product drill =
      records::load_product(file.string(), {.unit = geometry::LengthUnit::kMillimetre});
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), drill);
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  // The list of the products: the handle is 35 to 100 mm above the foot.
  const double height = grasp.grip_point.y() - drill.distance->bounding_box().min().y();
  EXPECT_GT(height, 35.0);
  EXPECT_LT(height, 100.0);
  EXPECT_GT(grasp.grip_axis.y(), 0.7);  // the gearbox lies beyond the thumb
}

TEST_F(PowerGrasp, ThoroughTheThumbFollowsTheDiameterAndNotTheMesh) {
  const std::array<hand::Dof, 4> thumb = {hand::Dof::kThumbCmcFlexion,
                                          hand::Dof::kThumbCmcAbduction, hand::Dof::kThumbMpFlexion,
                                          hand::Dof::kThumbIpFlexion};
  const auto angles_on = [&](double diameter, double edge) {
    product::CylinderProductOptions options;
    options.diameter = diameter;
    options.length = 150.0;
    options.fineness = {.chordal_error = 0.05, .longest_edge = edge};
    const grasp::Grasp grasp =
        grasp::close_power_grasp(hand(), product::make_cylinder_product(options));
    std::array<double, 4> angles{};
    for (std::size_t i = 0; i < 4; ++i) angles[i] = grasp.posture[thumb[i]] / kDeg;
    return angles;
  };
  std::optional<std::array<double, 4>> before;
  for (double diameter = 32.0; diameter <= 40.0; diameter += 1.0) {
    const std::array<double, 4> here = angles_on(diameter, 2.0);
    const std::array<double, 4> meshed = angles_on(diameter, 3.0);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(meshed[i], here[i], 3.0) << name_of(thumb[i]) << ", " << diameter << " mm";
      if (before) {
        EXPECT_NEAR(here[i], (*before)[i], 7.0) << name_of(thumb[i]) << ", " << diameter << " mm";
      }
    }
    before = here;
  }
}

TEST_F(PowerGrasp, LeftHandHoldsAMirroredProductInTheMirroredWay) {
  product::Product product = box({26.0, 36.0, 150.0});
  for (Vec3& v : product.mesh.vertices) v.head<2>() *= 1.0 + 0.001 * (v.z() + 0.4 * v.x());
  product = moved(product, {});
  product::Product mirror = product;
  for (Vec3& v : mirror.mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mirror.mesh.triangles) std::swap(t[1], t[2]);
  mirror.distance = std::make_shared<geometry::MeshDistance>(mirror.mesh);
  const grasp::Grasp right = grasp::close_power_grasp(hand(), product);
  const grasp::Grasp left = grasp::close_power_grasp(hand::mirrored(hand()), mirror);
  EXPECT_EQ(left.status, right.status);
  for (std::size_t d = 0; d < right.posture.angle.size(); ++d) {
    EXPECT_NEAR(left.posture.angle[d], right.posture.angle[d],
                3e-5)  // the quick distance is in single precision
        << name_of(static_cast<hand::Dof>(d));
  }
  const Vec3 point = right.grip_point.cwiseProduct(Vec3(-1.0, 1.0, 1.0));
  EXPECT_LT((left.grip_point - point).norm(), 0.05);
}

TEST_F(PowerGrasp, SlabLiesWithItsFaceInThePalm) {
  const grasp::Grasp grasp = grasp::close_power_grasp(hand(), box({14.0, 78.0, 130.0}));
  EXPECT_EQ(grasp.status, grasp::GraspStatus::kHeld) << grasp.message;
  const Vec3 face = grasp.product_from_hand.rotation.conjugate() * Vec3::UnitX();
  EXPECT_GT(std::abs(face.z()), 0.7);
}

TEST_F(PowerGrasp, MessageIsInPlainWords) {
  for (const double diameter : {20.0, 100.0}) {
    const grasp::Grasp grasp = grasp::close_power_grasp(hand(), cylinder(diameter));
    EXPECT_THAT(grasp.message, HasSubstr("held by f"));  // the thumb may lie on the fingers
    EXPECT_THAT(grasp.message, ::testing::Not(HasSubstr("_")));
  }
}

TEST_F(PowerGrasp, SameInputGivesTheSameGrasp) {
  const product::Product product = cylinder(42.0);
  const grasp::Grasp a = grasp::close_power_grasp(hand(), product);
  const grasp::Grasp b = grasp::close_power_grasp(hand(), product);
  EXPECT_EQ(a.posture.angle, b.posture.angle);
  EXPECT_EQ(a.product_from_hand.translation, b.product_from_hand.translation);
  EXPECT_EQ(a.product_from_hand.rotation.coeffs(), b.product_from_hand.rotation.coeffs());
}

TEST_F(PowerGrasp, MovedProductIsHeldTheSameWay) {
  // A tapered bar, so that the way it is held is not free by symmetry.
  product::Product product = box({26.0, 36.0, 150.0});
  for (Vec3& v : product.mesh.vertices) v.head<2>() *= 1.0 + 0.001 * (v.z() + 0.4 * v.x());
  product = moved(product, {});
  const geometry::Rigid3 motion{Quat(Eigen::AngleAxisd(0.9, Vec3(0.2, 0.7, -0.4).normalized())),
                                Vec3(40.0, -90.0, 15.0)};
  const grasp::Grasp a = grasp::close_power_grasp(hand(), product);
  const grasp::Grasp b = grasp::close_power_grasp(hand(), moved(product, motion));
  for (std::size_t d = 0; d < a.posture.angle.size(); ++d) {
    EXPECT_NEAR(a.posture.angle[d], b.posture.angle[d], 0.5 * kDeg)
        << name_of(static_cast<hand::Dof>(d));
  }
  EXPECT_LT((motion * a.grip_point - b.grip_point).norm(), 0.05);
}

TEST_F(PowerGrasp, BadLimitIsRefusedByName) {
  grasp::PowerGraspOptions options;
  options.finger_limit_depth = -1.0;
  try {
    grasp::close_power_grasp(hand(), cylinder(40.0), options);
    FAIL() << "a negative depth was taken";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), HasSubstr("finger limit depth is -1 mm"));
  }
}

TEST_F(PowerGrasp, QuickPosingMovesSkinAsSkinningDoes) {
  hand::Posture posture = hand::reference_posture(hand().skeleton);
  for (int d = 3; d < hand::kDofCount; ++d) {
    const hand::JointDof& dof = hand().skeleton.dof(static_cast<hand::Dof>(d));
    posture[dof.dof] = 0.3 * dof.lower + 0.7 * dof.upper;
  }
  std::vector<int> some;
  for (int v = 0; v < hand().skin.vertex_count(); v += 3) some.push_back(v);
  std::vector<Vec3> posed;
  grasp::PosableSkin(hand(), some).pose(posture, posed);
  const std::vector<Vec3> expected = hand::pose_skin_vertices(hand(), posture, some);
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_LT((posed[k] - expected[k]).norm(), 1e-9) << "vertex " << some[k];
  }
}

}  // namespace
}  // namespace palmar::tests
