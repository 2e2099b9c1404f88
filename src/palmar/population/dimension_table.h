// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/joint_strength.h"
#include "palmar/population/column_heading.h"

namespace palmar::population {

/// One column of a table of subjects.
struct TableColumn {
  std::string name;    ///< of our dimension, else the table's own in small_letters
  std::string header;  ///< as in the file
  int number = 0;      ///< of the column in the file, from 1
  std::optional<hand::HandDimension> dimension;
  Quantity quantity = Quantity::kOther;
  std::string unit;        ///< "mm" of lengths, "years" of ages, else the table's own or ""
  bool is_number = false;  ///< `values` holds the cells; else `texts`
  std::vector<std::optional<double>> values;  ///< per subject; nothing: missing
  std::vector<std::string> texts;             ///< per subject; "": missing
};

/// People in rows, what was measured on them in columns. Lengths are in mm whatever unit the file
/// had (records/population/dimension_table_file.h reads it).
struct DimensionTable {
  std::string source;      ///< file, for messages
  int header_line = 1;     ///< of the file
  std::vector<int> lines;  ///< of the subjects in the file
  std::vector<TableColumn> columns;
  std::vector<std::string> notes;  ///< for the user: converted units, columns left aside

  int subjects() const { return static_cast<int>(lines.size()); }
  /// The column called `name`, by ours or the file's heading or a usual synonym; throws UsageError
  /// naming what the table has and the nearest name.
  const TableColumn& column(const std::string& name) const;
  /// Columns of lengths, then of other numbers, in the order of the file; no age, no labels.
  std::vector<const TableColumn*> measures() const;
  /// Ends with an InputError "file:line: column 3 (hand_width): why"; line 0: the header's.
  [[noreturn]] void fail(int line, const TableColumn& column, const std::string& why) const;
};

/// "sex=F", "age>=40", "hand_length!=190": text or numbers for = and != (letters' case doesn't
/// matter), numbers for <, <=, >, >=. Subjects whose cell is missing never meet it. Throws
/// UsageError naming the condition: not understood, no such column, no subject left.
DimensionTable where(const DimensionTable& table, const std::string& condition);

/// Only the subjects that have a value in each of these columns; perhaps none.
DimensionTable having(const DimensionTable& table, const std::vector<std::string>& names);

struct TableGroup {
  std::string name;  ///< the cell's text; "20-29" of ages; "all" without groups
  DimensionTable table;
};
/// The table separated by a column, groups in the order of their names (numbers by size), ages by
/// ten years; `by` empty: one group "all". Subjects whose cell is missing are left out and reported
/// in `notes`. Throws UsageError if there are more than 50 groups or none.
std::vector<TableGroup> grouped(const DimensionTable& table, const std::string& by,
                                std::vector<std::string>& notes);

}  // namespace palmar::population
