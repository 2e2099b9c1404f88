// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/feature_settings.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/csv_reader.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/records/product/cad_format.h"

namespace palmar::workflow {
namespace {

double number_in(const std::string& text, const std::string& words) {
  const std::optional<double> value = formats::parse_double(text);
  if (!value || !std::isfinite(*value)) {
    throw UsageError(
        fmt::format("setting \"vary\" \"{}\": \"{}\" is no number; a value as 8, or a range as "
                    "1:15, is required",
                    words, text));
  }
  return *value;
}

/// "1:15" or "8".
void read_range(const std::string& words, FeatureSetting& setting) {
  const size_t colon = words.find(':');
  setting.lowest = number_in(words.substr(0, colon), words);
  setting.highest =
      colon == std::string::npos ? setting.lowest : number_in(words.substr(colon + 1), words);
  if (setting.lowest > setting.highest) {
    throw UsageError(fmt::format(
        "setting \"vary\" \"{}\": from {:g} to {:g}; from the smaller to the larger one", words,
        setting.lowest, setting.highest));
  }
}

std::vector<Vec3> points_in(const formats::CsvFile& table) {
  std::array<int, 3> column{};
  const std::array<const char*, 3> name = {"x_mm", "y_mm", "z_mm"};
  for (size_t i = 0; i < 3; ++i) {
    column[i] = table.column(name[i]);
    if (column[i] < 0) table.fail(table.header_line, fmt::format("no column {}", name[i]));
  }
  std::vector<Vec3> points;
  for (const formats::CsvFile::Row& row : table.rows) {
    Vec3 point;
    for (size_t i = 0; i < 3; ++i) {
      point[static_cast<Eigen::Index>(i)] = table.number(row, static_cast<size_t>(column[i]));
    }
    points.push_back(point);
  }
  return points;
}

}  // namespace

FeatureSetting feature_setting(const std::string& words, const GrooveSettings& grooves) {
  const size_t equals = words.rfind('=');
  if (equals == std::string::npos || equals == 0) {
    throw UsageError(
        fmt::format("setting \"vary\" \"{}\": FEATURE:WHERE=VALUE or PARAMETER=VALUE is required, "
                    "as fillet:long=1:15",
                    words));
  }
  FeatureSetting setting;
  setting.name = words.substr(0, equals);
  read_range(words.substr(equals + 1), setting);
  const size_t colon = setting.name.find(':');
  if (colon == std::string::npos) {
    setting.parameter = setting.name;
    setting.unit = product::unit_of_parameter(setting.name);
    return setting;
  }
  records::CadFeature& feature = setting.feature;
  feature.feature = setting.name.substr(0, colon);
  feature.where = setting.name.substr(colon + 1);
  setting.unit = feature.feature == "taper" ? "deg" : "mm";
  const bool is_known = feature.feature == "fillet" || feature.feature == "offset" ||
                        feature.feature == "taper" || feature.feature == "groove";
  if (!is_known || feature.where.empty()) {
    throw UsageError(
        fmt::format("setting \"vary\" \"{}\": fillet:EDGES, offset:FACES, taper:FACES, "
                    "groove:at=MM, groove:FILE.csv and the parameters of made products are allowed",
                    words));
  }
  if (feature.feature == "fillet" && setting.lowest < 0.0) {
    throw UsageError(fmt::format("setting \"vary\" \"{}\": a radius below 0", words));
  }
  if (feature.feature != "groove") return setting;
  if (setting.lowest < 0.0 || setting.highest > grooves.radius) {
    throw UsageError(
        fmt::format("setting \"vary\" \"{}\": a depth of 0 to the groove's radius of {:g} mm is "
                    "allowed",
                    words, grooves.radius));
  }
  feature.section_radius = grooves.radius;
  feature.rim_radius = grooves.rim;
  if (feature.where.rfind("at=", 0) == 0) {
    feature.ring_at = number_in(feature.where.substr(3), words);
    return setting;
  }
  const formats::CsvFile table = formats::read_csv(feature.where);
  feature.points = points_in(table);
  const bool is_closed =
      feature.points.size() > 3 && (feature.points.front() - feature.points.back()).norm() < 1e-6;
  if (is_closed) feature.points.pop_back();
  feature.is_closed = is_closed;
  return setting;
}

std::optional<records::CadSource> cad_source_of(const RedesignRequest& request) {
  records::CadSource source;
  if (records::is_made(request.product)) {
    source.made = records::made_from(request.product);
    return source;
  }
  source.file = request.product;
  formats::read_file(source.file);  // says what is wrong with it, if anything
  if (!records::is_cad_file(source.file)) return std::nullopt;
  if (request.unit) source.millimetres_per_unit = geometry::millimetres_per(*request.unit);
  return source;
}

records::CadFeatureRequest request_for(const records::CadSource& source,
                                       const std::vector<FeatureSetting>& settings,
                                       const std::vector<double>& values) {
  records::CadFeatureRequest request{.source = source, .reference = source};
  for (size_t i = 0; i < settings.size(); ++i) {
    if (settings[i].parameter.empty()) {
      request.features.push_back(settings[i].feature);
      request.features.back().value = values[i];
      continue;
    }
    auto& given = request.source.made.value().given;
    std::erase_if(given, [&](const auto& one) { return one.first == settings[i].parameter; });
    given.emplace_back(settings[i].parameter, values[i]);
  }
  return request;
}

std::string words_of(const std::vector<FeatureSetting>& settings,
                     const std::vector<double>& values) {
  std::string text;
  for (size_t i = 0; i < settings.size(); ++i) {
    text += fmt::format("{}{} {:.4g}{}{}", i == 0 ? "" : ", ", settings[i].name, values[i],
                        settings[i].unit.empty() ? "" : " ", settings[i].unit);
  }
  return text;
}

}  // namespace palmar::workflow
