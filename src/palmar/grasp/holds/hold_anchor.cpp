// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/hold_anchor.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "palmar/geometry/degrees.h"
#include "palmar/grasp/holds/hold_site.h"
#include "palmar/product/parts/part_place.h"

namespace palmar::grasp {
namespace {

const double kSameWay = std::cos(20.0 * geometry::kDegree);  // choice; versions differ by less
constexpr double kShortest = 1e-3;                           // mm; a unit of rounding
constexpr double kSameTurn = 1e-6;  // rad; a unit of rounding: the product that it was found on

/// From the beginning of a part's line to its end; nothing of a ring.
std::optional<Vec3> chord_of(const product::ProductPart& part) {
  if (part.is_ring || part.line.size() < 2) return std::nullopt;
  const Vec3 chord = part.line.back().centre - part.line.front().centre;
  if (chord.norm() < kShortest) return std::nullopt;
  return chord.normalized();
}

}  // namespace

std::optional<HoldAnchor> anchor_of(const Hold& hold, const product::ProductParts& parts) {
  const product::ProductPart& part = part_of(hold, parts);
  const std::optional<Vec3> chord = chord_of(part);
  if (!chord) return std::nullopt;
  return HoldAnchor{*chord, product::part_frame(part, hold.along, 0.0).rotation * Vec3::UnitZ()};
}

Hold as_anchored(const Hold& hold, const product::ProductParts& parts) {
  if (!hold.anchor) return hold;
  const product::ProductPart& part = part_of(hold, parts);
  const std::optional<Vec3> chord = chord_of(part);
  const double cosine = chord ? chord->dot(hold.anchor->along) : 0.0;
  if (std::abs(cosine) <= kSameWay) return hold;
  const bool is_reversed = cosine < 0.0;
  const auto mirrored = [&](double along) { return is_reversed ? 1.0 - along : along; };
  // Where its turn 0 is among this part's turns; these go the other way round if it is reversed.
  const geometry::Rigid3 frame = product::part_frame(part, mirrored(hold.along), 0.0);
  const Vec3 axis = frame.rotation * Vec3::UnitX(), zero = frame.rotation * Vec3::UnitZ();
  const Vec3& from = hold.anchor->zero;
  const double first = std::atan2(axis.dot(zero.cross(from)), zero.dot(from));
  if (!is_reversed && std::abs(first) < kSameTurn) return hold;
  const auto turned = [&](double turn) {
    return std::remainder(first + (is_reversed ? -turn : turn), 2.0 * std::numbers::pi);
  };
  Hold result = hold;
  result.along = mirrored(hold.along);
  result.turn = turned(hold.turn);
  if (is_reversed) result.toward = -hold.toward;
  for (HoldFingertip& tip : result.fingertips) {
    tip.place.along = mirrored(tip.place.along);
    tip.place.turn = turned(tip.place.turn);
  }
  result.anchor = anchor_of(result, parts);
  return result;
}

}  // namespace palmar::grasp
