// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/scan/mark_labels.h"
#include "palmar/records/csv.h"
#include "palmar/records/person/mark_text.h"

namespace palmar::person_records {

/// Reads what a person says of the marks on scans: CSV with the columns posture, mark, name, x_mm,
/// y_mm, z_mm (scan's own frame). mark: crease, dot, added_crease, added_dot. name: a segment, of a
/// crease the one distal of it or "wrist", of a dot on the back of the hand "palm"; "none" takes
/// the mark away; a row without name changes nothing and is left out. Throws InputError naming
/// file, line and what is allowed or the nearest name.
std::vector<hand::MarkLabel> read_mark_labels(const std::string& path);

/// The same file of marks as they were taken, to be edited; marks that weren't used have no name.
records::CsvTable mark_table(const std::vector<capture::TakenMark>& marks);

}  // namespace palmar::person_records
