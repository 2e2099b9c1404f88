// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/csv.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::records {
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

/// Force and peak on sensor cells for low and high tissue, and the force per relative change of the
/// modulus; empty where there is no such result.
std::vector<std::string> band_cells(const std::optional<contact::ContactBand>& band,
                                    const contact::ContactBandRow* row) {
  std::vector<std::string> cells(5);
  if (!band || row == nullptr) return cells;
  if (band->total.force_low > 0.0) {
    cells[0] = formats::shortest(row->force_low);
    cells[2] = formats::shortest(row->peak_pressure_cells_low);
  }
  if (band->total.force_high > 0.0) {
    cells[1] = formats::shortest(row->force_high);
    cells[3] = formats::shortest(row->peak_pressure_cells_high);
  }
  cells[4] = formats::shortest(row->force_per_modulus);
  return cells;
}

/// `band`: of this region, or null.
std::vector<std::string> region_row(const study::AssessedProduct& one, const std::string& region,
                                    const contact::RegionContact& contact,
                                    const contact::ContactBandRow* band) {
  const bool is_total = &contact == &one.assessment.contact.total;
  std::vector<std::string> row = {one.product.name, one.assessment.hand_name, region,
                                  is_total ? formats::shortest(study::grip_force_of(one)) : ""};
  for (const double value : {contact.force, contact.area, contact.peak_pressure,
                             contact.peak_pressure_cells, contact.mean_pressure, contact.centre.x(),
                             contact.centre.y(), contact.centre.z(), contact.max_penetration}) {
    row.push_back(formats::shortest(value));
  }
  for (std::string& text : band_cells(one.assessment.contact.band, band)) {
    row.push_back(std::move(text));
  }
  row.push_back(name_of(one.assessment.contact.model));
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

CsvTable region_table(const study::AssessmentSet& set) {
  CsvTable table;
  table.header = {"product",
                  "hand",
                  "region",
                  "grip_force_n",
                  "force_n",
                  "contact_area_mm2",
                  "peak_pressure_mpa",
                  "peak_pressure_cells_mpa",
                  "mean_pressure_mpa",
                  "centre_x_mm",
                  "centre_y_mm",
                  "centre_z_mm",
                  "max_penetration_mm",
                  "force_low_n",
                  "force_high_n",
                  "peak_pressure_cells_low_mpa",
                  "peak_pressure_cells_high_mpa",
                  "force_per_modulus_n",
                  "contact_model",
                  "source"};
  for (const study::AssessedProduct& one : set.assessments) {
    const contact::ContactResult& contact = one.assessment.contact;
    for (const contact::RegionContact& region : contact.regions) {
      const contact::ContactBandRow* band = nullptr;
      if (contact.band) {
        for (const contact::ContactBandRow& row : contact.band->regions) {
          if (row.region == region.region) band = &row;
        }
      }
      table.rows.push_back(region_row(one, std::string(name_of(region.region)), region, band));
    }
    table.rows.push_back(
        region_row(one, "total", contact.total, contact.band ? &contact.band->total : nullptr));
  }
  return table;
}

CsvTable sensor_table(const study::AssessmentSet& set) {
  CsvTable table;
  table.header = {"product",
                  "hand",
                  "layout",
                  "patch",
                  "row",
                  "column",
                  "area_mm2",
                  "force_n",
                  "mean_pressure_mpa",
                  "region",
                  "measured_force_n",
                  "measured_mean_pressure_mpa",
                  "source"};
  for (const study::AssessedProduct& one : set.assessments) {
    if (!one.assessment.sensors) continue;
    const study::SensorReading& reading = *one.assessment.sensors;
    for (std::size_t i = 0; i < reading.cells.size(); ++i) {
      const study::SensorCell& cell = reading.cells[i];
      std::string force, pressure;
      if (one.assessment.measured) {
        const double measured = one.assessment.measured->measured[i];
        force = formats::shortest(measured);
        if (cell.area > 0.0) pressure = formats::shortest(measured / cell.area);
      }
      table.rows.push_back({one.product.name, one.assessment.hand_name, reading.layout.name,
                            cell.patch, std::to_string(cell.row), std::to_string(cell.column),
                            formats::shortest(cell.area), formats::shortest(cell.force),
                            formats::shortest(cell.mean_pressure),
                            cell.region ? std::string(name_of(*cell.region)) : "", force, pressure,
                            one.product.source});
    }
  }
  return table;
}

CsvTable face_table(const study::AssessmentSet& set) {
  CsvTable table;
  table.header = {"product",
                  "hand",
                  "face",
                  "title",
                  "name",
                  "kind",
                  "radius_mm",
                  "area_mm2",
                  "force_n",
                  "contact_area_mm2",
                  "peak_pressure_mpa",
                  "mean_pressure_mpa",
                  "has_peak",
                  "source"};
  for (const study::AssessedProduct& one : set.assessments) {
    for (const study::FaceContact& contact : one.assessment.faces) {
      const product::ProductFace& face = one.product.faces->face[contact.face];
      table.rows.push_back({one.product.name, one.assessment.hand_name, std::to_string(face.number),
                            product::title_of(face), face.name, name_of(face.kind),
                            formats::shortest(face.radius), formats::shortest(face.area),
                            formats::shortest(contact.force), formats::shortest(contact.area),
                            formats::shortest(contact.peak_pressure),
                            formats::shortest(contact.mean_pressure), contact.has_peak ? "1" : "0",
                            one.product.source});
    }
  }
  return table;
}

CsvTable index_table(const study::AssessmentSet& set) {
  CsvTable table;
  table.header = {"product", "hand", "group", "key", "name", "value", "unit", "better", "source"};
  for (const study::AssessedProduct& one : set.assessments) {
    for (const grasp::GraspIndex& index : one.assessment.indices) {
      if (!index.value) continue;
      table.rows.push_back({one.product.name, one.assessment.hand_name, index.group, index.key,
                            index.name, formats::shortest(*index.value), index.unit,
                            name_of(index.better), one.product.source});
    }
  }
  return table;
}

}  // namespace palmar::records
