// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/carried_hold.h"

#include <cmath>
#include <string>

#include "palmar/core/error.h"
#include "palmar/product/parts/part_place.h"

namespace palmar {
namespace {

const ProductPart& part_numbered(const ProductParts& parts, int number) {
  for (const ProductPart& part : parts.parts) {
    if (part.number == number) return part;
  }
  throw UsageError("hold of part " + std::to_string(number) + ": the product has " +
                   std::to_string(parts.parts.size()) + " parts");
}

/// The part whose centre line passes nearest to a point. A part of another kind is taken only if
/// none of the kind passes within its own thickness.
const ProductPart& part_near(const ProductParts& parts, const Vec3& point, PartKind kind) {
  const ProductPart* nearest = nullptr;
  double least = 0.0;
  for (const ProductPart& part : parts.parts) {
    const double distance =
        (part_frame(part, place_of(part, point).along, 0.0).translation - point).norm() +
        (part.kind == kind ? 0.0 : part.thickness);
    if (nearest != nullptr && distance >= least) continue;
    nearest = &part;
    least = distance;
  }
  if (nearest == nullptr) throw UsageError("the product has no part that can be held");
  return *nearest;
}

}  // namespace

Hold carried_hold(const Hold& hold, const ProductParts& before, const ProductParts& after) {
  const ProductPart& from = part_numbered(before, hold.part);
  const Rigid3 place = part_frame(from, hold.along, hold.turn);
  const ProductPart& to = part_near(after, place.translation, from.kind);
  Hold carried = hold;
  carried.part = to.number;
  carried.part_name = to.name;
  carried.along = place_of(to, place.translation).along;
  const Rigid3 zero = part_frame(to, carried.along, 0.0);
  const Vec3 axis = zero.rotation * Vec3::UnitX(), out = place.rotation * Vec3::UnitZ();
  const Vec3 from_zero = zero.rotation * Vec3::UnitZ();
  carried.turn = std::atan2(axis.cross(from_zero).dot(out), from_zero.dot(out));
  if (axis.dot(place.rotation * Vec3::UnitX()) < 0.0) carried.toward = -hold.toward;
  for (HoldFingertip& tip : carried.fingertips) tip.place = place_of(to, point_at(from, tip.place));
  return carried;
}

}  // namespace palmar
