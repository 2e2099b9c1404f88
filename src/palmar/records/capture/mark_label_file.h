// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/scan/mark_labels.h"
#include "palmar/records/csv.h"

namespace palmar {

/// What a file says of one mark, in its words (below).
struct MarkText {
  std::string posture, mark, name;
  Vec3 point = Vec3::Zero();
  std::string place;  ///< "file:line"
};
/// The same as a label; nothing without a name. `fail` throws what is wrong with where it stands.
std::optional<MarkLabel> mark_label_of(const MarkText& text,
                                       const std::function<void(const std::string&)>& fail);
/// A label in those words; without a segment it is "none".
MarkText mark_text_of(const MarkLabel& label);
/// The name of a mark in such a file: a segment, "wrist"; "" where there is none.
std::string mark_name(MarkLabel::Kind kind, const std::optional<Segment>& segment);

/// Reads what a person says of the marks on scans: CSV with the columns posture, mark, name, x_mm,
/// y_mm, z_mm (scan's own frame). mark: crease, dot, added_crease, added_dot. name: a segment, of a
/// crease the one distal of it or "wrist", of a dot on the back of the hand "palm"; "none" takes
/// the mark away; a row without name changes nothing and is left out. Throws InputError naming
/// file, line and what is allowed or the nearest name.
std::vector<MarkLabel> read_mark_labels(const std::string& path);

/// The same file of marks as they were taken, to be edited; marks that weren't used have no name.
CsvTable mark_table(const std::vector<TakenMark>& marks);

}  // namespace palmar
