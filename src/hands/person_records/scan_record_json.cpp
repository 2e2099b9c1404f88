// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/scan_record_json.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/hand/hand_json.h"
#include "palmar/records/json_values.h"

namespace palmar::person_records {
namespace {

using Json = nlohmann::ordered_json;

Json name_json(std::string_view name) { return std::string(name); }

Json scans_json(const capture::ScanRecord& record) {
  Json list = Json::array();
  for (const capture::RecordedScan& scan : record.scans) {
    const capture::ScanSurfaces& surfaces = scan.surfaces;
    Json bones = Json::array();
    int unnamed = 0;
    for (const capture::ScannedBone& bone : surfaces.bones) {
      if (bone.name.empty()) ++unnamed;
      if (!bone.name.empty()) bones.push_back(bone.name);
    }
    list.push_back({{"posture", name_json(name_of(scan.posture))},
                    {"series", scan.title},
                    {"side", name_json(name_of(surfaces.side))},
                    {"was_kept", scan.was_kept},
                    {"bones", std::move(bones)},
                    {"unnamed_bones", unnamed},
                    {"markers", surfaces.markers.size()},
                    {"air_threshold", surfaces.air_threshold},
                    {"bone_threshold", surfaces.bone_threshold},
                    {"noise", surfaces.noise},
                    {"bone_error_estimate_mm", surfaces.bone_error_estimate},
                    {"fat_shift_mm", records::vector3(surfaces.fat_shift)},
                    {"notes", surfaces.notes}});
  }
  return list;
}

Json joints_json(const capture::ScanRecord& record) {
  const geometry::Rigid3& patient = record.made.patient_from_hand;
  Json list = Json::array();
  for (const hand::Joint& joint : record.made.hand.skeleton.joints) {
    for (const hand::JointDof& dof : joint.dofs) {
      std::optional<double> axis_error = record.joints.axis_error[index_of(dof.dof)];
      if (axis_error) *axis_error *= geometry::kDegreesPerRadian;
      list.push_back({{"joint", name_json(name_of(joint.id))},
                      {"dof", name_json(name_of(dof.dof))},
                      {"is_measured", record.joints.is_measured[index_of(dof.dof)]},
                      {"axis_error_deg", records::or_null(axis_error)},
                      {"axis", records::vector3(dof.axis)},
                      {"centre_mm", records::vector3(dof.centre)},
                      {"axis_patient", records::vector3(patient.rotation * dof.axis)},
                      {"centre_patient_mm", records::vector3(patient * dof.centre)},
                      {"lower_deg", dof.lower * geometry::kDegreesPerRadian},
                      {"upper_deg", dof.upper * geometry::kDegreesPerRadian},
                      {"reference_deg", dof.reference * geometry::kDegreesPerRadian}});
    }
  }
  return list;
}

Json cmc_json(const hand::ThumbCmc& cmc) {
  const auto limit = [](const hand::CmcLimit& one) -> Json {
    return {{"quaternion_wxyz", {one.q.w(), one.q.x(), one.q.y(), one.q.z()}},
            {"translation_mm", records::vector3(one.t)}};
  };
  return {{"flexion", limit(cmc.flexion)},
          {"extension", limit(cmc.extension)},
          {"abduction", limit(cmc.abduction)},
          {"adduction", limit(cmc.adduction)}};
}

Json postures_json(const capture::ScanRecord& record) {
  Json all = Json::object();
  for (const auto& [posture, angles] : record.joints.postures) {
    Json one = Json::object();
    for (int d = 0; d < hand::kDofCount; ++d) {
      one[std::string(name_of(static_cast<hand::Dof>(d))) + "_deg"] =
          angles[static_cast<hand::Dof>(d)] * geometry::kDegreesPerRadian;
    }
    all[std::string(name_of(posture))] = std::move(one);
  }
  return all;
}

Json error_json(hand::ScanPosture posture, const std::string& bone, double icp, double single_axis,
                const std::optional<double>& interpolated) {
  return {{"posture", name_json(name_of(posture))},
          {"bone", bone},
          {"icp_mm", icp},
          {"single_axis_mm", single_axis},
          {"interpolated_cmc_mm", records::or_null(interpolated)}};
}

Json bone_errors_json(const capture::ScanRecord& record) {
  Json list = Json::array();
  for (const capture::BoneError& e : record.joints.errors) {
    list.push_back(error_json(e.posture, e.bone, e.icp, e.single_axis, e.interpolated_cmc));
  }
  return list;
}

Json rows_json(const capture::ScanRecord& record) {
  Json list = Json::array();
  for (const capture::ErrorRow& row : capture::error_rows(record.joints.errors)) {
    list.push_back(
        error_json(row.posture, row.bones, row.icp, row.single_axis, row.interpolated_cmc));
  }
  return list;
}

Json skin_errors_json(const capture::ScanRecord& record) {
  Json list = Json::array();
  for (const capture::SkinError& e : record.made.skin_errors) {
    list.push_back({{"posture", name_json(name_of(e.posture))},
                    {"skinning_only_mm", e.skinning_only},
                    {"markers_alone_mm", records::or_null(e.by_markers)},
                    {"corrected_mm", records::or_null(e.corrected)}});
  }
  return list;
}

Json contact_json(const std::optional<capture::ScanContact>& contact) {
  if (!contact) return nullptr;
  const capture::ContactOverlap& c = contact->overlap;
  return {
      {"product", contact->product},      {"range_mm", contact->range},
      {"hand_area_mm2", c.hand_area},     {"scanned_area_mm2", c.scanned_area},
      {"shared_area_mm2", c.shared_area}, {"intersection_over_union", c.intersection_over_union},
      {"share_of_hand", c.share_of_hand}, {"share_of_scan", c.share_of_scan}};
}

Json motion_list(const std::vector<capture::BoneMotion>& motions) {
  Json list = Json::array();
  for (const capture::BoneMotion& motion : motions) {
    const Quat& q = motion.posture_from_reference.rotation;
    Json one = {{"bone", motion.bone},
                {"counterpart", motion.counterpart},
                {"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                {"translation_mm", records::vector3(motion.posture_from_reference.translation)},
                {"mean_distance_mm", nullptr},
                {"overlap", nullptr},
                {"conditioning", nullptr},
                {"image", nullptr}};
    if (motion.is_cut_out) {
      one["mean_distance_mm"] = motion.fit.mean;
      one["overlap"] = motion.fit.overlap;
      one["conditioning"] = motion.fit.conditioning;
    }
    if (motion.image) {
      one["image"] = {{"correlation", motion.image->correlation},
                      {"overlap", motion.image->overlap},
                      {"turn_error_deg", motion.image->turn_error * geometry::kDegreesPerRadian},
                      {"shift_error_mm", motion.image->shift_error}};
    }
    list.push_back(std::move(one));
  }
  return list;
}

Json motions_json(const capture::ScanRecord& record) {
  Json all = Json::object();
  for (const auto& [posture, motions] : record.motions) {
    all[std::string(name_of(posture))] = motion_list(motions);
  }
  return all;
}

std::string cell(const std::optional<double>& value) {
  return value ? fmt::format("{:.4f}", *value) : "";
}

}  // namespace

std::string scan_record_json(const capture::ScanRecord& record) {
  const geometry::Rigid3& patient = record.made.patient_from_hand;
  const Quat& q = patient.rotation;
  const Json json = {
      {"side", name_json(name_of(record.made.hand.side))},
      {"scans", scans_json(record)},
      {"hand", Json::parse(records::hand_info_json(record.made.hand))},
      {"patient_from_hand",
       {{"quaternion_wxyz", {q.w(), q.x(), q.y(), q.z()}},
        {"translation_mm", records::vector3(patient.translation)}}},
      {"joints", joints_json(record)},
      {"thumb_cmc_limits", cmc_json(record.made.hand.skeleton.thumb_cmc)},
      {"postures", postures_json(record)},
      {"bone_motions", motions_json(record)},
      {"bone_errors", bone_errors_json(record)},
      {"bone_error_rows", rows_json(record)},
      {"skin_errors", skin_errors_json(record)},
      {"grasp_contact", contact_json(record.contact)},
      {"skin_registration",
       {{"mean_mm", record.made.registration_mean}, {"p95_mm", record.made.registration_p95}}},
      {"notes", record.notes}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string refused_scans_json(const capture::ScanRecord& record,
                               const capture::ScanRefusal& refusal) {
  const Json json = {{"refusal",
                      {{"step", refusal.step},
                       {"posture", refusal.posture.empty() ? Json(nullptr) : Json(refusal.posture)},
                       {"message", refusal.message}}},
                     {"side", name_json(name_of(record.scans.front().surfaces.side))},
                     {"scans", scans_json(record)},
                     {"bone_motions", motions_json(record)},
                     {"notes", record.notes}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string bone_motions_json(const std::vector<capture::BoneMotion>& motions) {
  return Json{{"motions", motion_list(motions)}}.dump(2, ' ', false,
                                                      Json::error_handler_t::replace);
}

records::CsvTable bone_error_table(const capture::ScanRecord& record) {
  records::CsvTable table{{"posture", "bone", "icp_mm", "single_axis_mm", "interpolated_cmc_mm"},
                          {}};
  for (const capture::BoneError& e : record.joints.errors) {
    table.rows.push_back({std::string(name_of(e.posture)), e.bone, cell(e.icp), cell(e.single_axis),
                          cell(e.interpolated_cmc)});
  }
  return table;
}

records::CsvTable skin_error_table(const capture::ScanRecord& record) {
  records::CsvTable table{{"posture", "skinning_only_mm", "markers_alone_mm", "corrected_mm"}, {}};
  for (const capture::SkinError& e : record.made.skin_errors) {
    table.rows.push_back({std::string(name_of(e.posture)), cell(e.skinning_only),
                          cell(e.by_markers), cell(e.corrected)});
  }
  return table;
}

records::CsvTable grasp_contact_table(const capture::ScanContact& contact) {
  const capture::ContactOverlap& c = contact.overlap;
  return {{"product", "range_mm", "hand_area_mm2", "scanned_area_mm2", "shared_area_mm2",
           "intersection_over_union", "share_of_hand", "share_of_scan"},
          {{contact.product, cell(contact.range), cell(c.hand_area), cell(c.scanned_area),
            cell(c.shared_area), cell(c.intersection_over_union), cell(c.share_of_hand),
            cell(c.share_of_scan)}}};
}

}  // namespace palmar::person_records
