// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/csv.h"

#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/io/text_scan.h"

namespace palmar {
namespace {

/// As in JSON: bytes that are no UTF-8 become U+FFFD, the same ones as in assessment.json.
std::string valid_utf8(const std::string& text) {
  using nlohmann::json;
  return json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
}

std::string cell(const std::string& raw) {
  const std::string text = valid_utf8(raw);
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"') result += '"';
    result += c;
  }
  return result + '"';
}

std::string line(const std::vector<std::string>& cells) {
  std::string result;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) result += ',';
    result += cell(cells[i]);
  }
  return result + '\n';
}

std::vector<std::string> region_row(const AssessedProduct& one, const std::string& region,
                                    const RegionContact& contact) {
  std::vector<std::string> row = {one.product.name, one.assessment.hand_name, region};
  for (const double value : {contact.force, contact.area, contact.peak_pressure,
                             contact.peak_pressure_cells, contact.mean_pressure, contact.centre.x(),
                             contact.centre.y(), contact.centre.z(), contact.max_penetration}) {
    row.push_back(shortest(value));
  }
  row.push_back(one.product.source);
  return row;
}

}  // namespace

std::string format_csv(const CsvTable& table) {
  std::string text = line(table.header);
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (table.rows[r].size() != table.header.size()) {
      throw Error("table row " + std::to_string(r + 1) + " has " +
                  std::to_string(table.rows[r].size()) + " cells; " +
                  std::to_string(table.header.size()) + " are required");
    }
    text += line(table.rows[r]);
  }
  return text;
}

CsvTable region_table(const AssessmentSet& set) {
  CsvTable table;
  table.header = {"product",
                  "hand",
                  "region",
                  "force_n",
                  "contact_area_mm2",
                  "peak_pressure_mpa",
                  "peak_pressure_cells_mpa",
                  "mean_pressure_mpa",
                  "centre_x_mm",
                  "centre_y_mm",
                  "centre_z_mm",
                  "max_penetration_mm",
                  "source"};
  for (const AssessedProduct& one : set.assessments) {
    const ContactResult& contact = one.assessment.contact;
    for (const RegionContact& region : contact.regions) {
      table.rows.push_back(region_row(one, std::string(name_of(region.region)), region));
    }
    table.rows.push_back(region_row(one, "total", contact.total));
  }
  return table;
}

}  // namespace palmar
