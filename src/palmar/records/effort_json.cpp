// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/effort_json.h"

#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/core/version.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json fingertip_object(const effort::FingertipForce& tip, const hand::Posture& posture) {
  Json joints = Json::array();
  Json angles = Json::object();
  for (std::size_t k = 0; k < tip.dof.size(); ++k) {
    const std::string name(name_of(tip.dof[k]));
    angles[name + "_deg"] = posture[tip.dof[k]] * 180.0 / std::numbers::pi;
    joints.push_back({{"angle", name},
                      {"moment_arm_mm", tip.moment_arm[k]},
                      {"moment_n_mm", tip.tendon_force * tip.moment_arm[k]}});
  }
  return {{"finger", name_of(tip.finger)},
          {"tendon", name_of(tip.tendon)},
          {"tendon_name", hand::anatomical_name_of(tip.tendon)},
          {"tendon_force_n", tip.tendon_force},
          {"posture", std::move(angles)},
          {"frame", "hand: x towards the thumb in a right hand, y distal, z palmar"},
          {"fingertip_force_n", vector3(tip.force)},
          {"fingertip_force_magnitude_n", tip.force.norm()},
          {"fingertip_force_distal_phalanx_n",
           {{"radial", tip.force_in_phalanx.x()},
            {"distal", tip.force_in_phalanx.y()},
            {"palmar", tip.force_in_phalanx.z()}}},
          {"fingertip_moment_n_mm", tip.moment},
          {"fingertip_mm", vector3(tip.point)},
          {"joints", std::move(joints)}};
}

Json digit_object(const effort::DigitEffort& digit) {
  Json joints = Json::array(), tendons = Json::array();
  for (const effort::JointEffort& joint : digit.joints) {
    joints.push_back({{"angle", name_of(joint.dof)},
                      {"external_moment_n_mm", joint.external},
                      {"muscle_moment_n_mm", joint.muscles},
                      {"stop_moment_n_mm", joint.stop},
                      {"missing_moment_n_mm", joint.missing}});
  }
  for (const effort::TendonLoad& load : digit.tendons) {
    Json arms = Json::object();
    for (std::size_t k = 0; k < load.moment_arm.size(); ++k) {
      arms[std::string(name_of(digit.joints[k].dof))] = load.moment_arm[k];
    }
    tendons.push_back({{"tendon", name_of(load.tendon)},
                       {"force_n", load.force},
                       {"strength_n", load.strength},
                       {"activation", load.activation},
                       {"moment_arms_mm", std::move(arms)}});
  }
  return {{"finger", name_of(digit.finger)},        {"status", name_of(digit.status)},
          {"contact_force_n", digit.contact_force}, {"joints", std::move(joints)},
          {"tendons", std::move(tendons)},          {"kkt_residual", digit.kkt_residual},
          {"iterations", digit.iterations}};
}

Json wrist_object(const effort::WristEffort& wrist) {
  Json muscles = Json::array();
  for (int i = 0; i < hand::kWristMuscleCount; ++i) {
    const auto muscle = static_cast<hand::WristMuscle>(i);
    muscles.push_back({{"muscle", name_of(muscle)},
                       {"force_n", wrist.force[index_of(muscle)]},
                       {"strength_n", wrist.strength[index_of(muscle)]},
                       {"activation", wrist.activation(muscle)}});
  }
  return {{"muscles", std::move(muscles)},
          {"external_moment_n_mm", wrist.external},
          {"digits_moment_n_mm", wrist.digits},
          {"wrist_moment_n_mm", wrist.muscles},
          {"missing_moment_n_mm", wrist.missing}};
}

Json versions() { return {{"palmar", version()}}; }

}  // namespace

std::string fingertip_json(const std::vector<effort::FingertipForce>& forces,
                           const hand::Posture& posture) {
  Json json;
  if (forces.size() == 1) {
    json = fingertip_object(forces.front(), posture);
  } else {
    Json list = Json::array();
    for (const effort::FingertipForce& force : forces)
      list.push_back(fingertip_object(force, posture));
    json = {{"tendons", std::move(list)}};
  }
  json["versions"] = versions();
  return json.dump(2);
}

std::string effort_json(const effort::EffortResult& effort) {
  Json digits = Json::array(), indices = Json::object();
  for (const effort::DigitEffort& digit : effort.digits) digits.push_back(digit_object(digit));
  for (const grasp::GraspIndex& index : effort::effort_indices(effort)) {
    indices[index.key] = or_null(index.value);
  }
  Json wrist = nullptr;
  if (effort.wrist) wrist = wrist_object(*effort.wrist);
  const Json json = {{"status", name_of(effort.status)},
                     {"message", effort.message},
                     {"with_friction", effort.with_friction},
                     {"contact_force_n", effort.contact_force},
                     {"tendon_force_n", effort.tendon_force},
                     {"indices", std::move(indices)},
                     {"digits", std::move(digits)},
                     {"wrist", std::move(wrist)},
                     {"versions", versions()}};
  return json.dump(2);
}

}  // namespace palmar::records
