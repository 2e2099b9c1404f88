// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/measured_curves.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <string_view>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/text_scan.h"

namespace palmar::records {
namespace {

enum class CurveQuantity { kDepth, kForce, kArea, kWeight, kForceSd, kSubject };

struct CurveColumn {
  const char* name;
  CurveQuantity quantity;
  double factor;  ///< to ours
};
constexpr std::array<CurveColumn, 9> kCurveColumns = {
    {{"depth_mm", CurveQuantity::kDepth, 1.0},
     {"force_n", CurveQuantity::kForce, 1.0},
     {"force_mn", CurveQuantity::kForce, 1e-3},
     {"area_mm2", CurveQuantity::kArea, 1.0},
     {"area_cm2", CurveQuantity::kArea, 100.0},
     {"weight", CurveQuantity::kWeight, 1.0},
     {"force_sd_n", CurveQuantity::kForceSd, 1.0},
     {"force_sd_mn", CurveQuantity::kForceSd, 1e-3},
     {"subject", CurveQuantity::kSubject, 1.0}}};

/// Beginnings of columns that need a unit behind them, the longer ones first.
struct NeedsUnit {
  std::string_view stem, units;
};
constexpr std::array<NeedsUnit, 4> kNeedsUnit = {
    {{"force_sd", "n or mn"}, {"depth", "mm"}, {"force", "n or mn"}, {"area", "mm2 or cm2"}}};

class CurveReader {
 public:
  explicit CurveReader(const formats::CsvFile& file) : file_(file) {}

  MeasuredCurves read() {
    read_header();
    for (const formats::CsvFile::Row& row : file_.rows) read_row(row);
    if (curves_.points.empty()) {
      throw InputError(file_.path + ": it has no readings below the header");
    }
    return std::move(curves_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const { file_.fail(file_.header_line, why); }

  void read_header() {
    const std::vector<std::string>& names = file_.header;
    column_.assign(names.size(), nullptr);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::string name = lower_case(names[i]);
      if (names[i].size() > 3 && names[i].substr(names[i].size() - 3) == "_MN") {
        fail("column " + formats::in_quotes(names[i]) +
             ": MN could be meganewton; force_mN is millinewton");
      }
      const auto* known = std::find_if(kCurveColumns.begin(), kCurveColumns.end(),
                                       [&](const CurveColumn& c) { return name == c.name; });
      if (known == kCurveColumns.end()) {
        check_unit(names[i], name);
        curves_.ignored.push_back(names[i]);
        continue;
      }
      column_[i] = known;
      const auto [other, is_new] = of_quantity_.emplace(known->quantity, i);
      if (!is_new) {
        fail("columns " + formats::in_quotes(names[other->second]) + " and " +
             formats::in_quotes(names[i]) + " say the same; one is needed");
      }
    }
    if (of_quantity_.count(CurveQuantity::kWeight) + of_quantity_.count(CurveQuantity::kForceSd) >
        1) {
      fail("columns weight and force_sd exclude each other: weight is 1 / sd^2");
    }
    require(CurveQuantity::kDepth, "depth_mm");
    require(CurveQuantity::kForce, "force_n (or force_mn)");
  }

  /// A known quantity without a unit, or with one that isn't known.
  void check_unit(const std::string& shown, const std::string& name) const {
    for (const NeedsUnit& one : kNeedsUnit) {
      if (name.rfind(one.stem, 0) != 0) continue;
      const std::string rest = name.substr(one.stem.size());
      if (rest.empty()) {
        fail("column " + formats::in_quotes(shown) + " has no unit; " + std::string(one.stem) +
             "_" + std::string(one.units) + " is needed");
      }
      if (rest.front() == '_' || rest.front() == ' ' || rest.front() == '(' ||
          rest.front() == '[') {
        fail("column " + formats::in_quotes(shown) + ": unit " +
             formats::in_quotes(rest.substr(1)) + " is not known; " + std::string(one.stem) +
             "_ with " + std::string(one.units) + " is allowed");
      }
    }
  }

  void require(CurveQuantity quantity, const std::string& name) const {
    if (of_quantity_.count(quantity) > 0) return;
    const std::string nearest = nearest_name(name.substr(0, name.find(' ')), curves_.ignored);
    fail("column " + name + " is missing; the header has " + joined(file_.header, ", ") +
         (nearest.empty() ? "" : " (is " + nearest + " meant?)"));
  }

  double number(const formats::CsvFile::Row& row, std::size_t i) const {
    return file_.number(row, i) * column_[i]->factor;
  }

  double at_least_zero(const formats::CsvFile::Row& row, std::size_t i) const {
    const double value = number(row, i);
    if (value < 0.0) file_.fail(row.line, shown(row, i) + "; 0 or more is needed");
    return value;
  }

  double above_zero(const formats::CsvFile::Row& row, std::size_t i) const {
    const double value = number(row, i);
    if (!(value > 0.0)) file_.fail(row.line, shown(row, i) + "; more than 0 is needed");
    return value;
  }

  std::string shown(const formats::CsvFile::Row& row, std::size_t i) const {
    return file_.header[i] + " is " + row.cells[i];
  }

  void read_row(const formats::CsvFile::Row& row) {
    contact::MeasuredPoint point;
    point.line = row.line;
    for (std::size_t i = 0; i < row.cells.size(); ++i) {
      if (column_[i] == nullptr) continue;
      switch (column_[i]->quantity) {
        case CurveQuantity::kDepth:
          point.depth = at_least_zero(row, i);
          break;
        case CurveQuantity::kForce:
          point.force = at_least_zero(row, i);
          break;
        case CurveQuantity::kArea:
          if (!row.cells[i].empty()) point.area = at_least_zero(row, i);
          break;
        case CurveQuantity::kWeight:
          point.weight = above_zero(row, i);
          break;
        case CurveQuantity::kForceSd:
          point.weight = std::pow(above_zero(row, i), -2);
          break;
        case CurveQuantity::kSubject:
          point.subject = row.cells[i];
          break;
      }
    }
    if (point.depth == 0.0) {
      ++curves_.zero_depths;
    } else {
      curves_.points.push_back(std::move(point));
    }
  }

  const formats::CsvFile& file_;
  std::vector<const CurveColumn*> column_;  ///< per cell; null: ignored
  std::map<CurveQuantity, std::size_t> of_quantity_;
  MeasuredCurves curves_;
};

}  // namespace

MeasuredCurves read_measured_curves(const std::string& path) {
  const formats::CsvFile file = formats::read_csv(path);
  return CurveReader(file).read();
}

}  // namespace palmar::records
