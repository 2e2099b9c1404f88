// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/photo_mesh_report.h"

#include <nlohmann/json.hpp>

#include "palmar/geometry/degrees.h"
#include "palmar/records/json_values.h"

namespace palmar::person_workflow {
namespace {

using Json = nlohmann::ordered_json;

Json json_of_mesh(const PosedPhotographs& work, const capture::PhotoModel& model, double seconds) {
  const capture::HandMotion& motion = work.motion;
  Json photographs = Json::array();
  std::size_t k = 0;
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    const person_records::PhotoFile& file = work.set.photographs[i];
    Json one = {{"file", file.path.filename().string()},
                {"camera", file.camera},
                {"position", file.position},
                {"corners", work.seen[i].corners.size()},
                {"sharpness", work.seen[i].sharpness},
                {"is_used", work.pose[i].has_value()}};
    if (work.pose[i]) {
      const geometry::Rigid3& pose = work.pose[i]->camera_from_world;
      const capture::PhotoUse& use = model.photographs[k++];
      one["board_residual_px"] = work.pose[i]->rms;
      one["rotation_wxyz"] = {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(),
                              pose.rotation.z()};
      one["translation_mm"] = records::vector3(pose.translation);
      one["mask_share"] = use.mask_share;
      one["around_share"] = use.around_share;
      one["glare_share"] = use.glare_share;
      one["depth_share"] = use.depth_share;
      one["agreeing_share"] = use.kept_share;
      one["gain"] = use.gain;
    }
    photographs.push_back(std::move(one));
  }
  Json moves = Json::array();
  for (const geometry::Rigid3& one : motion.board_from_hand) {
    moves.push_back({{"rotation_wxyz",
                      {one.rotation.w(), one.rotation.x(), one.rotation.y(), one.rotation.z()}},
                     {"translation_mm", records::vector3(one.translation)}});
  }
  return {{"lenses_were_given", work.lenses_were_given},
          {"lenses", Json::parse(person_records::format_lenses(work.lenses)).at("cameras")},
          {"motion",
           {{"points", motion.tracks},
            {"median_residual_px", motion.after},
            {"median_residual_without_px", motion.before},
            {"is_corrected", motion.is_applied},
            {"largest_shift_mm", motion.largest_shift},
            {"largest_turn_deg", motion.largest_turn * geometry::kDegreesPerRadian},
            {"board_from_hand", std::move(moves)}}},
          {"reduction", model.reduction},
          {"hull_volume_mm3", model.hull_volume},
          {"points", model.points},
          {"vertices", model.skin.mesh.vertices.size()},
          {"triangles", model.skin.mesh.triangles.size()},
          {"measured_share", model.measured_share},
          {"has_background", model.has_background},
          {"gloss_share", model.light.gloss},
          {"light_change_share", model.light.change},
          {"seconds", seconds},
          {"warnings", work.warnings},
          {"photographs", std::move(photographs)}};
}

PhotoMeshReport report_of(const Json& json) {
  PhotoMeshReport report;
  const Json& motion = json.at("motion");
  double residual = 0.0;
  for (const Json& one : json.at("photographs")) {
    if (!one.at("is_used").get<bool>()) continue;
    ++report.used;
    residual += one.at("board_residual_px").get<double>();
  }
  report.photographs = json.at("photographs").size();
  report.board_residual = residual / static_cast<double>(report.used);
  report.motion_is_corrected = motion.at("is_corrected").get<bool>();
  report.motion_points = motion.at("points").get<int>();
  report.largest_shift = motion.at("largest_shift_mm").get<double>();
  report.largest_turn = motion.at("largest_turn_deg").get<double>() / geometry::kDegreesPerRadian;
  report.residual_before = motion.at("median_residual_without_px").get<double>();
  report.residual_after = motion.at("median_residual_px").get<double>();
  report.points = json.at("points").get<std::size_t>();
  report.triangles = json.at("triangles").get<std::size_t>();
  report.measured_share = json.at("measured_share").get<double>();
  report.warnings = json.at("warnings").get<std::vector<std::string>>();
  report.json = json.dump(1) + "\n";
  return report;
}

}  // namespace

PhotoMeshReport photo_mesh_report(const PosedPhotographs& work, const capture::PhotoModel& model,
                                  double seconds, const std::string& key,
                                  const std::string& mesh_digest) {
  Json json = json_of_mesh(work, model, seconds);
  json["key"] = key;
  json["mesh_sha256"] = mesh_digest;
  return report_of(json);
}

std::optional<PhotoMeshReport> read_photo_mesh_report(const std::string& json,
                                                      const std::string& key,
                                                      const std::string& mesh_digest) {
  try {
    const Json read = Json::parse(json);
    if (read.at("key") != key || read.at("mesh_sha256") != mesh_digest) return {};
    return report_of(read);
  } catch (const Json::exception&) {
    return {};
  }
}

}  // namespace palmar::person_workflow
