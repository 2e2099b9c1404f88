// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/mri_subject_file.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/formats/file.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/hand/dimensions/hand_dimension.h"

namespace palmar::person_records {
namespace {

using Json = nlohmann::ordered_json;

Json vector_json(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

Json placement_json(const geometry::Rigid3& pose) {
  const Quat& q = pose.rotation;
  return {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
          {"translation_mm", vector_json(pose.translation)}};
}

Json angles_json(const std::array<double, hand::kDofCount>& angles) {
  Json json = Json::object();
  for (std::size_t d = 0; d < angles.size(); ++d) {
    json[std::string(name_of(static_cast<hand::Dof>(d)))] = angles[d] * 180.0 / std::numbers::pi;
  }
  return json;
}

}  // namespace

void write_mri_subject(const std::string& folder, const phantom::MriSubject& subject,
                       const std::map<hand::ScanPosture, std::string>& series, std::uint64_t seed) {
  const std::filesystem::path root(folder);
  Json json = {{"name", subject.name},
               {"seed", seed},
               {"side", std::string(name_of(subject.side))},
               {"frame", "patient (DICOM): x to the left, y to the back, z to the head; mm"}};
  Json dimensions = Json::object();
  for (const hand::HandDimension& dimension : hand::all_hand_dimensions()) {
    dimensions[std::string(name_of(dimension)) + "_mm"] =
        hand::value_of(subject.dimensions, dimension);
  }
  json["dimensions"] = std::move(dimensions);
  Json axes = Json::array();
  for (const phantom::MriSubject::TrueAxis& axis : subject.axes) {
    axes.push_back({{"joint", axis.joint},
                    {"axis", vector_json(axis.axis)},
                    {"point_mm", vector_json(axis.point)}});
  }
  json["axes_at_reference"] = std::move(axes);
  Json postures = Json::object();
  for (const auto& [posture, state] : subject.postures) {
    if (!series.contains(posture)) continue;
    const std::string name(name_of(posture));
    Json bones = Json::object();
    for (const auto& [bone, pose] : state.bone) bones[bone] = placement_json(pose);
    Json markers = Json::array();
    for (const Vec3& marker : state.markers) markers.push_back(vector_json(marker));
    Json entry = {{"series", series.at(posture)}};
    if (const auto angles = subject.angles.find(posture); angles != subject.angles.end()) {
      entry["angles_deg"] = angles_json(angles->second);
    }
    entry["markers_mm"] = std::move(markers);
    entry["patient_from_reference"] = std::move(bones);
    postures[name] = std::move(entry);

    formats::create_folder(root / name / "bones");
    formats::write_mesh(root / name / "skin.ply", state.skin);
    if (state.product.triangle_count() > 0) {
      formats::write_mesh(root / name / "product.ply", state.product);
    }
    for (const hand::Bone& bone : subject.bones) {
      const auto pose = state.bone.find(bone.name);
      if (pose == state.bone.end()) continue;
      geometry::TriangleMesh mesh = bone.mesh;
      for (Vec3& vertex : mesh.vertices) vertex = pose->second * vertex;
      formats::write_mesh(root / name / "bones" / (bone.name + ".ply"), mesh);
    }
  }
  json["postures"] = std::move(postures);
  formats::create_folder(root);
  formats::write_file(root / "subject.json", json.dump(1) + "\n");
}

}  // namespace palmar::person_records
