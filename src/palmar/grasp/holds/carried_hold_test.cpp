// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/carried_hold.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/product/primitives.h"

namespace palmar::grasp {
namespace {

product::ProductParts bar(double width, double depth) {
  product::PrismProductOptions options;
  options.width = width;
  options.depth = depth;
  options.length = 130.0;
  options.fillet_radius = 4.0;
  return product::find_parts(product::make_prism_product(options));
}

/// The same part told from its other end and with turns from another side.
product::ProductParts told_otherwise(product::ProductParts parts, double zero_turned) {
  product::ProductPart& part = parts.parts.front();
  std::reverse(part.line.begin(), part.line.end());
  for (product::PartStation& station : part.line) {
    station.along = 1.0 - station.along;
    station.axis = -station.axis;
    station.zero = Eigen::AngleAxisd(zero_turned, station.axis) * station.zero;
  }
  return parts;
}

void expect_same_way(const Hold& a, const product::ProductParts& in_a, const Hold& b,
                     const product::ProductParts& in_b, double near) {
  const geometry::Rigid3 x =
      product::part_frame(in_a.parts[static_cast<std::size_t>(a.part - 1)], a.along, a.turn);
  const geometry::Rigid3 y =
      product::part_frame(in_b.parts[static_cast<std::size_t>(b.part - 1)], b.along, b.turn);
  EXPECT_NEAR((x.translation - y.translation).norm(), 0.0, near);
  EXPECT_NEAR((x.rotation * Vec3::UnitZ()).dot(y.rotation * Vec3::UnitZ()), 1.0, 1e-6);
  EXPECT_NEAR(
      (a.toward * (x.rotation * Vec3::UnitX())).dot(b.toward * (y.rotation * Vec3::UnitX())), 1.0,
      1e-6);
}

TEST(CarriedHold, LooksTheSameWayWhateverThePartsCoordinates) {
  const product::ProductParts before = bar(30.0, 40.0);
  Hold hold;
  hold.along = 0.4;
  hold.turn = 0.7;
  hold.toward = -1;
  for (const double turned : {0.0, 1.0, 3.0}) {
    const product::ProductParts after = told_otherwise(before, turned);
    expect_same_way(hold, before, carried_hold(hold, before, after), after, 1e-6);
  }
}

TEST(CarriedHold, FollowsABarWhoseWideSideBecameTheNarrowOne) {
  const product::ProductParts before = bar(30.0, 40.0), after = bar(44.0, 34.0);
  Hold hold;
  hold.along = 0.6;
  hold.turn = -1.2;
  expect_same_way(hold, before, carried_hold(hold, before, after), after, 0.5);
}

/// A straight bar along z, from one height to another, `aside` beside the axis.
product::ProductPart straight_bar(int number, double from, double to, double aside) {
  product::ProductPart part;
  part.number = number;
  part.kind = product::PartKind::kBar;
  part.length = std::abs(to - from);
  for (const double along : {0.0, 1.0}) {
    product::PartStation station;
    station.along = along;
    station.centre = Vec3(aside, 0.0, from + along * (to - from));
    station.axis = Vec3(0.0, 0.0, to > from ? 1.0 : -1.0);
    station.zero = Vec3::UnitX();
    part.line.push_back(station);
  }
  return part;
}

TEST(CarriedHold, AHandleIsNotTheShaftWhoseAxisGoesThroughIt) {
  // A screwdriver; the redesign's middle is half a millimetre off the shaft's axis.
  product::ProductParts before, after;
  before.parts = {straight_bar(1, 0.0, 100.0, 0.0), straight_bar(2, 250.0, 100.0, 0.0)};
  after.parts = {straight_bar(1, 0.0, 100.0, 0.5), straight_bar(2, 250.0, 100.0, 0.0)};
  Hold hold;
  hold.along = 0.5;
  EXPECT_EQ(carried_hold(hold, before, after).part, 1);
  // The index finger's edge where the shaft begins, or 12 mm beyond it: the hand is on the handle.
  hold.edge = 0.5;
  for (const double along : {1.0, 1.12}) {
    hold.along = along;
    const Hold carried = carried_hold(hold, before, after);
    EXPECT_EQ(carried.part, 1) << along;
    EXPECT_NEAR(carried.along, along, 1e-9);
  }
  // A hand on the shaft stays on it.
  hold = {};
  hold.part = 2;
  EXPECT_EQ(carried_hold(hold, before, after).part, 2);
}

TEST(CarriedHold, SaysThatThereIsNoSuchPart) {
  Hold hold;
  hold.part = 3;
  const product::ProductParts parts = bar(30.0, 40.0);
  EXPECT_THROW(carried_hold(hold, parts, parts), UsageError);
  hold.part = 1;
  EXPECT_THROW(carried_hold(hold, parts, product::ProductParts{}), UsageError);
}

}  // namespace
}  // namespace palmar::grasp
