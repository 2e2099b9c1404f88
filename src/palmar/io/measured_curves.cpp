// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/measured_curves.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/io/file.h"
#include "palmar/io/text_scan.h"

namespace palmar {
namespace {

constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 28;

enum class Quantity { kDepth, kForce, kArea, kWeight, kForceSd, kSubject };

struct Column {
  const char* name;
  Quantity quantity;
  double factor;  ///< to ours
};
constexpr std::array<Column, 9> kColumns = {{{"depth_mm", Quantity::kDepth, 1.0},
                                             {"force_n", Quantity::kForce, 1.0},
                                             {"force_mn", Quantity::kForce, 1e-3},
                                             {"area_mm2", Quantity::kArea, 1.0},
                                             {"area_cm2", Quantity::kArea, 100.0},
                                             {"weight", Quantity::kWeight, 1.0},
                                             {"force_sd_n", Quantity::kForceSd, 1.0},
                                             {"force_sd_mn", Quantity::kForceSd, 1e-3},
                                             {"subject", Quantity::kSubject, 1.0}}};

/// Beginnings of columns that need a unit behind them, the longer ones first.
struct NeedsUnit {
  std::string_view stem, units;
};
constexpr std::array<NeedsUnit, 4> kNeedsUnit = {
    {{"force_sd", "n or mn"}, {"depth", "mm"}, {"force", "n or mn"}, {"area", "mm2 or cm2"}}};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == text.npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

class Reader {
 public:
  explicit Reader(std::string path) : path_(std::move(path)) {}

  MeasuredCurves read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
      text.remove_prefix(kByteOrderMark.size());
    }
    TextScanner scanner(text);
    bool has_header = false;
    while (const auto line = scanner.next_line()) {
      line_ = scanner.line();
      if (trimmed(*line).empty() || line->front() == '#') continue;
      if (has_header) {
        read_row(cells(*line));
      } else {
        delimiter_ = line->find(';') != line->npos    ? ';'
                     : line->find('\t') != line->npos ? '\t'
                                                      : ',';
        read_header(cells(*line));
        has_header = true;
      }
    }
    if (!has_header) throw InputError(path_ + ": it has no header; depth_mm,force_n is needed");
    if (curves_.points.empty()) throw InputError(path_ + ": it has no readings below the header");
    return std::move(curves_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(path_ + ":" + std::to_string(line_) + ": " + why);
  }

  std::vector<std::string> cells(std::string_view line) const {
    std::vector<std::string> result(1);
    bool is_quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const char c = line[i];
      if (is_quoted) {
        if (c != '"') {
          result.back() += c;
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          result.back() += line[++i];
        } else {
          is_quoted = false;
        }
      } else if (c == '"') {
        is_quoted = true;
      } else if (c == delimiter_) {
        result.emplace_back();
      } else {
        result.back() += c;
      }
    }
    if (is_quoted) fail("a quote is not closed in this line");
    for (std::string& cell : result) cell = trimmed(cell);
    return result;
  }

  void read_header(const std::vector<std::string>& names) {
    header_ = names;
    column_.assign(names.size(), nullptr);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = lower(names[i]);
      if (names[i].size() > 3 && names[i].substr(names[i].size() - 3) == "_MN") {
        fail("column " + in_quotes(names[i]) + ": MN could be meganewton; force_mN is millinewton");
      }
      const auto* known = std::find_if(kColumns.begin(), kColumns.end(),
                                       [&](const Column& c) { return name == c.name; });
      if (known == kColumns.end()) {
        check_unit(names[i], name);
        curves_.ignored.push_back(names[i]);
        continue;
      }
      column_[i] = known;
      const auto [other, is_new] = of_quantity_.emplace(known->quantity, i);
      if (!is_new) {
        fail("columns " + in_quotes(names[other->second]) + " and " + in_quotes(names[i]) +
             " say the same; one is needed");
      }
    }
    if (of_quantity_.count(Quantity::kWeight) + of_quantity_.count(Quantity::kForceSd) > 1) {
      fail("columns weight and force_sd exclude each other: weight is 1 / sd^2");
    }
    require(Quantity::kDepth, "depth_mm");
    require(Quantity::kForce, "force_n (or force_mn)");
  }

  /// A known quantity without a unit, or with one that isn't known.
  void check_unit(const std::string& shown, const std::string& name) const {
    for (const NeedsUnit& one : kNeedsUnit) {
      if (name.rfind(one.stem, 0) != 0) continue;
      const std::string rest = name.substr(one.stem.size());
      if (rest.empty()) {
        fail("column " + in_quotes(shown) + " has no unit; " + std::string(one.stem) + "_" +
             std::string(one.units) + " is needed");
      }
      if (rest.front() == '_' || rest.front() == ' ' || rest.front() == '(' ||
          rest.front() == '[') {
        fail("column " + in_quotes(shown) + ": unit " + in_quotes(rest.substr(1)) +
             " is not known; " + std::string(one.stem) + "_ with " + std::string(one.units) +
             " is allowed");
      }
    }
  }

  void require(Quantity quantity, const std::string& name) const {
    if (of_quantity_.count(quantity) > 0) return;
    std::string found;
    for (const std::string& one : header_) found += (found.empty() ? "" : ", ") + one;
    const std::string nearest = nearest_name(name.substr(0, name.find(' ')), curves_.ignored);
    fail("column " + name + " is missing; the header has " + found +
         (nearest.empty() ? "" : " (is " + nearest + " meant?)"));
  }

  double number(std::size_t i, const std::string& cell) const {
    const std::optional<double> value = parse_double(cell);
    if (!value || !std::isfinite(*value)) {
      fail(header_[i] + " is " + in_quotes(cell) + "; a number is needed" +
           (cell.find(',') != cell.npos ? " (with a decimal point)" : ""));
    }
    return *value * column_[i]->factor;
  }

  double at_least_zero(std::size_t i, const std::string& cell) const {
    const double value = number(i, cell);
    if (value < 0.0) fail(header_[i] + " is " + cell + "; 0 or more is needed");
    return value;
  }

  double above_zero(std::size_t i, const std::string& cell) const {
    const double value = number(i, cell);
    if (!(value > 0.0)) fail(header_[i] + " is " + cell + "; more than 0 is needed");
    return value;
  }

  void read_row(const std::vector<std::string>& row) {
    if (row.size() != header_.size()) {
      fail("it has " + std::to_string(row.size()) + " cells; the header has " +
           std::to_string(header_.size()));
    }
    MeasuredPoint point;
    point.line = line_;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (column_[i] == nullptr) continue;
      switch (column_[i]->quantity) {
        case Quantity::kDepth:
          point.depth = at_least_zero(i, row[i]);
          break;
        case Quantity::kForce:
          point.force = at_least_zero(i, row[i]);
          break;
        case Quantity::kArea:
          if (!row[i].empty()) point.area = at_least_zero(i, row[i]);
          break;
        case Quantity::kWeight:
          point.weight = above_zero(i, row[i]);
          break;
        case Quantity::kForceSd:
          point.weight = std::pow(above_zero(i, row[i]), -2);
          break;
        case Quantity::kSubject:
          point.subject = row[i];
          break;
      }
    }
    if (point.depth == 0.0) {
      ++curves_.zero_depths;
    } else {
      curves_.points.push_back(std::move(point));
    }
  }

  std::string path_;
  int line_ = 0;
  char delimiter_ = ',';
  std::vector<std::string> header_;
  std::vector<const Column*> column_;  ///< per cell; null: ignored
  std::map<Quantity, std::size_t> of_quantity_;
  MeasuredCurves curves_;
};

}  // namespace

MeasuredCurves read_measured_curves(const std::string& path) {
  const std::string text = read_file(path, kMaxBytes);
  if (!looks_like_text(std::string_view(text).substr(0, 4096))) {
    throw InputError(path + ": no text; a CSV file is needed");
  }
  return Reader(path).read(text);
}

}  // namespace palmar
