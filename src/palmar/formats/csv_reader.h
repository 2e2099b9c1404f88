// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace palmar::formats {

/// A CSV file taken apart: one header line, then rows of as many cells. Cells are separated by
/// comma, semicolon or tab, whichever the header has, quoted as in RFC 4180 but within one line,
/// and trimmed; lines that start with # are comments, blank lines are skipped.
struct CsvFile {
  struct Row {
    int line = 0;  ///< in the file, from 1
    std::vector<std::string> cells;
  };
  std::string path;
  char separator = ',';
  int header_line = 0;
  std::vector<std::string> header;
  std::vector<Row> rows;

  /// Ends with an InputError "path:line: why".
  [[noreturn]] void fail(int line, const std::string& why) const;
  /// Column of that name (case doesn't matter), or -1.
  int column(std::string_view name) const;
  /// The finite number in a cell. Throws InputError naming file, line, column and cell.
  double number(const Row& row, std::size_t column) const;
};

/// kStrict: every column has a name. kSpreadsheet: as programs write tables for people, where
/// columns may lack a name (row numbers, empty columns at the end) and a first line "sep=;" shows
/// the separator.
enum class CsvStyle { kStrict, kSpreadsheet };

inline constexpr std::size_t kMostColumns = 10'000;  ///< of a CSV file

/// Throws InputError naming file and line: no text, no header, more than kMostColumns, a row longer
/// or shorter than the header, a quote that isn't closed, a column twice or (kStrict) without a
/// name.
CsvFile parse_csv(std::string_view text, const std::string& path,
                  CsvStyle style = CsvStyle::kStrict);
CsvFile read_csv(const std::string& path);

}  // namespace palmar::formats
