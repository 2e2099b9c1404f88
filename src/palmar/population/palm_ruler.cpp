// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/palm_ruler.h"

#include <array>
#include <cstdio>

#include "palmar/population/segment_regressions.h"

namespace palmar::population {
namespace {

const TableColumn* numbers_named(const DimensionTable& table, const std::string& name) {
  for (const TableColumn& column : table.columns) {
    if (column.is_number && column.name == name) return &column;
  }
  return nullptr;
}

std::string percent(double share) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f %%", 100.0 * share);
  return text.data();
}

}  // namespace

double template_palm_share() {
  const hand::HandDimensions& hand = template_proportions();
  return hand::value_of(hand, {hand::DimensionKind::kSegmentLength, hand::Segment::kPalm}) /
         hand.hand_length;
}

std::optional<double> palm_share(const DimensionTable& table) {
  const TableColumn* palm = numbers_named(table, kPalmLength);
  const TableColumn* length = numbers_named(table, "hand_length");
  if (palm == nullptr || length == nullptr) return std::nullopt;
  double palms = 0.0, lengths = 0.0;
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    if (!palm->values[row] || !length->values[row]) continue;
    palms += *palm->values[row];
    lengths += *length->values[row];
  }
  if (!(lengths > 0.0)) return std::nullopt;
  return palms / lengths;
}

std::string palm_warning(const DimensionTable& table) {
  const auto share = palm_share(table);
  if (!share || *share <= kLargestPalmShare) return "";
  const TableColumn& palm = *numbers_named(table, kPalmLength);
  return "column " + std::to_string(palm.number) + " (" + palm.header + ") is " + percent(*share) +
         " of hand length on average; from the wrist crease to the base crease of the middle "
         "finger, as Palmar measures palm_length, it is about " +
         percent(template_palm_share()) +
         ". Hands made to it get fingers too short: leave the column out, or draw from `palmar "
         "population regress --population-out`, which brings it into proportion";
}

}  // namespace palmar::population
