// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/carried_hold.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "palmar/core/error.h"
#include "palmar/product/parts/part_place.h"

namespace palmar::grasp {
namespace {

constexpr double kBreadth = 80.0;  // mm, of four fingers; only to tell which part they lie on

const product::ProductPart& part_numbered(const product::ProductParts& parts, int number) {
  for (const product::ProductPart& part : parts.parts) {
    if (part.number == number) return part;
  }
  throw UsageError("hold of part " + std::to_string(number) + ": the product has " +
                   std::to_string(parts.parts.size()) + " parts");
}

/// The middle of a usual hand on the part that it holds: a place that is told by its edge may lie
/// where the next part begins, or beyond it.
Vec3 middle_of_hand(const Hold& hold, const product::ProductPart& part) {
  double along = hold.along;
  if (!hold.is_over_end && part.length > 0.0) {
    along -= hold.toward * hold.edge * kBreadth / part.length;
  }
  if (!part.is_ring) along = std::clamp(along, 0.0, 1.0);
  return product::part_frame(part, along, 0.0).translation;
}

/// From a point to a centre line, not to its lengthened ends, mm: the axis of a screwdriver's shaft
/// goes through the handle, and yet the handle isn't the shaft.
double distance_to_line(const product::ProductPart& part, const Vec3& point) {
  double along = product::place_of(part, point).along;
  if (!part.is_ring) along = std::clamp(along, 0.0, 1.0);
  return (product::part_frame(part, along, 0.0).translation - point).norm();
}

/// The part whose centre line passes nearest to a point. A part of another kind is taken only if
/// none of the kind passes within its own thickness.
const product::ProductPart& part_near(const product::ProductParts& parts, const Vec3& point,
                                      product::PartKind kind) {
  const product::ProductPart* nearest = nullptr;
  double least = 0.0;
  for (const product::ProductPart& part : parts.parts) {
    const double distance =
        distance_to_line(part, point) + (part.kind == kind ? 0.0 : part.thickness);
    if (nearest != nullptr && distance >= least) continue;
    nearest = &part;
    least = distance;
  }
  if (nearest == nullptr) throw UsageError("the product has no part that can be held");
  return *nearest;
}

}  // namespace

Hold carried_hold(const Hold& hold, const product::ProductParts& before,
                  const product::ProductParts& after) {
  const product::ProductPart& from = part_numbered(before, hold.part);
  const geometry::Rigid3 place = product::part_frame(from, hold.along, hold.turn);
  const product::ProductPart& to = part_near(after, middle_of_hand(hold, from), from.kind);
  Hold carried = hold;
  carried.part = to.number;
  carried.part_name = to.name;
  carried.along = product::place_of(to, place.translation).along;
  const geometry::Rigid3 zero = product::part_frame(to, carried.along, 0.0);
  const Vec3 axis = zero.rotation * Vec3::UnitX(), out = place.rotation * Vec3::UnitZ();
  const Vec3 from_zero = zero.rotation * Vec3::UnitZ();
  carried.turn = std::atan2(axis.cross(from_zero).dot(out), from_zero.dot(out));
  if (axis.dot(place.rotation * Vec3::UnitX()) < 0.0) carried.toward = -hold.toward;
  for (HoldFingertip& tip : carried.fingertips)
    tip.place = product::place_of(to, product::point_at(from, tip.place));
  return carried;
}

}  // namespace palmar::grasp
