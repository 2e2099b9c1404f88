// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/dimension_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"

namespace palmar::population {
namespace {

constexpr std::size_t kMostGroups = 50;

std::optional<double> number_of(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// A number as people write it: "40", "18.5".
std::string plain(double value) {
  std::array<char, 32> text{};
  return std::string(text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr);
}

DimensionTable with_rows(const DimensionTable& table, const std::vector<std::size_t>& rows) {
  DimensionTable result;
  result.source = table.source;
  result.header_line = table.header_line;
  result.notes = table.notes;
  for (const std::size_t row : rows) result.lines.push_back(table.lines[row]);
  for (const TableColumn& column : table.columns) {
    TableColumn kept = column;
    kept.values.clear();
    kept.texts.clear();
    for (const std::size_t row : rows) {
      if (column.is_number) {
        kept.values.push_back(column.values[row]);
      } else {
        kept.texts.push_back(column.texts[row]);
      }
    }
    result.columns.push_back(std::move(kept));
  }
  return result;
}

struct Condition {
  std::string column, sign, value;
};

Condition parsed(const std::string& text) {
  const auto at = text.find_first_of("=!<>");
  if (at != text.npos && at > 0) {
    const bool is_two = at + 1 < text.size() && text[at + 1] == '=';
    Condition c{trimmed(text.substr(0, at)), text.substr(at, is_two ? 2 : 1),
                trimmed(text.substr(at + (is_two ? 2 : 1)))};
    if (c.sign == "==") c.sign = "=";
    if (c.sign != "!" && !c.value.empty()) return c;
  }
  throw UsageError("setting \"conditions\": \"" + text +
                   "\" is not understood; COLUMN=VALUE is required (or != < <= > >=)");
}

bool holds(const std::string& sign, double a, double b) {
  if (sign == "=") return a == b;
  if (sign == "!=") return a != b;
  if (sign == "<") return a < b;
  if (sign == "<=") return a <= b;
  if (sign == ">") return a > b;
  return a >= b;
}

}  // namespace

const TableColumn& DimensionTable::column(const std::string& name) const {
  const std::string wanted = lower_case(name);
  for (const TableColumn& c : columns) {
    if (c.name == name || lower_case(c.header) == wanted) return c;
  }
  const std::string ours = heading_of(name).name;
  for (const TableColumn& c : columns) {
    if (c.name == ours) return c;
  }
  std::vector<std::string> names;
  for (const TableColumn& c : columns) names.push_back(c.name);
  const std::string nearest = nearest_name(ours, names);
  throw UsageError(source + " has no column \"" + name + "\"" +
                   (nearest.empty() ? "" : ", did you mean " + nearest + "?") + "; it has " +
                   joined(names, ", "));
}

std::vector<const TableColumn*> DimensionTable::measures() const {
  std::vector<const TableColumn*> result;
  for (const bool is_length : {true, false}) {
    for (const TableColumn& c : columns) {
      if (!c.is_number || c.quantity == Quantity::kAge || c.quantity == Quantity::kLabel) continue;
      if ((c.quantity == Quantity::kLength) == is_length) result.push_back(&c);
    }
  }
  return result;
}

void DimensionTable::fail(int line, const TableColumn& c, const std::string& why) const {
  throw InputError(source + ":" + std::to_string(line > 0 ? line : header_line) + ": column " +
                   std::to_string(c.number) + " (" + c.header + "): " + why);
}

DimensionTable where(const DimensionTable& table, const std::string& text) {
  const Condition condition = parsed(text);
  const TableColumn& column = table.column(condition.column);
  const std::optional<double> number = number_of(condition.value);
  const bool is_order = condition.sign.front() == '<' || condition.sign.front() == '>';
  if (is_order && !column.is_number) {
    throw UsageError("setting \"conditions\": \"" + text + "\": " + column.name +
                     " has no numbers to compare");
  }
  if (column.is_number && !number) {
    throw UsageError("setting \"conditions\": \"" + text + "\": " + column.name +
                     " holds numbers; \"" + condition.value + "\" is none");
  }
  std::vector<std::size_t> rows;
  const std::string wanted = lower_case(condition.value);
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    if (column.is_number) {
      if (column.values[row] && holds(condition.sign, *column.values[row], *number)) {
        rows.push_back(row);
      }
    } else if (!column.texts[row].empty() &&
               (lower_case(column.texts[row]) == wanted) == (condition.sign == "=")) {
      rows.push_back(row);
    }
  }
  if (rows.empty())
    throw UsageError("setting \"conditions\": no subject of " + table.source + " has " + text);
  return with_rows(table, rows);
}

DimensionTable having(const DimensionTable& table, const std::vector<std::string>& names) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    const bool is_whole = std::all_of(names.begin(), names.end(), [&](const std::string& name) {
      const TableColumn& column = table.column(name);
      return column.is_number ? column.values[row].has_value() : !column.texts[row].empty();
    });
    if (is_whole) rows.push_back(row);
  }
  return with_rows(table, rows);
}

std::vector<TableGroup> grouped(const DimensionTable& table, const std::string& by,
                                std::vector<std::string>& notes) {
  if (by.empty()) return {{"all", table}};
  const TableColumn& column = table.column(by);
  // By size where the groups are numbers, else by name.
  std::map<std::pair<double, std::string>, std::vector<std::size_t>> rows;
  int missing = 0;
  for (std::size_t row = 0; row < table.lines.size(); ++row) {
    if (!column.is_number) {
      if (column.texts[row].empty()) {
        ++missing;
      } else {
        rows[{0.0, column.texts[row]}].push_back(row);
      }
    } else if (!column.values[row]) {
      ++missing;
    } else if (column.quantity == Quantity::kAge) {
      const double decade = 10.0 * std::floor(*column.values[row] / 10.0);
      rows[{decade, plain(decade) + "-" + plain(decade + 9.0)}].push_back(row);
    } else {
      rows[{*column.values[row], plain(*column.values[row])}].push_back(row);
    }
    if (rows.size() > kMostGroups) {
      throw UsageError("setting \"by\" is " + by + ": more than " + std::to_string(kMostGroups) +
                       " groups; a column with few different values is needed");
    }
  }
  if (rows.empty())
    throw UsageError("setting \"by\" is " + by + ": no subject of " + table.source + " has one");
  if (missing > 0) {
    notes.push_back(std::to_string(missing) + " of " + std::to_string(table.subjects()) +
                    " subjects have no " + column.name + " and are in no group");
  }
  std::vector<TableGroup> groups;
  for (const auto& [key, members] : rows) {
    groups.push_back({key.second, with_rows(table, members)});
  }
  return groups;
}

}  // namespace palmar::population
