// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/reach_json.h"

#include <nlohmann/json.hpp>

#include "palmar/formats/mesh/vtk.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/json_values.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

Json finger_object(const grasp::FingerReach& reach) {
  Json posture = Json::object();
  for (int d = 0; d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    posture[std::string(name_of(dof)) + "_deg"] = reach.posture[dof] * geometry::kDegreesPerRadian;
  }
  return {{"finger", name_of(reach.finger)},
          {"reached", reach.is_reached},
          {"blocked", reach.is_blocked},
          {"miss_mm", reach.miss},
          {"tilt_deg", reach.tilt * geometry::kDegreesPerRadian},
          {"margin_deg", reach.margin * geometry::kDegreesPerRadian},
          {"tightest", name_of(reach.tightest)},
          {"awkward", reach.is_awkward},
          {"grip_kept", reach.is_grip_kept},
          {"posture", std::move(posture)}};
}

}  // namespace

std::string reach_json(const grasp::Grasp& grasp, const std::vector<grasp::ButtonReach>& buttons,
                       const grasp::ReachMap* map, double surface_area) {
  Json list = Json::array();
  for (const grasp::ButtonReach& reach : buttons) {
    Json fingers = Json::array();
    for (const grasp::FingerReach& one : reach.fingers) fingers.push_back(finger_object(one));
    list.push_back({{"name", reach.button.name},
                    {"point_mm", vector3(reach.button.point)},
                    {"force_n", vector3(reach.button.force)},
                    {"best", reach.best ? Json(name_of(*reach.best)) : Json(nullptr)},
                    {"message", reach.message},
                    {"fingers", std::move(fingers)}});
  }
  Json json = {{"grasp",
                {{"grip", name_of(grasp.grip)},
                 {"status", name_of(grasp.status)},
                 {"message", grasp.message}}},
               {"buttons", std::move(list)},
               {"map", nullptr}};
  if (map != nullptr) {
    json["map"] = {{"points", map->points},
                   {"reached_area_mm2", map->reached_area},
                   {"surface_area_mm2", surface_area}};
  }
  // File names may hold bytes that are no UTF-8; they must not stop the output.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string format_reach_map(const geometry::TriangleMesh& surface, const grasp::ReachMap& map) {
  formats::PointField finger{"finger", {}, 1}, margin{"margin_deg", {}, 1},
      miss{"miss_mm", map.miss, 1};
  for (const int f : map.finger) finger.value.push_back(f);
  for (const double m : map.margin) margin.value.push_back(m * geometry::kDegreesPerRadian);
  return formats::format_vtp(
      surface, {finger, margin, miss},
      {{"finger", "-1 nobody, 0 thumb, 1 index, 2 middle, 3 ring, 4 little"}});
}

}  // namespace palmar::records
