// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/painted_hand_file.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/records/json_values.h"

namespace palmar::person_records {

void write_painted_hand(const std::string& folder, const phantom::PaintedHand& hand,
                        std::uint64_t seed,
                        const std::map<hand::ScanPosture, PaintedHandPlace>& places) {
  using PlainJson = nlohmann::ordered_json;
  const std::filesystem::path root(folder);
  formats::create_folder(root);
  PlainJson json = {{"name", hand.name},
                    {"seed", seed},
                    {"side", std::string(name_of(hand.side))},
                    {"frame", "of each scan; mm"}};
  PlainJson dimensions = PlainJson::object();
  for (const hand::HandDimension& dimension : hand::all_hand_dimensions()) {
    dimensions[std::string(name_of(dimension)) + "_mm"] =
        hand::value_of(hand.dimensions, dimension);
  }
  json["dimensions"] = std::move(dimensions);
  PlainJson postures = PlainJson::object();
  for (const auto& [name, place] : places) {
    const phantom::PaintedPosture& posture = hand.postures.at(name);
    const geometry::Rigid3& to = place.scan_from_hand;
    PlainJson one = {{"scan", place.file}};
    PlainJson angles = PlainJson::object();
    for (std::size_t d = 0; d < posture.angles.size(); ++d) {
      angles[std::string(name_of(static_cast<hand::Dof>(d))) + "_deg"] =
          posture.angles[d] * 180.0 / std::numbers::pi;
    }
    one["angles"] = std::move(angles);
    PlainJson joints = PlainJson::array();
    for (const auto& [segment, joint] : posture.joint) {
      joints.push_back({{"segment", std::string(name_of(segment))},
                        {"axis", records::vector3(to.rotation * joint.axis)},
                        {"centre_mm", records::vector3(to * joint.centre)}});
    }
    one["flexion_axes"] = std::move(joints);
    PlainJson tips = PlainJson::object();
    for (const auto& [segment, tip] : posture.fingertip) {
      tips[std::string(name_of(segment))] = records::vector3(to * tip);
    }
    one["fingertips_mm"] = std::move(tips);
    PlainJson dots = PlainJson::array();
    for (const phantom::PaintedDot& dot : posture.dots) {
      dots.push_back({{"segment", std::string(name_of(dot.segment))},
                      {"point_mm", records::vector3(to * dot.point)}});
    }
    one["dots"] = std::move(dots);
    PlainJson creases = PlainJson::object();
    for (const auto& [segment, line] : posture.crease) {
      PlainJson points = PlainJson::array();
      for (const Vec3& p : line) points.push_back(records::vector3(to * p));
      creases[std::string(name_of(segment))] = std::move(points);
    }
    one["proximal_creases_mm"] = std::move(creases);
    postures[std::string(name_of(name))] = std::move(one);
    geometry::TriangleMesh skin{posture.skin, hand.triangles};
    for (Vec3& v : skin.vertices) v = to * v;
    formats::write_mesh(root / (std::string(name_of(name)) + ".ply"), skin);
  }
  json["postures"] = std::move(postures);
  formats::write_file(root / "subject.json", json.dump(1) + "\n");
}

capture::ScanTruth read_scan_truth(const std::string& path) {
  using PlainJson = nlohmann::json;
  const auto vector = [](const PlainJson& v) {
    return Vec3(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
  };
  const auto segment = [&](const std::string& name) {
    const auto known = hand::segment_named(name);
    if (!known) throw InputError(path + ": segment \"" + name + "\" is unknown");
    return *known;
  };
  capture::ScanTruth truth;
  try {
    const PlainJson json = PlainJson::parse(formats::read_file(path));
    for (const hand::HandDimension& dimension : hand::all_hand_dimensions()) {
      hand::set_value(
          truth.dimensions, dimension,
          json.at("dimensions").at(std::string(name_of(dimension)) + "_mm").get<double>());
    }
    for (const auto& [name, one] : json.at("postures").items()) {
      const auto posture = hand::scan_posture_in(name);
      if (!posture) throw InputError(path + ": \"" + name + "\" is no posture");
      capture::PlacedJoints& placed = truth.postures[*posture];
      for (const PlainJson& joint : one.at("flexion_axes")) {
        placed.joint[segment(joint.at("segment").get<std::string>())] = {
            vector(joint.at("axis")), vector(joint.at("centre_mm"))};
      }
      if (!one.contains("fingertips_mm")) continue;
      for (const auto& [tip, point] : one.at("fingertips_mm").items()) {
        placed.fingertip[segment(tip)] = vector(point);
      }
    }
  } catch (const PlainJson::exception& error) {
    throw InputError(
        path + ": isn't the truth of a synthetic person's scans: " + formats::json_reason(error));
  }
  const auto skin = std::filesystem::path(path).parent_path() / "reference.ply";
  if (std::filesystem::exists(skin)) truth.skin = formats::read_mesh(skin).mesh;
  return truth;
}

}  // namespace palmar::person_records
