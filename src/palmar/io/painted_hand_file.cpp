// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/painted_hand_file.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "palmar/hand/hand_dimension.h"
#include "palmar/io/file.h"
#include "palmar/io/json_values.h"
#include "palmar/io/mesh_file.h"

namespace palmar {

void write_painted_hand(const std::string& folder, const PaintedHand& hand, std::uint64_t seed,
                        const std::map<ScanPosture, PaintedHandPlace>& places) {
  using Json = nlohmann::ordered_json;
  const std::filesystem::path root(folder);
  create_folder(root);
  Json json = {{"name", hand.name},
               {"seed", seed},
               {"side", std::string(name_of(hand.side))},
               {"frame", "of each scan; mm"}};
  Json dimensions = Json::object();
  for (const HandDimension& dimension : all_hand_dimensions()) {
    dimensions[std::string(name_of(dimension)) + "_mm"] = value_of(hand.dimensions, dimension);
  }
  json["dimensions"] = std::move(dimensions);
  Json postures = Json::object();
  for (const auto& [name, place] : places) {
    const PaintedPosture& posture = hand.postures.at(name);
    const Rigid3& to = place.scan_from_hand;
    Json one = {{"scan", place.file}};
    Json angles = Json::object();
    for (std::size_t d = 0; d < posture.angles.size(); ++d) {
      angles[std::string(name_of(static_cast<Dof>(d))) + "_deg"] =
          posture.angles[d] * 180.0 / std::numbers::pi;
    }
    one["angles"] = std::move(angles);
    Json joints = Json::array();
    for (const auto& [segment, joint] : posture.joint) {
      joints.push_back({{"segment", std::string(name_of(segment))},
                        {"axis", vector3(to.rotation * joint.axis)},
                        {"centre_mm", vector3(to * joint.centre)}});
    }
    one["flexion_axes"] = std::move(joints);
    Json dots = Json::array();
    for (const PaintedDot& dot : posture.dots) {
      dots.push_back(
          {{"segment", std::string(name_of(dot.segment))}, {"point_mm", vector3(to * dot.point)}});
    }
    one["dots"] = std::move(dots);
    Json creases = Json::object();
    for (const auto& [segment, line] : posture.crease) {
      Json points = Json::array();
      for (const Vec3& p : line) points.push_back(vector3(to * p));
      creases[std::string(name_of(segment))] = std::move(points);
    }
    one["proximal_creases_mm"] = std::move(creases);
    postures[std::string(name_of(name))] = std::move(one);
    TriangleMesh skin{posture.skin, hand.triangles};
    for (Vec3& v : skin.vertices) v = to * v;
    write_mesh(root / (std::string(name_of(name)) + ".ply"), skin);
  }
  json["postures"] = std::move(postures);
  write_file(root / "subject.json", json.dump(1) + "\n");
}

}  // namespace palmar
