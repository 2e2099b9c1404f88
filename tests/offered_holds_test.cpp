// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Holds to hand a product over belong to its shape: the first hold of a product that is moved,
// turned, mirrored with the hand or meshed otherwise is, back in its place, among those of the
// product as it is, and as good as the first of them.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <map>

#include "holds/tried_products.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/holds/opposed_holds.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

constexpr double kSameHold =
    35.0;  // mm: holds of the list are farther apart, root mean square of wrist and fingertips
constexpr double kAsGood = 0.35;  // of a score: three quarters as often

// Without symmetry by which one hold is as good as another elsewhere.
const std::vector<std::string>& products() {
  static const std::vector<std::string> names = {"hammer", "spray_bottle", "kettle",
                                                 "kitchen_knife", "frying_pan"};
  return names;
}

grasp::RankedHolds offered(const hand::Hand& hand, const product::Product& product) {
  grasp::HoldOptions options;
  options.purpose = grasp::HoldPurpose::kHandOver;
  return grasp::rank_holds(hand, product, options);
}

grasp::HandPoints points_of(const hand::Hand& hand, const grasp::RankedHold& hold) {
  return grasp::hand_points(hand, hold.grasp.posture, hold.grasp.product_from_hand);
}

using Motion = std::function<Vec3(const Vec3&)>;

/// How far the first hold, brought back, is from the nearest that is as good as the first here.
double away(const hand::Hand& hand, const grasp::RankedHolds& here, const hand::Hand& other_hand,
            const grasp::RankedHolds& there, const Motion& back) {
  if (here.holds.empty() || there.holds.empty()) return std::numeric_limits<double>::infinity();
  grasp::HandPoints first = points_of(other_hand, there.holds.front());
  for (Vec3& point : first.point) point = back(point);
  double least = std::numeric_limits<double>::infinity();
  for (const grasp::RankedHold& hold : here.holds) {
    if (hold.score < here.holds.front().score - kAsGood) continue;
    least = std::min(least, first.distance_to(points_of(hand, hold)));
  }
  return least;
}

class OfferedHolds : public TemplateTest, public testing::WithParamInterface<std::string> {
 protected:
  static const grasp::RankedHolds& as_it_is() {
    static std::map<std::string, grasp::RankedHolds> known;
    const auto found = known.find(GetParam());
    return found != known.end()
               ? found->second
               : known.emplace(GetParam(), offered(hand(), tried_product(GetParam())))
                     .first->second;
  }
  static void expect_same(
      const product::Product& other, const Motion& back = [](const Vec3& p) { return p; }) {
    const double d = away(hand(), as_it_is(), hand(), offered(hand(), other), back);
    EXPECT_LT(d, kSameHold);
  }
};

TEST_P(OfferedHolds, StayWhenTheProductIsMovedAndTurned) {
  const geometry::Rigid3 motion = {Quat(Eigen::AngleAxisd(2.2, Vec3(0.36, 0.48, -0.8))),
                                   Vec3(-40.0, 25.0, 310.0)};
  const geometry::Rigid3 back = motion.inverse();
  expect_same(moved(tried_product(GetParam()), motion), [&](const Vec3& p) { return back * p; });
}

TEST_P(OfferedHolds, StayOnAFinerMesh) { expect_same(with_finer_mesh(GetParam())); }

TEST_P(OfferedHolds, StayOnACoarserMesh) { expect_same(with_coarser_mesh(GetParam())); }

TEST_P(OfferedHolds, StayWhenTrianglesAreShuffled) {
  expect_same(shuffled(tried_product(GetParam())));
}

TEST_P(OfferedHolds, AreMirroredWithProductAndHand) {
  const hand::Hand left = mirrored(hand());
  const double d =
      away(hand(), as_it_is(), left, offered(left, mirrored(tried_product(GetParam()))),
           [](const Vec3& p) { return Vec3(-p.x(), p.y(), p.z()); });
  EXPECT_LT(d, kSameHold);
}

TEST_P(OfferedHolds, StayInAHandOneHundredthLarger) {
  const hand::Hand larger = scaled(hand(), 1.01);
  const double d = away(hand(), as_it_is(), larger, offered(larger, tried_product(GetParam())),
                        [](const Vec3& p) { return p; });
  EXPECT_LT(d, kSameHold);
}

// What is written of a hold says enough to take it again.
TEST_P(OfferedHolds, AreTakenAgainWhereTheyWereFound) {
  const grasp::RankedHold& first = as_it_is().holds.front();
  grasp::GraspOptions again;
  again.hold = first.hold;
  const grasp::Grasp grasp = grasp::find_grasp(hand(), tried_product(GetParam()), again);
  EXPECT_EQ(name_of(grasp.status), name_of(first.grasp.status));
  EXPECT_LT(points_of(hand(), first)
                .distance_to(grasp::hand_points(hand(), grasp.posture, grasp.product_from_hand)),
            10.0);  // mm
}

INSTANTIATE_TEST_SUITE_P(Products, OfferedHolds, testing::ValuesIn(products()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palmar::tests
