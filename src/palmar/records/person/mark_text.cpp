// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/person/mark_text.h"

#include <fmt/format.h>

#include <vector>

#include "palmar/core/nearest_name.h"

namespace palmar::records {
namespace {

using Kind = hand::MarkLabel::Kind;

constexpr const char* kWrist = "wrist";
constexpr const char* kNone = "none";

/// Names that a mark may have.
std::vector<std::string> names_of(Kind kind) {
  std::vector<std::string> names{
      kind == Kind::kCrease ? kWrist : std::string(name_of(hand::Segment::kPalm)), kNone};
  for (int k = 1; k < hand::kSegmentCount; ++k)
    names.emplace_back(name_of(static_cast<hand::Segment>(k)));
  return names;
}

/// The segment of a name; nothing: no mark. `is_known` is false for what names nothing.
std::optional<hand::Segment> segment_of(const std::string& name, Kind kind, bool& is_known) {
  is_known = true;
  if (name == kNone) return {};
  if (kind == Kind::kCrease && name == kWrist) return hand::Segment::kPalm;
  const auto segment = hand::segment_named(name);
  is_known = segment && (kind == Kind::kDot || *segment != hand::Segment::kPalm);
  return segment;
}

}  // namespace

std::string_view name_of(hand::MarkLabel::Kind kind) {
  return kind == Kind::kCrease ? "crease" : "dot";
}

std::string mark_name(hand::MarkLabel::Kind kind, const std::optional<hand::Segment>& segment) {
  if (!segment) return {};
  return kind == Kind::kCrease && *segment == hand::Segment::kPalm ? kWrist
                                                                   : std::string(name_of(*segment));
}

MarkText mark_text_of(const hand::MarkLabel& label) {
  return {.posture = std::string(name_of(label.posture)),
          .mark = (label.is_added ? "added_" : "") + std::string(name_of(label.kind)),
          .name = label.segment ? mark_name(label.kind, label.segment) : kNone,
          .point = label.point,
          .place = label.place};
}

std::optional<hand::MarkLabel> mark_label_of(const MarkText& text,
                                             const std::function<void(const std::string&)>& fail) {
  hand::MarkLabel label;
  label.place = text.place;
  const auto known = hand::scan_posture_in(text.posture);
  if (!known) {
    fail("\"" + text.posture +
         "\" is no posture; reference, finger_flexion, finger_abduction ... are allowed");
  }
  label.posture = known.value_or(hand::ScanPosture::kReference);
  label.is_added = text.mark == "added_crease" || text.mark == "added_dot";
  if (!label.is_added && text.mark != "crease" && text.mark != "dot") {
    fail("mark \"" + text.mark + "\"; crease, dot, added_crease or added_dot is allowed");
  }
  label.kind = text.mark == "crease" || text.mark == "added_crease" ? Kind::kCrease : Kind::kDot;
  label.point = text.point;
  if (text.name.empty() && !label.is_added) return {};
  bool is_known = true;
  label.segment = segment_of(text.name, label.kind, is_known);
  if (!is_known) {
    fail(fmt::format("\"{}\" names no {}; the nearest name is \"{}\"", text.name,
                     label.kind == Kind::kCrease ? "crease" : "segment with dots",
                     nearest_name(text.name, names_of(label.kind))));
  }
  if (label.is_added && !label.segment) {
    fail("a mark that is added must have a name; \"none\" takes away what was found");
  }
  return label;
}

}  // namespace palmar::records
