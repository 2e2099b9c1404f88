// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "palmar/hand/person/person_labels.h"

namespace palmar::records {

/// What a file says of one mark, in its words:
/// posture "reference" ..., mark "crease", "dot", "added_crease" or "added_dot", name of a segment,
/// "wrist" of a crease, "none" for what is no mark.
struct MarkText {
  std::string posture, mark, name;
  Vec3 point = Vec3::Zero();
  std::string place;  ///< "file:line"
};
/// The same as a label; nothing without a name. `fail` throws what is wrong with where it stands.
std::optional<hand::MarkLabel> mark_label_of(const MarkText& text,
                                             const std::function<void(const std::string&)>& fail);
/// A label in those words; without a segment it is "none".
MarkText mark_text_of(const hand::MarkLabel& label);
/// The name of a mark in such a file: a segment, "wrist"; "" where there is none.
std::string mark_name(hand::MarkLabel::Kind kind, const std::optional<hand::Segment>& segment);

/// "crease" or "dot".
std::string_view name_of(hand::MarkLabel::Kind kind);

}  // namespace palmar::records
