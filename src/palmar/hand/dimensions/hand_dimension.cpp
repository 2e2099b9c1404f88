// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/dimensions/hand_dimension.h"

#include <algorithm>

#include "palmar/core/enum_index.h"

namespace palmar::hand {
namespace {

SegmentDimensions& segment_of(HandDimensions& dimensions, HandDimension dimension) {
  return dimensions.segment[index_of(dimension.segment)];
}

// The place where a dimension is kept.
double& place_of(HandDimensions& d, HandDimension dimension) {
  switch (dimension.kind) {
    case DimensionKind::kHandLength:
      return d.hand_length;
    case DimensionKind::kHandCircumference:
      return d.hand_circumference;
    case DimensionKind::kHandWidth:
      return d.hand_width;
    case DimensionKind::kHandThickness:
      return d.hand_thickness;
    case DimensionKind::kSegmentLength:
      return segment_of(d, dimension).length;
    case DimensionKind::kSegmentWidth:
      return segment_of(d, dimension).width;
    case DimensionKind::kSegmentThickness:
      break;
  }
  return segment_of(d, dimension).thickness;
}

std::vector<HandDimension> make_list() {
  std::vector<HandDimension> list = {{DimensionKind::kHandLength},
                                     {DimensionKind::kHandCircumference},
                                     {DimensionKind::kHandWidth},
                                     {DimensionKind::kHandThickness},
                                     {DimensionKind::kSegmentLength, Segment::kPalm}};
  for (const DimensionKind kind : {DimensionKind::kSegmentLength, DimensionKind::kSegmentWidth,
                                   DimensionKind::kSegmentThickness}) {
    for (int s = 1; s < kSegmentCount; ++s) list.push_back({kind, static_cast<Segment>(s)});
  }
  return list;
}

}  // namespace

const std::vector<HandDimension>& all_hand_dimensions() {
  static const std::vector<HandDimension> list = make_list();
  return list;
}

std::string name_of(HandDimension dimension) {
  const std::string segment(name_of(dimension.segment));
  switch (dimension.kind) {
    case DimensionKind::kHandLength:
      return "hand_length";
    case DimensionKind::kHandCircumference:
      return "hand_circumference";
    case DimensionKind::kHandWidth:
      return "hand_width";
    case DimensionKind::kHandThickness:
      return "hand_thickness";
    case DimensionKind::kSegmentLength:
      return segment + "_length";
    case DimensionKind::kSegmentWidth:
      return segment + "_width";
    case DimensionKind::kSegmentThickness:
      break;
  }
  return segment + "_thickness";
}

std::optional<HandDimension> hand_dimension_named(std::string_view name) {
  const auto& list = all_hand_dimensions();
  const auto found =
      std::find_if(list.begin(), list.end(), [&](HandDimension d) { return name_of(d) == name; });
  if (found == list.end()) return std::nullopt;
  return *found;
}

double value_of(const HandDimensions& dimensions, HandDimension dimension) {
  HandDimensions copy = dimensions;
  return place_of(copy, dimension);
}

void set_value(HandDimensions& dimensions, HandDimension dimension, double value) {
  place_of(dimensions, dimension) = value;
}

}  // namespace palmar::hand
