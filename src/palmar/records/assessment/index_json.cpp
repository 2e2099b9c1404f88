// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/assessment/index_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/formats/text_scan.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

std::string better_words(grasp::Better better) {
  if (better == grasp::Better::kUp) return "more is better";
  return better == grasp::Better::kDown ? "less is better" : "";
}

std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

/// To the width of a column on a terminal, a character of UTF-8 for each place.
std::string padded(const std::string& text, std::size_t width) {
  const std::size_t own = width_of(text);
  return text + std::string(width > own ? width - own : 0, ' ');
}

/// Three significant digits without an exponent: 1972 -> "1970", 0.00159.
std::string three_digits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return fmt::format("{:g}", value);
  constexpr int kDigits = 3, kMostDecimals = 9;
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  const double step = std::pow(10.0, before - kDigits);
  const double rounded = std::round(value / step) * step;
  std::string text =
      fmt::format("{:.{}f}", rounded, std::clamp(kDigits - before, 0, kMostDecimals));
  if (text.find('.') != text.npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

std::string unit_words(const std::string& unit) { return unit == "mm2" ? "mm²" : unit; }

}  // namespace

nlohmann::ordered_json index_values(const grasp::GraspIndices& indices) {
  Json values = Json::object();
  for (const grasp::GraspIndex& index : indices) values[index.key] = finite_or_null(index.value);
  return values;
}

nlohmann::ordered_json index_rows(const grasp::GraspIndices& indices) {
  Json rows = Json::array();
  for (const grasp::GraspIndex& index : indices) {
    rows.push_back({{"key", index.key},
                    {"name", index.name},
                    {"group", index.group},
                    {"value", finite_or_null(index.value)},
                    {"unit", index.unit},
                    {"lowest", finite_or_null(index.lowest)},
                    {"highest", finite_or_null(index.highest)},
                    {"better", name_of(index.better)},
                    {"definition", index.definition},
                    {"source", index.source},
                    {"remark", index.remark},
                    {"told_apart", index.told_apart}});
  }
  return rows;
}

std::string index_text(const grasp::GraspIndices& indices) {
  std::size_t name_width = 0, value_width = 0;
  std::vector<std::string> values;
  for (const grasp::GraspIndex& index : indices) {
    std::string value = "-";
    if (index.value) {
      value = three_digits(*index.value);
      if (!index.unit.empty()) value += " " + unit_words(index.unit);
    }
    name_width = std::max(name_width, width_of(index.name));
    value_width = std::max(value_width, width_of(value));
    values.push_back(std::move(value));
  }
  std::string text, group, remark;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const grasp::GraspIndex& index = indices[k];
    if (index.group != group) {
      group = index.group;
      text += group + "\n";
      remark.clear();
    }
    std::string line = "  " + padded(index.name, name_width) + "  " +
                       padded(values[k], value_width) + "  " +
                       padded(better_words(index.better), 14);
    if (!index.remark.empty() && index.remark != remark) line += "  " + index.remark;
    remark = index.remark;
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace palmar::records
