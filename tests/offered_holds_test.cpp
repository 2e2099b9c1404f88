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
#include <optional>

#include "holds/tried_products.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/holds/opposed_holds.h"
#include "palmar/grasp/precision/precision_shape.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "palmar/hand/mirror.h"
#include "palmar/product/primitives.h"
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

grasp::RankedHolds offered(const hand::Hand& hand, const product::Product& product,
                           const std::optional<Vec3>& up = {}) {
  grasp::HoldOptions options;
  options.up = up;
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

// Where it is said how it lies: the same of a product that is turned along with its up, and the
// thumb's side goes along with it.
TEST_P(OfferedHolds, KeepTheThumbsSideUpWhereUpIsSaid) {
  const Vec3 up = Vec3::UnitZ();
  const product::Product product = tried_product(GetParam());
  const grasp::RankedHolds upright = offered(hand(), product, up);
  const geometry::Rigid3 motion = {Quat(Eigen::AngleAxisd(2.2, Vec3(0.36, 0.48, -0.8))),
                                   Vec3(-40.0, 25.0, 310.0)};
  const geometry::Rigid3 back = motion.inverse();
  EXPECT_LT(away(hand(), upright, hand(),
                 offered(hand(), moved(product, motion), Vec3(motion.rotation * up)),
                 [&](const Vec3& p) { return back * p; }),
            kSameHold);
  const auto thumb_side_up = [&](const grasp::RankedHolds& holds) {
    return grasp::grip_frame(points_of(hand(), holds.holds.front())).row.dot(up);
  };
  const double over = thumb_side_up(offered(hand(), product, Vec3(-up)));
  EXPECT_GT(thumb_side_up(upright), over + 0.3);
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

// Of a bar the shares and levers are plain: 300 mm along x, taken anywhere.
class OpposedHolds : public TemplateTest {};

TEST_F(OpposedHolds, FeaturesOfHoldsOfABarAreWhatItsShapeSays) {
  const product::Product bar =
      product::make_prism_product({.width = 24.0, .depth = 24.0, .length = 300.0});
  const Box3 box = bar.distance->bounding_box();
  Eigen::Index longest = 0;
  box.sizes().maxCoeff(&longest);
  const Vec3 x = Vec3::Unit(longest);
  grasp::OpenedHand opened(hand());
  const double length = hand().dimensions.hand_length;
  int in_line = 0, along = 0;
  for (const grasp::OpposedHold& hold : grasp::opposed_holds(opened, bar)) {
    const Vec3 others = (hold.points.tip(1) + hold.points.tip(2) + hold.points.tip(3)) / 3.0;
    const Vec3 middle = 0.5 * (hold.points.tip(0) + others);
    const Vec3 thumb = (hold.points.tip(0) - others).normalized();
    Vec3 wrist = hold.points.wrist() - middle;
    wrist = (wrist - thumb * thumb.dot(wrist)).normalized();
    Vec3 row = wrist.cross(thumb).normalized();
    if (row.dot(hold.points.tip(1) - hold.points.tip(4)) < 0.0) row = -row;
    const double off = x.dot(middle - box.center());
    const auto feature = [&](grasp::HoldFeature one) {
      return hold.features[static_cast<int>(one)];
    };
    // From the grip to the bar's end that a direction along it points to.
    const auto ahead = [&](const Vec3& way) { return 150.0 - (way.dot(x) > 0.0 ? off : -off); };
    if (std::abs(row.dot(x)) > 0.97) {  // the fingers in line along the bar
      ++in_line;
      EXPECT_NEAR(feature(grasp::HoldFeature::kBeyondThumbSide),
                  std::max(0.0, (ahead(row) - 40.0) / 300.0), 0.06);
      EXPECT_NEAR(std::sqrt(feature(grasp::HoldFeature::kWeightAlong)) * length, std::abs(off),
                  12.0);
    }
    if (std::abs(wrist.dot(x)) > 0.97) {  // the hand comes along the bar
      ++along;
      EXPECT_NEAR(feature(grasp::HoldFeature::kBeyondFingertips),
                  std::max(0.0, (ahead(-wrist) - 30.0) / 300.0), 0.06);
    }
  }
  EXPECT_GT(in_line, 100);
  EXPECT_GT(along, 100);
}

INSTANTIATE_TEST_SUITE_P(Products, OfferedHolds, testing::ValuesIn(products()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palmar::tests
