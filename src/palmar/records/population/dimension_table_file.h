// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/population/dimension_table.h"

namespace palmar::records {

struct TableReading {
  std::string unit;  ///< of lengths whose heading names none: "mm", "cm" ...; "": that is an error
  void check() const;  ///< throws UsageError naming the unit and what is allowed
};

/// A table of subjects: one line per person under one heading line, cells separated by comma,
/// semicolon or tab (formats/csv_reader.h). Headings carry the unit: "hand_length_mm", "Hand length
/// [mm]", "handlength (cm)"; usual names mean our dimensions (population/column_heading.h), other
/// columns keep their own. A column whose heading has a unit holds numbers; one without is text
/// unless every cell is a number. Missing: nothing, NA, N/A, NaN, null, - or a point. Where cells
/// aren't separated by commas, a comma may stand for the decimal point.
///
/// Throws InputError naming file, line and column: what formats/csv_reader.h refuses; text or
/// infinity where a number is needed; a length of 0 or less; a dimension without unit, twice, or of
/// a size that no hand has (naming the unit that would fit); a column with cells but without name;
/// no subject; more than 64 MB. A palm length that isn't Palmar's (population/palm_ruler.h) is
/// reported in the notes.
population::DimensionTable read_dimension_table(const std::string& path,
                                                const TableReading& reading = {});
population::DimensionTable parse_dimension_table(std::string_view text, const std::string& path,
                                                 const TableReading& reading = {});

}  // namespace palmar::records
