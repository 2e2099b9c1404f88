// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/population/dimension_table_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/population/palm_ruler.h"
#include "palmar/statistics/summary.h"

namespace palmar::records {
namespace {

constexpr std::uint64_t kMaxTableBytes = std::uint64_t{64} << 20;
constexpr double kLargestLength = 1e5;  // mm; stature and reach may stand beside hands

bool is_missing(const std::string& cell) {
  const std::string text = lower_case(cell);
  for (const char* word : {"", "na", "n/a", "#n/a", "nan", "null", "-", "--", "\u2013", "."}) {
    if (text == word) return true;
  }
  return false;
}

/// One column of the file on its way into the table.
class ColumnReader {
 public:
  ColumnReader(const formats::CsvFile& file, const std::vector<const formats::CsvFile::Row*>& rows,
               std::size_t place)
      : file_(file), rows_(rows), place_(place) {}

  const std::string& cell(std::size_t row) const { return rows_[row]->cells[place_]; }

  [[noreturn]] void fail(int line, const std::string& why) const {
    file_.fail(line,
               "column " + std::to_string(place_ + 1) + " (" + file_.header[place_] + "): " + why);
  }

  bool is_empty() const {
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (!cell(row).empty()) return false;
    }
    return true;
  }

  /// The number in a cell; nothing if there is none.
  std::optional<double> number(std::size_t row) {
    std::string text = cell(row);
    const auto comma = text.find(',');
    if (comma != text.npos && file_.separator != ',' && text.find('.') == text.npos) {
      text[comma] = '.';
      has_comma_ = true;
    } else if (text.find('.') != text.npos) {
      point_line_ = rows_[row]->line;
    }
    const auto value = formats::parse_double(text);
    if (!value || !std::isfinite(*value)) return std::nullopt;
    return value;
  }

  /// How many cells are filled, and how many of them with numbers.
  std::pair<int, int> counts() {
    std::pair<int, int> result;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (is_missing(cell(row))) continue;
      ++result.first;
      if (number(row)) ++result.second;
    }
    return result;
  }

  /// Line of the first cell that is neither missing nor a number.
  int first_text_line() {
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (!is_missing(cell(row)) && !number(row)) return rows_[row]->line;
    }
    return 0;
  }

  std::vector<std::optional<double>> numbers(double factor, double low, double high,
                                             const std::string& allowed) {
    std::vector<std::optional<double>> values;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      if (is_missing(cell(row))) {
        values.emplace_back();
        continue;
      }
      const auto value = number(row);
      if (!value) {
        fail(rows_[row]->line, formats::in_quotes(cell(row)) + " is no number" + hint(cell(row)) +
                                   "; a number is needed, or NA");
      }
      if (!(*value * factor > low && *value * factor < high)) {
        fail(rows_[row]->line, cell(row) + "; " + allowed);
      }
      values.emplace_back(*value * factor);
    }
    if (has_comma_ && point_line_ > 0) {
      fail(point_line_, "a decimal point where other cells have a decimal comma");
    }
    return values;
  }

  std::vector<std::string> texts() const {
    std::vector<std::string> result;
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      result.push_back(is_missing(cell(row)) ? "" : cell(row));
    }
    return result;
  }

 private:
  std::string hint(const std::string& text) const {
    if (text.find(',') != text.npos && file_.separator == ',') {
      return " (decimal commas need cells separated by semicolons)";
    }
    if (!text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0 &&
        std::isalpha(static_cast<unsigned char>(text.back())) != 0) {
      return " (a unit belongs into the heading)";
    }
    return "";
  }

  const formats::CsvFile& file_;
  const std::vector<const formats::CsvFile::Row*>& rows_;
  std::size_t place_;
  bool has_comma_ = false;
  int point_line_ = 0;
};

bool is_segment_length(const population::TableColumn& column) {
  return column.dimension && column.dimension->kind == hand::DimensionKind::kSegmentLength;
}

/// Sizes that no hand has: in the wrong unit if half of them are, else single ones.
void check_sizes(const population::DimensionTable& table, const population::TableColumn& column,
                 double factor) {
  const auto range = population::size_range(column.name);
  if (!range) return;
  std::vector<double> sizes;
  for (const auto& value : column.values) {
    if (value) sizes.push_back(*value);
  }
  if (sizes.empty()) return;
  std::sort(sizes.begin(), sizes.end());
  const double median = statistics::quantile(sizes, 0.5);
  const std::string allowed =
      significant(range->low, 4) + " to " + significant(range->high, 4) + " mm";
  if (median < range->low || median > range->high) {
    std::string fitting;
    for (const char* unit : {"mm", "cm", "in", "m"}) {
      const double size = median / factor * geometry::millimetres_per(geometry::length_unit(unit));
      if (size >= range->low && size <= range->high && fitting.empty()) fitting = unit;
    }
    table.fail(
        0, column,
        "the median is " + significant(median, 4) + " mm; a hand's " + column.name + " is " +
            allowed +
            (fitting.empty()
                 ? std::string(is_segment_length(column) ? " between creases of the palm side" : "")
                 : ", which these numbers are in " + fitting + ": is the unit right?"));
  }
  int line = 0;
  double first = 0.0;
  int more = -1;
  for (std::size_t row = 0; row < column.values.size(); ++row) {
    const auto& value = column.values[row];
    if (!value || (*value >= range->low && *value <= range->high)) continue;
    if (line == 0) {
      line = table.lines[row];
      first = *value;
    }
    ++more;
  }
  if (line > 0) {
    table.fail(line, column,
               significant(first, 4) + " mm; a hand's " + column.name + " is " + allowed +
                   (more > 0 ? " (and " + std::to_string(more) + " more cells)" : ""));
  }
}

/// A column of the table, or nothing if it is to be left aside (reported in the notes).
std::optional<population::TableColumn> read_column(const formats::CsvFile& file,
                                                   ColumnReader& cells, std::size_t place,
                                                   const TableReading& reading,
                                                   population::DimensionTable& table,
                                                   double& factor) {
  const std::string& header = file.header[place];
  const std::string number = "column " + std::to_string(place + 1);
  if (header.empty()) {
    if (!cells.is_empty() && place > 0) file.fail(file.header_line, number + " has no name");
    if (!cells.is_empty()) table.notes.push_back(number + " has no name and is left aside");
    return std::nullopt;
  }
  population::ColumnHeading heading = population::heading_of(header);
  population::TableColumn column;
  column.name = heading.name;
  column.header = header;
  column.number = static_cast<int>(place) + 1;
  column.dimension = heading.dimension;
  const bool is_size = population::size_range(heading.name).has_value();
  if (is_size && heading.quantity != population::Quantity::kLength) {
    if (!heading.unit.empty()) {
      cells.fail(file.header_line, formats::in_quotes(heading.unit) +
                                       " is no unit of length; mm, cm, m or in is needed");
    }
    if (reading.unit.empty()) {
      cells.fail(file.header_line, "no unit; the heading has to name one, as in " +
                                       formats::in_quotes(header + "_mm") +
                                       " (or give setting \"unit\")");
    }
    heading.quantity = population::Quantity::kLength;
    heading.unit = reading.unit;
    heading.factor = geometry::millimetres_per(geometry::length_unit(reading.unit));
  }
  column.quantity = heading.quantity;
  factor = heading.factor;
  constexpr double kHuge = 1e15;
  if (heading.quantity == population::Quantity::kLength) {
    column.unit = "mm";
    column.is_number = true;
    const auto range = population::size_range(heading.name);
    column.values = cells.numbers(
        heading.factor, 0.0, kLargestLength,
        "a length above 0 and below " + significant(kLargestLength / heading.factor, 4) + " " +
            heading.unit + " is needed" +
            (range ? "; a hand's " + heading.name + " is " + significant(range->low, 4) + " to " +
                         significant(range->high, 4) + " mm"
                   : ""));
    if (heading.unit != "mm") {
      table.notes.push_back(number + " (" + header + ") is turned from " + heading.unit +
                            " into mm");
    }
    return column;
  }
  const auto [filled, numbers] = cells.counts();
  if (heading.quantity == population::Quantity::kAge && numbers > 0 &&
      (2 * numbers >= filled || !heading.unit.empty())) {
    column.unit = "years";
    column.is_number = true;
    column.values = cells.numbers(heading.factor, -1e-9, 130.0, "0 to 130 years is allowed");
    return column;
  }
  const bool must_be_number =
      heading.quantity == population::Quantity::kOther && !heading.unit.empty();
  column.is_number = heading.quantity == population::Quantity::kOther &&
                     (must_be_number || (numbers > 0 && numbers == filled));
  column.unit = heading.unit;
  if (column.is_number) {
    column.values = cells.numbers(1.0, -kHuge, kHuge, "too large");
  } else {
    column.texts = cells.texts();
    if (heading.quantity != population::Quantity::kLabel && 2 * numbers > filled) {
      table.notes.push_back(number + " (" + header + ") is taken as text: line " +
                            std::to_string(cells.first_text_line()) + " holds no number");
    }
  }
  return column;
}

}  // namespace

void TableReading::check() const {
  if (!unit.empty() && !geometry::length_unit_named(unit)) {
    throw UsageError("unit \"" + unit + "\" is not known; mm, cm, m or in is allowed");
  }
}

population::DimensionTable parse_dimension_table(std::string_view text, const std::string& path,
                                                 const TableReading& reading) {
  reading.check();
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw InputError(path + ": text in UTF-16; save it as CSV in UTF-8");
  }
  if (text.starts_with("PK\x03\x04")) {
    throw InputError(path + ": a spreadsheet or archive; save the sheet as CSV");
  }
  const formats::CsvFile file = formats::parse_csv(text, path, formats::CsvStyle::kSpreadsheet);
  std::vector<const formats::CsvFile::Row*> rows;
  population::DimensionTable table;
  table.source = path;
  table.header_line = file.header_line;
  for (const formats::CsvFile::Row& row : file.rows) {
    const bool is_blank = std::all_of(row.cells.begin(), row.cells.end(),
                                      [](const std::string& cell) { return cell.empty(); });
    if (is_blank) continue;  // as spreadsheets leave them below a table
    rows.push_back(&row);
    table.lines.push_back(row.line);
  }
  if (rows.empty()) {
    file.fail(file.header_line, std::to_string(rows.size()) + " subjects; at least one is needed");
  }
  std::vector<double> factors;
  for (std::size_t place = 0; place < file.header.size(); ++place) {
    ColumnReader cells(file, rows, place);
    double factor = 1.0;
    auto column = read_column(file, cells, place, reading, table, factor);
    if (!column) continue;
    for (const population::TableColumn& other : table.columns) {
      if (other.name == column->name) {
        file.fail(file.header_line, "columns " + std::to_string(other.number) + " (" +
                                        other.header + ") and " + std::to_string(column->number) +
                                        " (" + column->header + ") are both " + column->name);
      }
    }
    table.columns.push_back(std::move(*column));
    factors.push_back(factor);
  }
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].is_number) check_sizes(table, table.columns[i], factors[i]);
  }
  const std::string warning = population::palm_warning(table);
  if (!warning.empty()) table.notes.push_back(warning);
  return table;
}

population::DimensionTable read_dimension_table(const std::string& path,
                                                const TableReading& reading) {
  return parse_dimension_table(formats::read_file(path, kMaxTableBytes), path, reading);
}

}  // namespace palmar::records
