// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_anchor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/product/parts/part_place.h"

namespace palmar::grasp {
namespace {

/// A straight part of 120 mm along z whose turns are counted from `zero` (rad about z from x).
product::ProductParts stick(double zero, bool is_reversed) {
  product::ProductParts parts;
  product::ProductPart& part = parts.parts.emplace_back();
  part.number = 1;
  part.name = "handle";
  part.length = 120.0;
  for (const double along : {0.0, 0.5, 1.0}) {
    product::PartStation station;
    station.along = along;
    station.centre = Vec3(5.0, 0.0, 120.0 * (is_reversed ? 1.0 - along : along));
    station.axis = (is_reversed ? -1.0 : 1.0) * Vec3::UnitZ();
    station.zero = Vec3(std::cos(zero), std::sin(zero), 0.0);
    part.line.push_back(station);
  }
  return parts;
}

struct Where {
  Vec3 point, palm, thumb;
};

Where where(const Hold& hold, const product::ProductParts& parts) {
  const geometry::Rigid3 frame = product::part_frame(parts.parts[0], hold.along, hold.turn);
  return {frame.translation, frame.rotation * Vec3::UnitZ(),
          hold.toward * (frame.rotation * Vec3::UnitX())};
}

Hold found_on(const product::ProductParts& parts) {
  Hold hold;
  hold.along = 0.3;
  hold.toward = 1;
  hold.turn = 0.7;
  hold.anchor = anchor_of(hold, parts);
  return hold;
}

TEST(HoldAnchor, MeansTheSameWhereTheNextVersionIsCountedOtherwise) {
  const product::ProductParts first = stick(0.2, false);
  const Hold hold = found_on(first);
  const Where before = where(hold, first);
  for (const bool is_reversed : {false, true}) {
    for (const double zero : {-2.5, 0.2, 1.1, 3.0}) {
      const product::ProductParts next = stick(zero, is_reversed);
      const Hold same = as_anchored(hold, next);
      const Where after = where(same, next);
      EXPECT_LT((after.point - before.point).norm(), 1e-9);
      EXPECT_LT((after.palm - before.palm).norm(), 1e-9);
      EXPECT_LT((after.thumb - before.thumb).norm(), 1e-9);
      // Once more it changes nothing.
      const Hold again = as_anchored(same, next);
      EXPECT_EQ(again.turn, same.turn);
      EXPECT_EQ(again.along, same.along);
    }
  }
}

TEST(HoldAnchor, FingertipsGoWhereTheyWere) {
  const product::ProductParts first = stick(0.2, false), next = stick(-1.0, true);
  Hold hold = found_on(first);
  hold.grip = Grip::kPalmarPinch;
  hold.fingertips = {{hand::Finger::kThumb, {.along = 0.25, .turn = 0.4, .height = 12.0}},
                     {hand::Finger::kIndex, {.along = 0.35, .turn = -2.6, .height = 11.0}}};
  const Hold same = as_anchored(hold, next);
  for (std::size_t k = 0; k < 2; ++k) {
    const Vec3 before = product::point_at(first.parts[0], hold.fingertips[k].place);
    EXPECT_LT((product::point_at(next.parts[0], same.fingertips[k].place) - before).norm(), 1e-9);
  }
}

TEST(HoldAnchor, OnTheProductThatItWasFoundOnNotABitChanges) {
  const product::ProductParts parts = stick(0.2, false);
  const Hold hold = found_on(parts), same = as_anchored(hold, parts);
  EXPECT_EQ(same.turn, hold.turn);
  EXPECT_EQ(same.along, hold.along);
  EXPECT_EQ(same.toward, hold.toward);
}

TEST(HoldAnchor, AFileThatWasTurnedIsHeldByThePartsOwnCoordinates) {
  const product::ProductParts first = stick(0.2, false);
  product::ProductParts turned = stick(1.5, true);
  for (product::PartStation& station : turned.parts[0].line) {
    std::swap(station.centre.x(), station.centre.z());
    std::swap(station.axis.x(), station.axis.z());
    std::swap(station.zero.x(), station.zero.z());
  }
  // x and z are swapped and turns begin 1.3 rad further on, from the other end.
  Hold hold = found_on(first);
  const Where before = where(hold, first);
  hold.wrist = (0.8 * before.palm - 0.6 * before.thumb).normalized();
  const Hold same = as_anchored(hold, turned);
  const Where after = where(same, turned);
  ASSERT_TRUE(same.wrist.has_value());
  EXPECT_LT((*same.wrist - (0.8 * after.palm - 0.6 * after.thumb).normalized()).norm(), 1e-9);
  EXPECT_EQ(same.turn, hold.turn);
  EXPECT_EQ(same.along, hold.along);
  EXPECT_EQ(same.toward, hold.toward);
  Hold unsaid = hold;
  unsaid.anchor.reset();
  EXPECT_EQ(as_anchored(unsaid, stick(1.5, true)).along, hold.along);
}

}  // namespace
}  // namespace palmar::grasp
