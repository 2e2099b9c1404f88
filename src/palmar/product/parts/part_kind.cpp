// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_kind.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar::product {
namespace {

// A hand closes round what isn't thicker than this, mm: thumb and middle finger of an average hand
// meet on about 45 to 50 mm. Choice.
constexpr double kGripDiameter = 45.0;
constexpr double kFlat = 0.4;         // thickness / width, from which on a thing is flat
constexpr double kPlateWidth = 40.0;  // mm; two fingers; narrower flat things are bars
constexpr double kPenThinnest = 4.0, kPenThickest = 20.0;  // mm; pencils 7, thick markers 20
constexpr double kPenSlender = 5.0;                        // length / diameter of a pen at least
constexpr double kPenStraight = 0.99;
constexpr double kBarSlender = 1.4;  // length / diameter of a bar at least
// Farthest point of a ball's surface from its middle / root mean square distance at most: a
// cylinder as long as thick has 1.20, a cube 1.34, an ellipsoid of 1 : 1 : 1.2 1.12.
constexpr double kRound = 1.15;
// Diameters of handles, mm: 19.7 % of hand length is best (Kong, Lowe 2005), 37 mm of 190 mm. From
// less than half of it (choice) to where the hand doesn't close.
constexpr double kHandleThinnest = 14.0;
constexpr double kHandleLength = 60.0;  // mm; three fingers
constexpr double kKnob = 60.0;          // mm; larger balls are grasped by themselves

bool is_plate(double thickness, double width, double length) {
  return thickness < kFlat * width && width >= kPlateWidth && length >= kPlateWidth;
}

}  // namespace

bool is_bar_by_size(const ProductPart& part) {
  return part.diameter() <= kGripDiameter && part.length >= kBarSlender * part.diameter();
}

PartKind kind_of(const ProductPart& part, const PartShape& shape) {
  const double diameter = part.diameter();
  if (shape.has_line) {
    if (part.opening && diameter <= kGripDiameter) return PartKind::kLoop;
    const bool is_flat = is_plate(part.thickness, part.width, part.length);
    if (!is_flat && is_bar_by_size(part)) {
      if (shape.joints == 0 && diameter >= kPenThinnest && diameter <= kPenThickest &&
          part.length >= kPenSlender * diameter && part.straightness >= kPenStraight) {
        return PartKind::kPen;
      }
      return PartKind::kBar;
    }
    if (is_flat) return PartKind::kPlate;
  }
  // Of something flat, the two extents across its faces are those of the other axes.
  if (is_plate(std::min(shape.across_faces, shape.extent[2]), shape.extent[1], shape.extent[0])) {
    return PartKind::kPlate;
  }
  if (shape.roundness <= kRound) return PartKind::kBall;
  return PartKind::kBody;
}

void name_parts(std::vector<ProductPart>& parts) {
  for (ProductPart& part : parts) {
    part.name = name_of(part.kind);
    const double diameter = part.diameter();
    const auto is_on_thicker = [&] {
      return part.joined.size() == 1 && parts[part.joined[0] - 1].diameter() > 1.4 * diameter;
    };
    if (part.kind == PartKind::kLoop) {
      part.name = part.is_ring ? "ring" : "loop handle";
    } else if (part.kind == PartKind::kBall && !part.joined.empty() && part.length <= kKnob) {
      part.name = "knob";
    } else if (part.kind == PartKind::kBar) {
      if (is_on_thicker() && part.length < 2.0 * diameter && part.length < kHandleLength) {
        part.name = "neck";
      } else if (diameter < kHandleThinnest) {
        part.name = "shaft";
      } else if (part.length >= kHandleLength) {
        part.name = "handle";
      }
    } else if (part.kind == PartKind::kBody && !part.joined.empty()) {
      // The head of a tool: what sits at the end of a longer handle.
      for (const int other : part.joined) {
        const ProductPart& bar = parts[other - 1];
        if (parts.size() == 2 && bar.kind == PartKind::kBar && bar.length > part.length) {
          part.name = "head";
        }
      }
    }
  }
}

}  // namespace palmar::product
