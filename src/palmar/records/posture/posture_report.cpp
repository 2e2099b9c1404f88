// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/posture_report.h"

#include <nlohmann/json.hpp>

#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/csv.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json placement_object(const geometry::Rigid3& placement) {
  const Quat& q = placement.rotation;
  const Vec3& t = placement.translation;
  return {{"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", {t.x(), t.y(), t.z()}}};
}

Json names_of(const std::vector<hand::Dof>& dofs) {
  Json names = Json::array();
  for (const hand::Dof dof : dofs) names.push_back(name_of(dof));
  return names;
}

Json labels_of(const std::vector<int>& indices, const std::vector<std::string>& labels) {
  Json names = Json::array();
  for (const int i : indices) names.push_back(labels.at(i));
  return names;
}

void add_markers(const hand::PostureFit& fit, const std::vector<std::string>& labels, Json& json) {
  json["status"] = name_of(fit.status);
  json["message"] = fit.message;
  json["measured_from_hand"] = placement_object(fit.measured_from_hand);
  json["scale"] = fit.scale;
  json["rms_mm"] = fit.rms;
  Json residuals = Json::object();
  for (std::size_t i = 0; i < fit.residual.size(); ++i) {
    residuals[labels.at(i)] = or_null(fit.residual[i]);
  }
  json["residuals_mm"] = std::move(residuals);
  json["outliers"] = labels_of(fit.outliers, labels);
  Json swapped = Json::array();
  for (const auto& [a, b] : fit.swapped) swapped.push_back(labels_of({a, b}, labels));
  json["swapped"] = std::move(swapped);
  json["not_observed"] = names_of(fit.not_observed);
  json["at_limit"] = names_of(fit.at_limit);
  Json sd = Json::object();
  for (int d = 0; d < hand::kDofCount; ++d) {
    sd[std::string(name_of(static_cast<hand::Dof>(d)))] = fit.sd[d] * geometry::kDegreesPerRadian;
  }
  json["sd_deg"] = std::move(sd);
}

void add_mesh(const hand::MeshFit& fit, Json& json) {
  json["status"] = name_of(fit.status);
  json["message"] = fit.message;
  json["mesh_from_hand"] = placement_object(fit.mesh_from_hand);
  json["scale"] = fit.scale;
  json["vertex_for_vertex"] = fit.is_vertex_to_vertex;
  json["distance_mm"] = {
      {"mean", fit.mean}, {"median", fit.median}, {"percentile_95", fit.percentile_95}};
  json["partner_share"] = fit.partner_share;
  json["not_observed"] = names_of(fit.not_observed);
  json["at_limit"] = names_of(fit.at_limit);
}

Json posture_object(const PostureReport& report, const FoundPosture& found, bool is_one_of_many) {
  Json json = Json::object();
  if (is_one_of_many) json["frame"] = found.number;
  if (found.frame.time) json["time_s"] = *found.frame.time;
  json["posture"] = Json::parse(posture_json(found.frame.posture));
  if (found.frame.product_from_hand) {
    json["product_from_hand"] = placement_object(*found.frame.product_from_hand);
  }
  if (!found.frame.missing.empty()) json["not_given"] = names_of(found.frame.missing);
  if (!found.frame.clamped.empty()) {
    Json clamped = Json::object();
    for (const hand::ClampedAngle& one : found.frame.clamped) {
      clamped[std::string(name_of(one.dof))] = {
          {"asked_deg", one.asked * geometry::kDegreesPerRadian},
          {"used_deg", one.used * geometry::kDegreesPerRadian}};
    }
    json["clamped"] = std::move(clamped);
  }
  if (found.markers) add_markers(*found.markers, report.labels, json);
  if (found.mesh) add_mesh(*found.mesh, json);
  return json;
}

}  // namespace

std::string posture_report_json(const PostureReport& report) {
  Json json = {{"hand", report.hand}, {"source", report.source}};
  if (report.postures.size() == 1) {
    json.update(posture_object(report, report.postures.front(), false));
  } else {
    Json frames = Json::array();
    for (const FoundPosture& one : report.postures) {
      frames.push_back(posture_object(report, one, true));
    }
    json["frames"] = std::move(frames);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string posture_report_csv(const PostureReport& report) {
  CsvTable table;
  table.header = {"frame", "time_s"};
  for (int d = 0; d < hand::kDofCount; ++d) {
    table.header.push_back(std::string(name_of(static_cast<hand::Dof>(d))) + "_deg");
  }
  bool has_rms = false;
  for (const FoundPosture& one : report.postures) has_rms = has_rms || one.markers.has_value();
  if (has_rms) table.header.emplace_back("rms_mm");
  for (const FoundPosture& one : report.postures) {
    std::vector<std::string> row = {std::to_string(one.number),
                                    one.frame.time ? formats::shortest(*one.frame.time) : ""};
    for (const double angle : one.frame.posture.angle)
      row.push_back(formats::shortest(angle * geometry::kDegreesPerRadian));
    if (has_rms) row.push_back(one.markers ? formats::shortest(one.markers->rms) : "");
    table.rows.push_back(std::move(row));
  }
  return format_csv(table);
}

}  // namespace palmar::records
