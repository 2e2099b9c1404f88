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

/// Its directions as a rotation.
Eigen::Matrix3d frame_of(const HoldAnchor& anchor) {
  Eigen::Matrix3d frame;
  frame.col(0) = anchor.along.normalized();
  frame.col(2) = (anchor.zero - frame.col(0) * frame.col(0).dot(anchor.zero)).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  return frame;
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
  if (!chord) return hold;
  const double cosine = chord->dot(hold.anchor->along);
  if (std::abs(cosine) <= kSameWay) {
    // The file was turned: what is said in its frame turns along with the part.
    Hold turned = hold;
    turned.anchor = anchor_of(hold, parts);
    if (hold.wrist) {
      turned.wrist = frame_of(*turned.anchor) * (frame_of(*hold.anchor).transpose() * *hold.wrist);
    }
    return turned;
  }
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
