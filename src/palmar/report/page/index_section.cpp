// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/index_section.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"

namespace palmar {

namespace {

constexpr const char* kNothing = "–";

/// Units as people write them.
std::string shown_unit(const std::string& unit) {
  if (unit == "mm2") return "mm²";
  if (unit == "mm3") return "mm³";
  if (unit == "deg") return "°";
  return unit;
}

std::string group_heading(const std::string& group) {
  if (group == "grip") return "Grip: how firm, how even, in balance";
  if (group == "stability") return "Stability: how firmly it sits";
  if (group == "ease") return "Ease: how natural the posture is";
  if (group == "fitness") return "Fitness: how well the shapes agree";
  if (group == "comfort") return "Comfort: pressure against what people bear";
  if (group == "effort") return "Effort: what the muscles have to do";
  if (group == "reach") return "Reach: what the fingers get to";
  return group;
}

std::string better_words(Better better) {
  if (better == Better::kUp) return "↑ more is better";
  return better == Better::kDown ? "↓ less is better" : kNothing;
}

std::string range_words(const GraspIndex& index) {
  if (!index.lowest && !index.highest) return kNothing;
  if (!index.highest) return "from " + short_number(*index.lowest);
  if (!index.lowest) return "up to " + short_number(*index.highest);
  return short_number(*index.lowest) + " to " + short_number(*index.highest);
}

std::string value_cell(const GraspIndex* index) {
  if (index == nullptr || !index->value || !std::isfinite(*index->value)) {
    return std::string("<td class=\"n\">") + kNothing + "</td>";
  }
  std::string unit = shown_unit(index->unit);
  if (!unit.empty()) unit = (unit == "°" ? "" : " ") + html_escaped(unit);
  return "<td class=\"n\" data-value=\"" + exact_number(*index->value) + "\">" +
         short_number(*index->value) + unit + "</td>";
}

/// `last_remark`: of the row above, not told twice.
std::string row(const GraspIndex& index, const std::string& last_remark) {
  std::string html = "<tr data-index=\"" + html_escaped(index.key) + "\"><th scope=\"row\">" +
                     "<details><summary>" + html_escaped(index.name) + "</summary><p>" +
                     html_escaped(index.definition) + ".</p>";
  if (!index.source.empty()) html += "<p>Source: " + html_escaped(index.source) + ".</p>";
  html += "<p>Key: <code>" + html_escaped(index.key) + "</code></p></details>";
  if (!index.remark.empty() && index.remark != last_remark) {
    html += "<span class=\"range\">" + html_escaped(index.remark) + "</span>";
  }
  return html + "</th>" + value_cell(&index) + "<td>" + range_words(index) + "</td><td>" +
         better_words(index.better) + "</td></tr>";
}

const GraspIndex* find(const GraspIndices& indices, const std::string& key) {
  const auto found = std::find_if(indices.begin(), indices.end(),
                                  [&](const GraspIndex& one) { return one.key == key; });
  return found == indices.end() ? nullptr : &*found;
}

}  // namespace

std::string index_section(const GraspIndices& indices) {
  if (indices.empty()) return {};
  std::string html =
      "<h3>Indices of this grasp</h3>\n<p>Each stands for itself: they are never added up to one "
      "number, and those of different groups can't be weighed against each other. Open a name for "
      "its definition and source.</p>\n";
  std::string group, remark;
  for (const GraspIndex& index : indices) {
    if (group.empty() || index.group != group) {
      if (!group.empty()) html += "</tbody></table></div>\n";
      group = index.group;
      remark.clear();
      html += "<div class=\"wide\"><table class=\"indices\"><caption>" +
              html_escaped(group_heading(group)) +
              "</caption><thead><tr><th scope=\"col\">Index</th><th scope=\"col\" class=\"n\">"
              "Value</th><th scope=\"col\">Possible range</th><th scope=\"col\">Better</th></tr>"
              "</thead><tbody>";
    }
    html += row(index, remark);
    remark = index.remark;
  }
  return html + "</tbody></table></div>\n";
}

std::string index_comparison(const std::vector<std::string>& names,
                             const std::vector<GraspIndices>& indices) {
  if (names.size() != indices.size()) {
    throw UsageError("report: indices of " + std::to_string(indices.size()) + " products for " +
                     std::to_string(names.size()) + " names");
  }
  if (names.size() < 2) return {};
  std::vector<const GraspIndex*> rows;
  for (const GraspIndices& product : indices) {
    for (const GraspIndex& one : product) {
      const bool is_known = std::any_of(
          rows.begin(), rows.end(), [&](const GraspIndex* other) { return other->key == one.key; });
      if (!is_known) rows.push_back(&one);
    }
  }
  if (rows.empty()) return {};
  std::vector<std::string> groups;  // a group of a later product may add rows to an earlier one
  for (const GraspIndex* one : rows) {
    if (std::find(groups.begin(), groups.end(), one->group) == groups.end()) {
      groups.push_back(one->group);
    }
  }
  const auto place = [&](const GraspIndex* one) {
    return std::find(groups.begin(), groups.end(), one->group) - groups.begin();
  };
  std::stable_sort(rows.begin(), rows.end(),
                   [&](const GraspIndex* a, const GraspIndex* b) { return place(a) < place(b); });
  std::string html =
      "<div class=\"wide\"><table><caption>Indices side by side</caption><thead>"
      "<tr><th scope=\"col\">Index</th>";
  for (const std::string& name : names) {
    html += "<th scope=\"col\" class=\"n\">" + html_escaped(name) + "</th>";
  }
  html += "<th scope=\"col\">Better</th></tr></thead><tbody>";
  std::string group;
  for (const GraspIndex* index : rows) {
    if (index->group != group) {
      group = index->group;
      html += "<tr><th scope=\"rowgroup\" colspan=\"" + std::to_string(names.size() + 2) +
              "\"><strong>" + html_escaped(group_heading(group)) + "</strong></th></tr>";
    }
    html += "<tr data-index=\"" + html_escaped(index->key) + "\"><th scope=\"row\">" +
            html_escaped(index->name) + "</th>";
    for (const GraspIndices& product : indices) html += value_cell(find(product, index->key));
    html += "<td>" + better_words(index->better) + "</td></tr>";
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace palmar
