// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/hand_asset.h"

#include <cmath>
#include <optional>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"
#include "palmar/formats/mesh/glb.h"

namespace palmar::records {
namespace {

constexpr double kMmPerM = 1000.0;

std::vector<double> numbers(const nlohmann::json& node, const char* key, std::size_t count,
                            std::vector<double> otherwise, const std::string& what) {
  if (!node.contains(key)) return otherwise;
  const auto value = node.at(key).get<std::vector<double>>();
  if (value.size() != count) {
    throw InputError(what + ": \"" + key + "\" has " + std::to_string(value.size()) + " numbers, " +
                     std::to_string(count) + " are needed");
  }
  return value;
}

geometry::Rigid3 local_transform(const nlohmann::json& node, const std::string& what) {
  if (node.contains("matrix")) {
    throw InputError(what + ": is placed by a matrix; translation and rotation are needed");
  }
  const auto t = numbers(node, "translation", 3, {0, 0, 0}, what);
  const auto r = numbers(node, "rotation", 4, {0, 0, 0, 1}, what);
  const auto s = numbers(node, "scale", 3, {1, 1, 1}, what);
  for (const double factor : s) {
    // The asset's exporter leaves single-precision noise of a few 1e-7 in the scale.
    if (!(std::abs(factor - 1.0) < 1e-4)) {
      throw InputError(what + ": is scaled by " + std::to_string(factor) + "; 1 is needed");
    }
  }
  geometry::Rigid3 transform;
  transform.rotation = Quat(r[3], r[0], r[1], r[2]);
  if (!(std::abs(transform.rotation.norm() - 1.0) < 1e-3)) {
    throw InputError(what + ": its rotation is no unit quaternion (length " +
                     std::to_string(transform.rotation.norm()) + ")");
  }
  transform.rotation.normalize();
  transform.translation = kMmPerM * Vec3(t[0], t[1], t[2]);
  return transform;
}

hand::HandAsset read_checked(const formats::Glb& glb, const std::string& path) {
  const nlohmann::json& nodes = glb.json.at("nodes");
  std::vector<int> parent(nodes.size(), -1);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!nodes[i].contains("children")) continue;
    for (const auto& child : nodes[i]["children"]) {
      parent.at(formats::json_whole<std::size_t>(child)) = static_cast<int>(i);
    }
  }
  const auto scene_from_node = [&](std::size_t start) {
    geometry::Rigid3 transform;
    std::size_t steps = 0;
    for (int at = static_cast<int>(start); at >= 0; at = parent[at]) {
      const nlohmann::json& node = nodes[at];
      transform =
          local_transform(node, path + ": node \"" + node.value("name", "?") + "\"") * transform;
      if (++steps > nodes.size()) throw InputError(path + ": the nodes form a cycle");
    }
    return transform;
  };

  hand::HandAsset asset;
  std::optional<std::size_t> skinned;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].contains("mesh") && nodes[i].contains("skin")) {
      skinned = i;
      break;
    }
  }
  if (!skinned) throw InputError(path + ": has no mesh with a skin; the generic hand has one");
  const nlohmann::json& skin =
      glb.json.at("skins").at(formats::json_whole<std::size_t>(nodes[*skinned].at("skin")));
  for (const auto& joint : skin.at("joints")) {
    const auto node = formats::json_whole<std::size_t>(joint);
    asset.frames.push_back({nodes.at(node).at("name").get<std::string>(), scene_from_node(node)});
  }

  // Skinned vertices stand in the scene's frame in the bind posture; their node's own transform is
  // ignored (glTF 2.0, section 3.7.3.3).
  const nlohmann::json& mesh =
      glb.json.at("meshes").at(formats::json_whole<std::size_t>(nodes[*skinned].at("mesh")));
  for (const auto& primitive : mesh.at("primitives")) {
    if (formats::json_whole_or<int>(primitive, "mode", 4) != 4) {
      throw InputError(path + ": the skin is not of triangles");
    }
    const formats::AccessorData position = formats::read_accessor(
        glb, formats::json_whole<int>(primitive.at("attributes").at("POSITION")), path);
    const formats::AccessorData index =
        formats::read_accessor(glb, formats::json_whole<int>(primitive.at("indices")), path);
    if (position.components != 3 || index.components != 1 || index.count % 3 != 0) {
      throw InputError(path + ": the skin's positions or indices have the wrong shape");
    }
    const int first = asset.skin.vertex_count();
    for (std::size_t i = 0; i < position.value.size(); i += 3) {
      asset.skin.vertices.push_back(
          kMmPerM * Vec3(position.value[i], position.value[i + 1], position.value[i + 2]));
    }
    for (std::size_t i = 0; i < index.value.size(); i += 3) {
      Triangle triangle;
      for (std::size_t c = 0; c < 3; ++c) {
        if (index.value[i + c] >= position.count) {
          throw InputError(path + ": triangle " + std::to_string(i / 3) + " uses vertex " +
                           std::to_string(static_cast<long>(index.value[i + c])) + " of " +
                           std::to_string(position.count));
        }
        triangle[c] = first + static_cast<int>(index.value[i + c]);
      }
      asset.skin.triangles.push_back(triangle);
    }
  }
  asset.provenance =
      "skin and joint frames: npm package @webxr-input-profiles/assets, "
      "profiles/generic-hand/right.glb, MIT licence";
  return asset;
}

}  // namespace

hand::HandAsset read_hand_asset(const std::string& path) {
  const formats::Glb glb = formats::read_glb(path);
  try {
    return read_checked(glb, path);
  } catch (const nlohmann::json::exception& e) {
    throw InputError(path + ": not the generic hand: " + formats::json_reason(e));
  } catch (const std::out_of_range&) {
    throw InputError(path + ": not the generic hand: a node refers to a child that does not exist");
  }
}

}  // namespace palmar::records
