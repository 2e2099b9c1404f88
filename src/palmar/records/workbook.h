// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/records/csv.h"

namespace palmar::records {

/// One sheet of a workbook: a table as in a CSV file, its columns named with units at their end
/// ("force_n", "contact_area_mm2").
struct WorkbookSheet {
  std::string name;   ///< as its tab: at most 31 letters, the rest is cut; none of []:*?/\ is kept
  std::string about;  ///< what a row is, a sentence
  CsvTable table;
};

/// A column's name in words and its unit: "peak_pressure_cells_mpa" -> "peak pressure cells",
/// "MPa"; without a unit the second is empty.
struct ColumnWords {
  std::string words;
  std::string unit;
};
ColumnWords words_of_column(const std::string& column);

/// An Excel workbook (Office Open XML, ISO/IEC 29500-1, spreadsheetml) with a first sheet "About":
/// title, notes line by line, what each sheet is, and every column's name, unit and sheet. Then the
/// sheets: names of columns in words with their unit in square brackets in the first row, which
/// stays in view and can be filtered by; numbers in full digits, shown with as many as make sense
/// for their unit. Same sheets, same bytes. Throws UsageError if there is no sheet.
std::string format_workbook(const std::string& title, const std::vector<std::string>& notes,
                            const std::vector<WorkbookSheet>& sheets);

/// The table with every number that isn't whole shortened to so many significant digits (1 to 15),
/// for reading: 12.3456 -> 12.3. Whole numbers and other text stay.
CsvTable rounded_table(CsvTable table, int significant = 3);

}  // namespace palmar::records
