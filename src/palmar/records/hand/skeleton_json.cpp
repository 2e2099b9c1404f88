// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/skeleton_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/hand/tissue.h"

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

constexpr double kFarthestJoint = 1000.0;  // mm from the hand frame's origin; our choice

PlainJson to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

double finite(const PlainJson& json) {
  const double value = json.get<double>();
  if (!std::isfinite(value)) throw InputError("a number is not finite");
  return value;
}

Vec3 vec3_from(const PlainJson& json) {
  if (!json.is_array() || json.size() != 3) throw InputError("a point needs 3 numbers");
  return {finite(json[0]), finite(json[1]), finite(json[2])};
}

PlainJson to_json(const hand::CmcLimit& limit) {
  return {{"q_xyzw", {limit.q.x(), limit.q.y(), limit.q.z(), limit.q.w()}},
          {"t_mm", to_json(limit.t)}};
}

hand::CmcLimit limit_from(const PlainJson& json) {
  const PlainJson& q = json.at("q_xyzw");
  if (!q.is_array() || q.size() != 4) throw InputError("a quaternion needs 4 numbers");
  hand::CmcLimit limit;
  limit.q = Quat(finite(q[3]), finite(q[0]), finite(q[1]), finite(q[2]));
  if (std::abs(limit.q.norm() - 1.0) > 1e-6) {
    throw InputError("a CMC limit posture has a quaternion of length " +
                     std::to_string(limit.q.norm()) + "; 1 is needed");
  }
  limit.t = vec3_from(json.at("t_mm"));
  return limit;
}

struct LimitName {
  const char* name;
  hand::CmcLimit hand::ThumbCmc::*limit;
};
constexpr std::array<LimitName, 4> kLimits = {{{"flexion", &hand::ThumbCmc::flexion},
                                               {"extension", &hand::ThumbCmc::extension},
                                               {"abduction", &hand::ThumbCmc::abduction},
                                               {"adduction", &hand::ThumbCmc::adduction}}};

struct TissueName {
  const char* name;
  double hand::RegionTissue::*value;
};
constexpr std::array<TissueName, 5> kTissue = {
    {{"poisson_layered", &hand::RegionTissue::poisson_layered},
     {"swelling_height_mm", &hand::RegionTissue::swelling_height},
     {"swelling_radius_mm", &hand::RegionTissue::swelling_radius},
     {"swelling_width_mm", &hand::RegionTissue::swelling_width},
     {"neighbourhood_mm", &hand::RegionTissue::neighbourhood}}};

PlainJson to_json(const hand::StiffeningLaw& law) {
  return {{"g0_mpa", law.g0}, {"g_limit_mpa", law.g_limit}, {"limit_depth_mm", law.limit_depth}};
}

hand::StiffeningLaw law_from(const PlainJson& json) {
  return {finite(json.at("g0_mpa")), finite(json.at("g_limit_mpa")),
          finite(json.at("limit_depth_mm"))};
}

PlainJson to_json(const hand::TissueStiffness& stiffness) {
  return {{"nominal", to_json(stiffness.nominal)},
          {"low", to_json(stiffness.low)},
          {"high", to_json(stiffness.high)}};
}

hand::TissueStiffness stiffness_from(const PlainJson& json) {
  return {law_from(json.at("nominal")), law_from(json.at("low")), law_from(json.at("high"))};
}

PlainJson to_json(const hand::BoneTissueLaw& law) {
  return {{"g0_mpa", law.g0}, {"stiffening", law.stiffening}};
}

hand::BoneTissueLaw bone_law_from(const PlainJson& json) {
  return {finite(json.at("g0_mpa")), finite(json.at("stiffening"))};
}

/// Version 1 of the file has one law per region, that of the half-space.
hand::RegionTissue region_tissue_version_1(const PlainJson& json,
                                           const hand::RegionTissue& standard) {
  hand::RegionTissue region = standard;
  hand::TissueStiffness& stiffness = region.half_space;
  stiffness.nominal = law_from(json);
  for (double hand::StiffeningLaw::*value :
       {&hand::StiffeningLaw::g0, &hand::StiffeningLaw::g_limit}) {
    stiffness.low.*value = std::min(stiffness.low.*value, stiffness.nominal.*value);
    stiffness.high.*value = std::max(stiffness.high.*value, stiffness.nominal.*value);
  }
  region.source = "";
  return region;
}

hand::JointDof dof_from(const PlainJson& json) {
  hand::JointDof dof;
  const auto name = json.at("dof").get<std::string>();
  const auto known = hand::dof_named(name);
  if (!known) throw InputError("degree of freedom \"" + name + "\" is unknown");
  dof.dof = *known;
  dof.axis = vec3_from(json.at("axis"));
  if (std::abs(dof.axis.norm() - 1.0) > 1e-6) {
    throw InputError("axis of \"" + name + "\" has length " + std::to_string(dof.axis.norm()) +
                     "; a unit vector is needed");
  }
  dof.centre = vec3_from(json.at("centre_mm"));
  if (!(dof.centre.norm() <= kFarthestJoint)) {
    throw InputError(
        fmt::format("centre of \"{}\" is {:g} mm from the origin; at most {:g} are allowed", name,
                    dof.centre.norm(), kFarthestJoint));
  }
  dof.reference = finite(json.at("reference_rad"));
  dof.lower = finite(json.at("lower_rad"));
  dof.upper = finite(json.at("upper_rad"));
  if (!(dof.lower <= dof.upper)) {
    throw InputError("range of \"" + name + "\" is from " + std::to_string(dof.lower) + " to " +
                     std::to_string(dof.upper) + " rad; lower must not be above upper");
  }
  dof.source = json.at("source").get<std::string>();
  return dof;
}

}  // namespace

PlainJson skeleton_to_json(const hand::Skeleton& skeleton) {
  PlainJson json;
  json["joints"] = PlainJson::array();
  for (const hand::Joint& joint : skeleton.joints) {
    PlainJson entry = {{"joint", name_of(joint.id)}, {"centre_mm", to_json(joint.centre)}};
    entry["dofs"] = PlainJson::array();
    for (const hand::JointDof& dof : joint.dofs) {
      entry["dofs"].push_back({{"dof", name_of(dof.dof)},
                               {"axis", to_json(dof.axis)},
                               {"centre_mm", to_json(dof.centre)},
                               {"reference_rad", dof.reference},
                               {"lower_rad", dof.lower},
                               {"upper_rad", dof.upper},
                               {"source", dof.source}});
    }
    json["joints"].push_back(std::move(entry));
  }
  for (const LimitName& limit : kLimits) {
    json["thumb_cmc"][limit.name] = to_json(skeleton.thumb_cmc.*limit.limit);
  }
  json["fingertips_mm"] = PlainJson::array();
  for (const Vec3& tip : skeleton.fingertips) json["fingertips_mm"].push_back(to_json(tip));
  return json;
}

hand::Skeleton skeleton_from_json(const PlainJson& json) {
  hand::Skeleton skeleton;
  const PlainJson& joints = json.at("joints");
  if (joints.size() != hand::kJointCount) {
    throw InputError(std::to_string(joints.size()) + " joints; " +
                     std::to_string(hand::kJointCount) + " are needed");
  }
  std::array<bool, hand::kDofCount> has_dof{};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto name = joints[j].at("joint").get<std::string>();
    if (hand::joint_named(name) != static_cast<hand::JointId>(j)) {
      throw InputError("joint " + std::to_string(j) + " is \"" + name + "\"; \"" +
                       std::string(name_of(static_cast<hand::JointId>(j))) + "\" is needed there");
    }
    hand::Joint& joint = skeleton.joints[j];
    joint.id = static_cast<hand::JointId>(j);
    joint.centre = vec3_from(joints[j].at("centre_mm"));
    for (const PlainJson& entry : joints[j].at("dofs")) {
      joint.dofs.push_back(dof_from(entry));
      has_dof[index_of(joint.dofs.back().dof)] = true;
    }
  }
  for (std::size_t d = 0; d < has_dof.size(); ++d) {
    if (!has_dof[d]) {
      throw InputError("degree of freedom \"" + std::string(name_of(static_cast<hand::Dof>(d))) +
                       "\" is missing");
    }
  }
  for (const LimitName& limit : kLimits) {
    skeleton.thumb_cmc.*limit.limit = limit_from(json.at("thumb_cmc").at(limit.name));
  }
  for (std::size_t f = 0; f < hand::kFingerCount; ++f) {
    skeleton.fingertips[f] = vec3_from(json.at("fingertips_mm").at(f));
  }
  return skeleton;
}

PlainJson dimensions_to_json(const hand::HandDimensions& dimensions) {
  PlainJson json = {{"hand_length_mm", dimensions.hand_length},
                    {"hand_circumference_mm", dimensions.hand_circumference},
                    {"hand_width_mm", dimensions.hand_width},
                    {"hand_thickness_mm", dimensions.hand_thickness}};
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const hand::SegmentDimensions& one = dimensions.segment[s];
    json["segments"][std::string(name_of(static_cast<hand::Segment>(s)))] = {
        {"length_mm", one.length}, {"width_mm", one.width}, {"thickness_mm", one.thickness}};
  }
  return json;
}

hand::HandDimensions dimensions_from_json(const PlainJson& json) {
  hand::HandDimensions dimensions;
  dimensions.hand_length = finite(json.at("hand_length_mm"));
  dimensions.hand_circumference = finite(json.at("hand_circumference_mm"));
  dimensions.hand_width = finite(json.at("hand_width_mm"));
  dimensions.hand_thickness = finite(json.at("hand_thickness_mm"));
  for (int s = 0; s < hand::kSegmentCount; ++s) {
    const PlainJson& one =
        json.at("segments").at(std::string(name_of(static_cast<hand::Segment>(s))));
    dimensions.segment[s] = {finite(one.at("length_mm")), finite(one.at("width_mm")),
                             finite(one.at("thickness_mm"))};
  }
  return dimensions;
}

PlainJson tissue_to_json(const hand::Tissue& tissue) {
  PlainJson json = {{"source", tissue.source}};
  for (int r = 0; r < hand::kRegionCount; ++r) {
    PlainJson& entry = json["regions"][std::string(name_of(static_cast<hand::Region>(r)))];
    const hand::RegionTissue& region = tissue.region[r];
    entry["half_space"] = to_json(region.half_space);
    entry["layered"] = to_json(region.layered);
    entry["on_bone"] = {{"nominal", to_json(region.on_bone.nominal)},
                        {"low", to_json(region.on_bone.low)},
                        {"high", to_json(region.on_bone.high)}};
    for (const TissueName& item : kTissue) entry[item.name] = region.*item.value;
    entry["source"] = region.source;
  }
  return json;
}

hand::Tissue tissue_from_json(const PlainJson& json) {
  const hand::Tissue standard = hand::default_tissue();
  hand::Tissue tissue;
  tissue.source = json.at("source").get<std::string>();
  for (int r = 0; r < hand::kRegionCount; ++r) {
    const std::string name(name_of(static_cast<hand::Region>(r)));
    const PlainJson& entry = json.at("regions").at(name);
    hand::RegionTissue& region = tissue.region[r];
    const bool is_version_1 = entry.contains("g0_mpa");
    if (is_version_1) {
      region = region_tissue_version_1(entry, standard.region[r]);
    } else {
      region.half_space = stiffness_from(entry.at("half_space"));
      region.layered = stiffness_from(entry.at("layered"));
      // Files from before this law have none.
      region.on_bone = standard.region[r].on_bone;
      if (entry.contains("on_bone")) {
        const PlainJson& bone = entry.at("on_bone");
        region.on_bone = {bone_law_from(bone.at("nominal")), bone_law_from(bone.at("low")),
                          bone_law_from(bone.at("high"))};
      }
      region.source = entry.value("source", "");
    }
    for (const TissueName& item : kTissue) {
      const bool is_newer = item.value == &hand::RegionTissue::poisson_layered;
      if (!(is_version_1 && is_newer)) region.*item.value = finite(entry.at(item.name));
    }
    const std::string fault = hand::fault_of(region);
    if (!fault.empty()) throw InputError("tissue of " + name + ": " + fault);
  }
  return tissue;
}

}  // namespace palmar::records
