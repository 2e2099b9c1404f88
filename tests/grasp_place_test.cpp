// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/find/grasp_place.h"

#include <gmock/gmock.h>

#include "palmar/contact/hand_family.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/instance/hand_instance.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/product/primitives.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

class GraspPlaces : public TemplateTest {
 protected:
  /// Length and circumference of the template times these.
  static std::shared_ptr<const hand::Hand> instance(double length, double circumference) {
    const hand::HandDimensions own = hand::measure_hand(hand());
    return std::make_shared<const hand::Hand>(
        hand::make_hand_instance(
            hand(),
            {{{hand::DimensionKind::kHandLength}, length * own.hand_length},
             {{hand::DimensionKind::kHandCircumference}, circumference * own.hand_circumference}})
            .hand);
  }
  static product::Product cylinder() {
    product::CylinderProductOptions options;
    options.diameter = 38.0;
    return product::make_cylinder_product(options);
  }
  static double contact_area(const std::shared_ptr<const hand::Hand>& held_by,
                             const product::Product& product, const grasp::Grasp& grasp) {
    const contact::PreparedHand prepared(held_by);
    return contact::solve_hand_contact(prepared, hand::pose_skin(*held_by, grasp.posture),
                                       grasp.product_from_hand, *product.distance)
        .total.area;
  }
};

TEST_F(GraspPlaces, ReferenceHandHoldsAsFound) {
  const product::Product product = cylinder();
  const grasp::GraspPlace place(hand(), product);
  const grasp::Grasp searched = grasp::find_grasp(hand(), product);
  const grasp::Grasp again =
      place.hold(grasp::GraspingHand(std::make_shared<const hand::Hand>(hand())));
  EXPECT_EQ(again.posture.angle, searched.posture.angle);
  EXPECT_EQ(again.product_from_hand.translation, searched.product_from_hand.translation);
  EXPECT_EQ(again.message, searched.message);
}

TEST_F(GraspPlaces, OtherHandsHoldTheSameSideAsFirmlyAsAfterASearch) {
  const product::Product product = cylinder();
  const grasp::GraspPlace place(hand(), product);
  for (const auto& [length, circumference] : {std::pair{0.88, 0.9}, std::pair{1.12, 1.05}}) {
    const auto other = instance(length, circumference);
    const grasp::Grasp kept = place.hold(grasp::GraspingHand(other));
    ASSERT_EQ(kept.status, grasp::GraspStatus::kHeld) << kept.message;
    EXPECT_LT(kept.product_from_hand.rotation.angularDistance(
                  place.reference_grasp().product_from_hand.rotation),
              0.2);  // rad; poses differ by the tilt of thin handles only
    // A search of its own may find a little more skin to lie on.
    const double searched = contact_area(other, product, grasp::find_grasp(*other, product));
    EXPECT_GT(contact_area(other, product, kept), 0.8 * searched);
  }
}

TEST_F(GraspPlaces, LeftHandsHoldAMirroredProductInTheMirroredWay) {
  product::Product product = cylinder();
  for (Vec3& v : product.mesh.vertices) v.head<2>() *= 1.0 + 0.001 * (v.z() + 0.4 * v.x());
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  product::Product mirror = product;
  for (Vec3& v : mirror.mesh.vertices) v.x() = -v.x();
  for (Triangle& t : mirror.mesh.triangles) std::swap(t[1], t[2]);
  mirror.distance = std::make_shared<geometry::MeshDistance>(mirror.mesh);
  const auto other = instance(1.06, 1.0);
  const hand::Hand left_reference = hand::mirrored(hand());
  const grasp::Grasp right = grasp::GraspPlace(hand(), product).hold(grasp::GraspingHand(other));
  const grasp::Grasp left =
      grasp::GraspPlace(left_reference, mirror)
          .hold(grasp::GraspingHand(std::make_shared<const hand::Hand>(hand::mirrored(*other))));
  EXPECT_EQ(left.status, right.status);
  for (std::size_t d = 0; d < right.posture.angle.size(); ++d) {
    EXPECT_NEAR(left.posture.angle[d], right.posture.angle[d],
                2e-3)  // rad; on a nearly round bar the sides of its quick distance are chance
        << name_of(static_cast<hand::Dof>(d));
  }
}

// The span of a small child's hand, 106 mm long, can't reach a third round a pipe of 346 mm of
// girth: 115 mm of arc from the thumb to the fingertips.
TEST_F(GraspPlaces, AHandThatCantHoldItThereIsAResult) {
  product::CylinderProductOptions pipe;
  pipe.diameter = 110.0;
  const product::Product product = product::make_cylinder_product(pipe);
  const grasp::GraspPlace place(hand(), product);
  ASSERT_EQ(place.reference_grasp().status, grasp::GraspStatus::kHeld);
  const auto child = std::make_shared<const hand::Hand>(scaled(hand(), 0.6));
  const grasp::Grasp kept = place.hold(grasp::GraspingHand(child));
  EXPECT_NE(kept.status, grasp::GraspStatus::kHeld);
  EXPECT_THAT(kept.message,
              ::testing::StartsWith("cannot take the hold \"large diameter of the body"));
  // Never another hold without a word: what it could do instead is told, or that there is nothing.
  EXPECT_THAT(
      kept.message,
      ::testing::AnyOf(::testing::EndsWith("no other hold was found that this hand can take"),
                       ::testing::HasSubstr("; it could hold it so: ")));
}

// Of a hold that was given nothing else was ranked, so nothing is said of other holds.
TEST_F(GraspPlaces, AGivenHoldThatAHandCantTakeSaysNothingOfOthers) {
  product::CylinderProductOptions pipe;
  pipe.diameter = 100.0;
  const product::Product product = product::make_cylinder_product(pipe);
  grasp::GraspOptions options;
  options.hold = grasp::GraspPlace(hand(), product).reference_grasp().hold;
  ASSERT_TRUE(options.hold);
  const grasp::GraspPlace place(hand(), product, options);
  ASSERT_EQ(place.reference_grasp().status, grasp::GraspStatus::kHeld);
  const auto doll = std::make_shared<const hand::Hand>(scaled(hand(), 0.4));
  const grasp::Grasp kept = place.hold(grasp::GraspingHand(doll));
  ASSERT_NE(kept.status, grasp::GraspStatus::kHeld);
  EXPECT_THAT(kept.message, ::testing::StartsWith("cannot take the hold \""));
  EXPECT_THAT(kept.message, ::testing::Not(::testing::HasSubstr("other hold")));
}

TEST_F(GraspPlaces, ThreadsShareAPlace) {
  const product::Product product = cylinder();
  const grasp::GraspPlace place(hand(), product);
  const auto other = instance(0.95, 1.05);
  const grasp::Grasp alone = place.hold(grasp::GraspingHand(other));
  std::array<grasp::Grasp, 4> together;
  parallel_for(4, [&](int i) {
    together[static_cast<std::size_t>(i)] = place.hold(grasp::GraspingHand(other));
  });
  for (const grasp::Grasp& grasp : together) {
    EXPECT_EQ(grasp.posture.angle, alone.posture.angle);
    EXPECT_EQ(grasp.product_from_hand.translation, alone.product_from_hand.translation);
  }
}

TEST_F(GraspPlaces, FingertipsGoToTheSamePointsOfTheProduct) {
  grasp::GraspOptions options;
  options.grip = grasp::Grip::kTripod;
  product::CylinderProductOptions pen;
  pen.diameter = 14.0;
  const product::Product product = product::make_cylinder_product(pen);
  const grasp::GraspPlace place(hand(), product, options);
  const grasp::Grasp kept = place.hold(grasp::GraspingHand(instance(1.05, 1.02)));
  ASSERT_EQ(kept.fingertips.size(), place.reference_grasp().fingertips.size());
  for (std::size_t k = 0; k < kept.fingertips.size(); ++k) {
    EXPECT_LT((kept.fingertips[k].target - place.reference_grasp().fingertips[k].target).norm(),
              1.0);  // mm
  }
}

// Three standard deviations of hand length (17 %) and circumference (22 %) about the mean.
TEST_F(GraspPlaces, HandsOfOneFamilyPressAsIfPreparedInFull) {
  const auto base = std::make_shared<const hand::Hand>(hand());
  const contact::HandFamily family(base);
  const product::Product product = cylinder();
  const grasp::GraspPlace place(hand(), product);
  for (const auto& [length, circumference] :
       {std::pair{0.85, 0.85}, std::pair{1.17, 0.9}, std::pair{0.95, 1.2}}) {
    const auto other = instance(length, circumference);
    const grasp::Grasp grasp = place.hold(grasp::GraspingHand(other));
    const std::vector<Vec3> skin = hand::pose_skin(*other, grasp.posture);
    const auto press = [&](const contact::PreparedHand& prepared) {
      return contact::solve_hand_contact(prepared, skin, grasp.product_from_hand, *product.distance)
          .total;
    };
    const contact::RegionContact full = press(contact::PreparedHand(other)),
                                 quick = press({other, family});
    EXPECT_NEAR(quick.force, full.force, 0.002 * full.force);
    EXPECT_NEAR(quick.area, full.area, 0.002 * full.area);
    EXPECT_NEAR(quick.peak_pressure_cells, full.peak_pressure_cells,
                0.005 * full.peak_pressure_cells);
  }
}

}  // namespace
}  // namespace palmar::tests
