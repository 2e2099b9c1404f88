// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

enum class DimensionKind {
  kHandLength,
  kHandCircumference,
  kHandWidth,
  kHandThickness,
  kSegmentLength,
  kSegmentWidth,
  kSegmentThickness
};

/// One of the 47 dimensions of HandDimensions: the four of the whole hand, the palm's length, and
/// length, width and thickness of the 14 phalanges. (Width and thickness of the palm are those of
/// the hand.) Ordered as all_hand_dimensions() lists them.
struct HandDimension {
  DimensionKind kind = DimensionKind::kHandLength;
  Segment segment = Segment::kPalm;  ///< of the segment kinds; else kPalm
  auto operator<=>(const HandDimension&) const = default;
};

inline constexpr HandDimension kHandLengthDimension{DimensionKind::kHandLength};
inline constexpr HandDimension kCircumferenceDimension{DimensionKind::kHandCircumference};
inline constexpr HandDimension kHandWidthDimension{DimensionKind::kHandWidth};
inline constexpr HandDimension kPalmLengthDimension{DimensionKind::kSegmentLength, Segment::kPalm};

/// All 47, in the order of files and tables.
const std::vector<HandDimension>& all_hand_dimensions();

/// As in files and tables, without unit: "hand_length", "hand_circumference", "hand_width",
/// "hand_thickness", "palm_length", "index_proximal_length", "thumb_distal_thickness".
std::string name_of(HandDimension dimension);
/// The dimension with that name, or nothing.
std::optional<HandDimension> hand_dimension_named(std::string_view name);

/// mm.
double value_of(const HandDimensions& dimensions, HandDimension dimension);
void set_value(HandDimensions& dimensions, HandDimension dimension, double value);

/// A dimension with the size that it is to have or has.
struct SizedDimension {
  HandDimension dimension;
  double value = 0.0;  ///< mm
};

}  // namespace palmar::hand
