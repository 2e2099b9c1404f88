// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/csv_reader.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 30;

std::vector<std::string> split(const CsvFile& file, int line, std::string_view text,
                               char delimiter) {
  std::vector<std::string> result(1);
  bool is_quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_quoted) {
      if (c != '"') {
        result.back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        result.back() += text[++i];
      } else {
        is_quoted = false;
      }
    } else if (c == '"') {
      is_quoted = true;
    } else if (c == delimiter) {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  if (is_quoted) file.fail(line, "a quote is not closed in this line");
  for (std::string& cell : result) cell = trimmed(cell);
  return result;
}

void check_header(const CsvFile& file, CsvStyle style) {
  if (file.header.size() > kMostColumns) {
    file.fail(file.header_line, std::to_string(file.header.size()) + " columns; at most " +
                                    std::to_string(kMostColumns) + " are allowed");
  }
  std::map<std::string, std::size_t> seen;
  for (std::size_t i = 0; i < file.header.size(); ++i) {
    if (file.header[i].empty()) {
      if (style == CsvStyle::kSpreadsheet) continue;
      file.fail(file.header_line, "column " + std::to_string(i + 1) + " has no name");
    }
    const auto [other, is_new] = seen.emplace(lower_case(file.header[i]), i);
    if (!is_new) {
      file.fail(file.header_line, "columns " + std::to_string(other->second + 1) + " and " +
                                      std::to_string(i + 1) + " are both called " +
                                      in_quotes(file.header[i]));
    }
  }
}

}  // namespace

void CsvFile::fail(int line, const std::string& why) const {
  throw InputError(path + ":" + std::to_string(line) + ": " + why);
}

int CsvFile::column(std::string_view name) const {
  const std::string wanted = lower_case(name);
  for (std::size_t i = 0; i < header.size(); ++i) {
    if (lower_case(header[i]) == wanted) return static_cast<int>(i);
  }
  return -1;
}

double CsvFile::number(const Row& row, std::size_t column) const {
  const std::string& cell = row.cells.at(column);
  const std::optional<double> value = parse_double(cell);
  if (!value || !std::isfinite(*value)) {
    fail(row.line, header[column] + " is " + in_quotes(cell) + "; a number is needed" +
                       (cell.find(',') != cell.npos ? " (with a decimal point)" : ""));
  }
  return *value;
}

CsvFile parse_csv(std::string_view text, const std::string& path, CsvStyle style) {
  CsvFile file;
  file.path = path;
  if (!looks_like_text(text.substr(0, 4096))) {
    throw InputError(path + ": no text; a CSV file is needed");
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  TextScanner scanner(text);
  std::optional<char> stated;
  while (const auto line = scanner.next_line()) {
    if (trimmed(*line).empty() || line->front() == '#') continue;
    if (file.header.empty()) {
      if (style == CsvStyle::kSpreadsheet && !stated && line->size() == 5 &&
          lower_case(*line).starts_with("sep=")) {
        stated = line->back();
        continue;
      }
      file.separator = stated                           ? *stated
                       : line->find(';') != line->npos  ? ';'
                       : line->find('\t') != line->npos ? '\t'
                                                        : ',';
      file.header_line = scanner.line();
      file.header = split(file, scanner.line(), *line, file.separator);
      check_header(file, style);
      continue;
    }
    CsvFile::Row row{scanner.line(), split(file, scanner.line(), *line, file.separator)};
    if (row.cells.size() != file.header.size()) {
      file.fail(row.line, "it has " + std::to_string(row.cells.size()) + " cells; the header has " +
                              std::to_string(file.header.size()));
    }
    file.rows.push_back(std::move(row));
  }
  if (file.header.empty()) throw InputError(path + ": it has no header line");
  return file;
}

CsvFile read_csv(const std::string& path) { return parse_csv(read_file(path, kMaxBytes), path); }

}  // namespace palmar::formats
