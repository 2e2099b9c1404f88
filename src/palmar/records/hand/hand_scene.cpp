// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/hand_scene.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

constexpr double kMPerMm = 0.001;
// Node 0 is the palm, node 1 + j belongs to joint j (that of the wrist carries the forearm).
constexpr int kPalmNode = 0;
constexpr int kNodeCount = 1 + hand::kJointCount;

int node_of(hand::JointId joint) { return 1 + static_cast<int>(joint); }

/// The next more proximal joint of the same ray; none for wrist, CMC and MCP.
std::optional<hand::JointId> parent_of(hand::JointId joint) {
  const int j = static_cast<int>(joint);
  if (joint == hand::JointId::kThumbMp || joint == hand::JointId::kThumbIp)
    return static_cast<hand::JointId>(j - 1);
  const int first = static_cast<int>(hand::JointId::kIndexMcp);
  if (j >= first && (j - first) % 3 != 0) return static_cast<hand::JointId>(j - 1);
  return std::nullopt;
}

PlainJson scene_json(const Vec3& metres) { return {metres.x(), metres.y(), metres.z()}; }

std::vector<float> metres(const std::vector<Vec3>& points, const Vec3& origin = Vec3::Zero()) {
  std::vector<float> value;
  value.reserve(3 * points.size());
  for (const Vec3& p : points) {
    for (int c = 0; c < 3; ++c) value.push_back(static_cast<float>(kMPerMm * (p[c] - origin[c])));
  }
  return value;
}

std::vector<float> smooth_normals(const geometry::TriangleMesh& mesh) {
  std::vector<Vec3> normal(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const Vec3& b = mesh.vertices[t[1]];
    const Vec3& c = mesh.vertices[t[2]];
    for (const int v : t) normal[v] += (b - a).cross(c - a);
  }
  std::vector<float> value;
  value.reserve(3 * normal.size());
  for (const Vec3& n : normal) {
    const Vec3 unit = n.norm() > 0 ? Vec3(n.normalized()) : Vec3::UnitZ();
    for (int c = 0; c < 3; ++c) value.push_back(static_cast<float>(unit[c]));
  }
  return value;
}

std::vector<std::uint32_t> corners(const geometry::TriangleMesh& mesh) {
  std::vector<std::uint32_t> value;
  value.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) value.push_back(static_cast<std::uint32_t>(v));
  }
  return value;
}

template <class Name>
std::vector<float> float_codes(const std::vector<Name>& names) {
  std::vector<float> value;
  value.reserve(names.size());
  for (const Name name : names) value.push_back(static_cast<float>(name));
  return value;
}

struct BlendWeights {
  std::vector<std::uint8_t> joint;  ///< 4 per vertex
  std::vector<float> weight;        ///< 4 per vertex
};

BlendWeights blend_weights(const hand::Hand& hand) {
  const auto n = static_cast<std::size_t>(hand.skin.vertex_count());
  std::vector<std::array<double, kNodeCount>> share(n, std::array<double, kNodeCount>{});
  for (const hand::JointWeights& weights : hand.weights) {
    const std::optional<hand::JointId> parent = parent_of(weights.joint);
    const auto node = node_of(weights.joint);
    const auto parent_node = parent ? node_of(*parent) : kPalmNode;
    for (std::size_t k = 0; k < weights.vertex.size(); ++k) {
      const int v = weights.vertex[k];
      const double p = weights.w1[k] * weights.w2[k];
      share[v][node] += p;
      share[v][parent_node] -= p;
    }
  }
  BlendWeights blend;
  for (std::array<double, kNodeCount>& row : share) {
    row[kPalmNode] += 1.0;
    std::array<std::pair<double, int>, kNodeCount> sorted;
    for (int i = 0; i < kNodeCount; ++i) {
      sorted[i] = {-std::max(row[i], 0.0), i};
    }
    std::sort(sorted.begin(), sorted.end());
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) sum -= sorted[k].first;
    for (std::size_t k = 0; k < 4; ++k) {
      const double weight = sum > 0 ? -sorted[k].first / sum : (k == 0 ? 1.0 : 0.0);
      blend.joint.push_back(static_cast<std::uint8_t>(weight > 0 ? sorted[k].second : 0));
      blend.weight.push_back(static_cast<float>(weight));
    }
  }
  return blend;
}

void add_joint_nodes(formats::Glb& glb, const hand::Hand& hand) {
  PlainJson& nodes = glb.json["nodes"];
  nodes.push_back({{"name", "palm"}, {"children", PlainJson::array()}});
  std::vector<float> inverse_bind;
  const auto add_inverse = [&](const Vec3& centre) {
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 4; ++r) inverse_bind.push_back(r == c ? 1.0F : 0.0F);
    }
    for (int r = 0; r < 3; ++r) inverse_bind.push_back(static_cast<float>(-kMPerMm * centre[r]));
    inverse_bind.push_back(1.0F);
  };
  add_inverse(Vec3::Zero());
  for (const hand::Joint& joint : hand.skeleton.joints) {
    const std::optional<hand::JointId> parent = parent_of(joint.id);
    const Vec3 origin = parent ? hand.skeleton.joint(*parent).centre : Vec3::Zero();
    nodes.push_back({{"name", name_of(joint.id)},
                     {"translation", scene_json(kMPerMm * (joint.centre - origin))}});
    nodes[parent ? node_of(*parent) : kPalmNode]["children"].push_back(node_of(joint.id));
    add_inverse(joint.centre);
  }
  PlainJson joints = PlainJson::array();
  for (int i = 0; i < kNodeCount; ++i) joints.push_back(i);
  const int matrices = formats::add_floats(glb, inverse_bind, 16);
  glb.json["skins"] = PlainJson::array();
  glb.json["skins"].push_back({{"name", "hand"},
                               {"joints", joints},
                               {"skeleton", kPalmNode},
                               {"inverseBindMatrices", matrices}});
}

void add_skin(formats::Glb& glb, const hand::Hand& hand) {
  const BlendWeights blend = blend_weights(hand);
  PlainJson attributes;
  attributes["POSITION"] = formats::add_floats(glb, metres(hand.skin.vertices), 3, true);
  attributes["NORMAL"] = formats::add_floats(glb, smooth_normals(hand.skin), 3);
  attributes["JOINTS_0"] = formats::add_bytes(glb, blend.joint, 4);
  attributes["WEIGHTS_0"] = formats::add_floats(glb, blend.weight, 4);
  if (hand.segment.size() == hand.skin.vertices.size()) {
    attributes["_SEGMENT"] = formats::add_floats(glb, float_codes(hand.segment), 1);
  }
  if (hand.region.size() == hand.skin.vertices.size()) {
    attributes["_REGION"] = formats::add_floats(glb, float_codes(hand.region), 1);
  }
  const int indices = formats::add_indices(glb, corners(hand.skin));
  PlainJson primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 0}};
  glb.json["meshes"].push_back({{"name", "skin"}, {"primitives", PlainJson::array({primitive})}});
  const int node = static_cast<int>(glb.json["nodes"].size());
  glb.json["nodes"].push_back(
      {{"name", "skin"}, {"mesh", static_cast<int>(glb.json["meshes"].size()) - 1}, {"skin", 0}});
  glb.json["scenes"][0]["nodes"].push_back(node);
}

void add_bones(formats::Glb& glb, const hand::Hand& hand) {
  for (const hand::Bone& bone : hand.bones) {
    if (bone.mesh.triangles.empty()) continue;
    int parent = node_of(hand::JointId::kWrist);  // radius and ulna
    Vec3 origin = hand.skeleton.joint(hand::JointId::kWrist).centre;
    if (bone.is_thumb_metacarpal) {
      parent = node_of(hand::JointId::kThumbCmc);
      origin = hand.skeleton.joint(hand::JointId::kThumbCmc).centre;
    } else if (bone.segment == hand::Segment::kPalm) {
      parent = kPalmNode;
      origin = Vec3::Zero();
    } else if (bone.segment) {
      parent = node_of(hand::joint_of(*bone.segment));
      origin = hand.skeleton.joint(hand::joint_of(*bone.segment)).centre;
    }
    PlainJson attributes;
    attributes["POSITION"] = formats::add_floats(glb, metres(bone.mesh.vertices, origin), 3, true);
    attributes["NORMAL"] = formats::add_floats(glb, smooth_normals(bone.mesh), 3);
    const int indices = formats::add_indices(glb, corners(bone.mesh));
    PlainJson primitive = {{"attributes", attributes}, {"indices", indices}, {"material", 1}};
    glb.json["meshes"].push_back(
        {{"name", bone.name}, {"primitives", PlainJson::array({primitive})}});
    const int node = static_cast<int>(glb.json["nodes"].size());
    glb.json["nodes"].push_back(
        {{"name", bone.name}, {"mesh", static_cast<int>(glb.json["meshes"].size()) - 1}});
    glb.json["nodes"][parent]["children"].push_back(node);
  }
}

PlainJson material(const char* name, double r, double g, double b, double roughness) {
  return {{"name", name},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {r, g, b, 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", roughness}}}};
}

}  // namespace

formats::Glb make_hand_scene(const hand::Hand& hand) {
  formats::Glb glb;
  glb.json["asset"] = {{"version", "2.0"}, {"generator", "Palmar"}, {"copyright", hand.provenance}};
  glb.json["scene"] = 0;
  glb.json["scenes"] = PlainJson::array({{{"name", hand.name}, {"nodes", {kPalmNode}}}});
  glb.json["nodes"] = PlainJson::array();
  glb.json["meshes"] = PlainJson::array();
  glb.json["materials"] = PlainJson::array(
      {material("skin", 0.73, 0.48, 0.35, 0.7), material("bone", 0.85, 0.82, 0.72, 0.6)});
  add_joint_nodes(glb, hand);
  add_skin(glb, hand);
  add_bones(glb, hand);
  return glb;
}

}  // namespace palmar::records
