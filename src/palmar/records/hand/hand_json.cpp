// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/hand_json.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/hand/skeleton_json.h"
#include "palmar/records/json_values.h"

#include <nlohmann/json.hpp>

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json dof_json(const hand::JointDof& dof) {
  return {{"dof", name_of(dof.dof)},
          {"axis", vector3(dof.axis)},
          {"centre_mm", vector3(dof.centre)},
          {"lower_deg", dof.lower * geometry::kDegreesPerRadian},
          {"upper_deg", dof.upper * geometry::kDegreesPerRadian},
          {"reference_deg", dof.reference * geometry::kDegreesPerRadian},
          {"source", dof.source}};
}

Json info_of(const hand::Hand& hand) {
  const hand::HandDimensions& d = hand.dimensions;
  Json segments = Json::object();
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& size = d.segment[s];
    segments[std::string(name_of(static_cast<hand::Segment>(s)))] = {
        {"length_mm", size.length}, {"width_mm", size.width}, {"thickness_mm", size.thickness}};
  }
  Json joints = Json::array();
  int dof_count = 0;
  for (const hand::Joint& joint : hand.skeleton.joints) {
    Json dofs = Json::array();
    for (const hand::JointDof& dof : joint.dofs) dofs.push_back(dof_json(dof));
    dof_count += static_cast<int>(joint.dofs.size());
    joints.push_back({{"joint", name_of(joint.id)},
                      {"centre_mm", vector3(joint.centre)},
                      {"degrees_of_freedom", std::move(dofs)}});
  }
  Json bones = Json::array();
  for (const hand::Bone& bone : hand.bones) bones.push_back(bone.name);
  return Json{{"name", hand.name},
              {"side", name_of(hand.side)},
              {"vertices", hand.skin.vertex_count()},
              {"triangles", hand.skin.triangle_count()},
              {"hand_length_mm", d.hand_length},
              {"hand_circumference_mm", d.hand_circumference},
              {"hand_width_mm", d.hand_width},
              {"hand_thickness_mm", d.hand_thickness},
              {"segments", std::move(segments)},
              {"degree_of_freedom_count", dof_count},
              {"joints", std::move(joints)},
              {"bones", std::move(bones)},
              {"tissue_source", hand.tissue.source},
              {"provenance", hand.provenance}};
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);  // names may be no UTF-8
}

}  // namespace

std::string hand_info_json(const hand::Hand& hand) { return text_of(info_of(hand)); }

std::string hand_measures_json(const hand::Hand& hand, const hand::HandTape& tape) {
  Json json = info_of(hand);
  for (const hand::TapeValue& value : hand::values_of(tape)) {
    Json& place = value.segment ? json["segments"][std::string(name_of(*value.segment))] : json;
    place[std::string(value.quantity) + "_mm"] = value.value;
  }
  return text_of(json);
}

std::string tissue_json(const hand::Tissue& tissue) {
  return tissue_to_json(tissue).dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace palmar::records
