// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The hold belongs to the product's shape: not to where it lies in its file, how it is meshed, on
// which side the hand is, nor to a hundredth of the hand's size.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "holds/peoples_holds.h"
#include "holds/tried_products.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/hand/instance/scaled_hand.h"
#include "template_fixture.h"

namespace palmar {
namespace {

constexpr double kLawDeg = std::numbers::pi / 180.0;

// Their own mirror images across the held part: both ends of it are the same, so either may come
// first.
bool is_reversible(const std::string& product) {
  static const std::set<std::string> names = {"suitcase", "bucket", "spade", "cube_60mm"};
  return names.contains(product);
}

struct FirstHold {
  bool is_found = false;
  RankedHold ranked;
  double centre = 0.0;  // from the product's middle, mm
};

FirstHold first_hold(const Hand& hand, const Product& product) {
  RankedHolds found = rank_holds(hand, product);
  FirstHold first;
  if (found.holds.empty()) return first;
  first.is_found = true;
  first.ranked = std::move(found.holds.front());
  first.centre = (centre_of(first.ranked) - centre_of_volume(product.mesh)).norm();
  return first;
}

std::string words_of(const FirstHold& first) {
  if (!first.is_found) return "none";
  const Hold& h = first.ranked.hold;
  return fmt::format(
      "{}: part {} ({}), {}, along {:.3f}, toward {:+d}, turn {:.0f} deg, score {:.3f}",
      first.ranked.words, h.part, h.part_name, name_of(h.grip), h.along, h.toward, h.turn / kLawDeg,
      first.ranked.score);
}

// Same part, grip, place and direction. Of fingertips: as far from the product's middle, because
// the part's own length says little where only pads touch.
void expect_same_hold(const FirstHold& a, const FirstHold& b, const std::string& product) {
  SCOPED_TRACE(product + "\n  as it is: " + words_of(a) + "\n  this way: " + words_of(b));
  ASSERT_TRUE(a.is_found);
  ASSERT_TRUE(b.is_found);
  const Hold &p = a.ranked.hold, &q = b.ranked.hold;
  EXPECT_EQ(p.part, q.part);
  EXPECT_EQ(p.part_name, q.part_name);
  EXPECT_EQ(p.grip, q.grip);
  if (!is_power(p.grip)) {
    EXPECT_EQ(p.fingertips.size(), q.fingertips.size());
    EXPECT_NEAR(a.centre, b.centre, 3.0);  // mm, the finest lattice's step
    return;
  }
  const bool is_same = p.toward == q.toward && std::abs(p.along - q.along) <= 0.02;
  const bool is_reverse = is_reversible(product) && p.toward == -q.toward &&
                          std::abs(p.along - (1.0 - q.along)) <= 0.02;
  EXPECT_TRUE(is_same || is_reverse);
}

class LawsOfHolds : public TemplateTest, public testing::WithParamInterface<std::string> {
 protected:
  static const Product& as_it_is() {
    static std::map<std::string, Product> known;
    const auto found = known.find(GetParam());
    return found != known.end()
               ? found->second
               : known.emplace(GetParam(), tried_product(GetParam())).first->second;
  }
  static const FirstHold& first() {
    static std::map<std::string, FirstHold> known;
    const auto found = known.find(GetParam());
    return found != known.end()
               ? found->second
               : known.emplace(GetParam(), first_hold(hand(), as_it_is())).first->second;
  }
};

TEST_P(LawsOfHolds, StayWhenTheProductIsShiftedAndTurnedALittle) {
  const Rigid3 motion = {Quat(Eigen::AngleAxisd(5.0 * kLawDeg, Vec3(0.6, -0.48, 0.64))),
                         Vec3(100.0, 0.0, 0.0)};
  expect_same_hold(first(), first_hold(hand(), moved(as_it_is(), motion)), GetParam());
}

TEST_P(LawsOfHolds, StayWhenTheProductIsTurnedAnyhow) {
  const Rigid3 motion = {Quat(Eigen::AngleAxisd(2.2, Vec3(0.36, 0.48, -0.8))),
                         Vec3(-40.0, 25.0, 310.0)};
  expect_same_hold(first(), first_hold(hand(), moved(as_it_is(), motion)), GetParam());
}

TEST_P(LawsOfHolds, StayOnAMeshWithHalfTheEdgeLength) {
  expect_same_hold(first(), first_hold(hand(), with_finer_mesh(GetParam())), GetParam());
}

TEST_P(LawsOfHolds, StayOnAMeshWithDoubleTheEdgeLength) {
  expect_same_hold(first(), first_hold(hand(), with_coarser_mesh(GetParam())), GetParam());
}

TEST_P(LawsOfHolds, StayWhenTrianglesAreShuffled) {
  expect_same_hold(first(), first_hold(hand(), shuffled(as_it_is())), GetParam());
}

TEST_P(LawsOfHolds, AreMirroredWithProductAndHand) {
  const FirstHold mirror = first_hold(mirrored(hand()), mirrored(as_it_is()));
  expect_same_hold(first(), mirror, GetParam());
  if (!first().is_found || !mirror.is_found) return;
  const Grasp &right = first().ranked.grasp, &left = mirror.ranked.grasp;
  for (std::size_t d = 0; d < right.posture.angle.size(); ++d) {
    EXPECT_NEAR(left.posture.angle[d], right.posture.angle[d], 1e-4)  // rad
        << name_of(static_cast<Dof>(d));
  }
}

TEST_P(LawsOfHolds, StayInAHandOneHundredthLarger) {
  expect_same_hold(first(), first_hold(scaled(hand(), 1.01), as_it_is()), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Products, LawsOfHolds, testing::ValuesIn(tried_products()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palmar
