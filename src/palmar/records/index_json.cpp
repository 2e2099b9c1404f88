// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/index_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/formats/text_scan.h"
#include "palmar/records/json_values.h"

namespace palmar {
namespace {

using Json = nlohmann::ordered_json;

std::string better_words(Better better) {
  if (better == Better::kUp) return "more is better";
  return better == Better::kDown ? "less is better" : "";
}

/// Columns on the terminal; the text is ASCII.
std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width > text.size() ? width - text.size() : 0, ' ');
}

}  // namespace

nlohmann::ordered_json index_values(const GraspIndices& indices) {
  Json values = Json::object();
  for (const GraspIndex& index : indices) values[index.key] = finite_or_null(index.value);
  return values;
}

nlohmann::ordered_json index_rows(const GraspIndices& indices) {
  Json rows = Json::array();
  for (const GraspIndex& index : indices) {
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

std::string index_text(const GraspIndices& indices) {
  std::size_t name_width = 0, value_width = 0;
  std::vector<std::string> values;
  for (const GraspIndex& index : indices) {
    std::string value = "-";
    if (index.value) {
      value = fmt::format("{:.3g}", *index.value);
      if (!index.unit.empty()) value += " " + index.unit;
    }
    name_width = std::max(name_width, index.name.size());
    value_width = std::max(value_width, value.size());
    values.push_back(std::move(value));
  }
  std::string text, group, remark;
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const GraspIndex& index = indices[k];
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

}  // namespace palmar
