// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/hand/hand_file.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/formats/json_reason.h"
#include "palmar/formats/json_whole.h"
#include "palmar/formats/mesh/glb.h"
#include "palmar/records/hand/hand_scene.h"
#include "palmar/records/hand/skeleton_json.h"

namespace palmar::records {
namespace {

using PlainJson = nlohmann::json;

std::vector<double> flat(const std::vector<Vec3>& points) {
  std::vector<double> value;
  value.reserve(3 * points.size());
  for (const Vec3& p : points) value.insert(value.end(), {p.x(), p.y(), p.z()});
  return value;
}

PlainJson write_points(formats::Glb& glb, const std::vector<Vec3>& points) {
  return {{"count", points.size()}, {"buffer_view", formats::add_doubles(glb, flat(points))}};
}

PlainJson write_numbers(formats::Glb& glb, const std::vector<double>& value) {
  return {{"count", value.size()}, {"buffer_view", formats::add_doubles(glb, value)}};
}

PlainJson write_whole(formats::Glb& glb, const std::vector<int>& value) {
  return write_numbers(glb, {value.begin(), value.end()});
}

template <class Name>
std::vector<double> codes(const std::vector<Name>& names) {
  std::vector<double> value;
  value.reserve(names.size());
  for (const Name name : names) value.push_back(static_cast<double>(name));
  return value;
}

PlainJson write_mesh(formats::Glb& glb, const geometry::TriangleMesh& mesh) {
  std::vector<double> corner;
  corner.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) corner.push_back(v);
  }
  return {{"vertices_mm", write_points(glb, mesh.vertices)},
          {"corners", write_numbers(glb, corner)}};
}

/// Reads what the functions above wrote, with checks.
class GlbReader {
 public:
  GlbReader(const formats::Glb& glb, std::string path) : glb_(glb), path_(std::move(path)) {}

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(path_ + ": broken Palmar hand: " + why);
  }

  std::vector<double> numbers(const PlainJson& json) const {
    const auto count = formats::json_whole<std::size_t>(json.at("count"));
    std::vector<double> value =
        formats::read_doubles(glb_, formats::json_whole<int>(json.at("buffer_view")), count, path_);
    for (const double number : value) {
      if (!std::isfinite(number)) fail("a number is not finite");
    }
    return value;
  }

  std::vector<Vec3> points(const PlainJson& json) const {
    const auto count = formats::json_whole<std::size_t>(json.at("count"));
    if (count > glb_.buffer.size()) fail("it promises more points than the file has bytes");
    const std::vector<double> value = formats::read_doubles(
        glb_, formats::json_whole<int>(json.at("buffer_view")), 3 * count, path_);
    std::vector<Vec3> result;
    result.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      result.emplace_back(value[3 * i], value[3 * i + 1], value[3 * i + 2]);
      if (!result.back().allFinite()) fail("point " + std::to_string(i) + " is not finite");
    }
    return result;
  }

  /// Whole numbers in [0, end).
  std::vector<int> whole(const PlainJson& json, int end, const std::string& what) const {
    std::vector<int> result;
    for (const double number : numbers(json)) {
      if (number < 0 || number >= end || number != std::floor(number)) {
        fail(what + " " + std::to_string(number) + " is outside 0 to " + std::to_string(end - 1));
      }
      result.push_back(static_cast<int>(number));
    }
    return result;
  }

  template <class Name>
  std::vector<Name> names(const PlainJson& json, int count, const std::string& what) const {
    std::vector<Name> result;
    for (const int code : whole(json, count, what)) result.push_back(static_cast<Name>(code));
    return result;
  }

  geometry::TriangleMesh mesh(const PlainJson& json) const {
    geometry::TriangleMesh result;
    result.vertices = points(json.at("vertices_mm"));
    const std::vector<int> corner =
        whole(json.at("corners"), result.vertex_count(), "corner of a triangle");
    if (corner.size() % 3 != 0) fail("the corners of the triangles don't come in threes");
    for (std::size_t i = 0; i < corner.size(); i += 3) {
      result.triangles.push_back({corner[i], corner[i + 1], corner[i + 2]});
    }
    return result;
  }

  hand::JointWeights weights(const PlainJson& json, int vertex_count) const {
    hand::JointWeights result;
    const auto id = hand::joint_named(json.at("joint").get<std::string>());
    if (!id) fail("joint \"" + json.at("joint").get<std::string>() + "\" is unknown");
    result.joint = *id;
    result.vertex = whole(json.at("vertex"), vertex_count, "weighted vertex");
    result.w1 = numbers(json.at("w1"));
    result.w2 = numbers(json.at("w2"));
    if (json.contains("bulge_mm_per_rad")) result.bulge = points(json.at("bulge_mm_per_rad"));
    if (result.w1.size() != result.vertex.size() || result.w2.size() != result.vertex.size() ||
        (!result.bulge.empty() && result.bulge.size() != result.vertex.size())) {
      fail("joint \"" + std::string(name_of(*id)) +
           "\" has unequal counts of vertices and weights");
    }
    for (std::size_t k = 0; k < result.vertex.size(); ++k) {
      for (const double w : {result.w1[k], result.w2[k]}) {
        if (w < 0 || w > 1) {
          fail("joint \"" + std::string(name_of(*id)) + "\": weight " + std::to_string(w) +
               " of vertex " + std::to_string(result.vertex[k]) + "; 0 to 1 is allowed");
        }
      }
    }
    return result;
  }

 private:
  const formats::Glb& glb_;
  std::string path_;
};

PlainJson write_exact(formats::Glb& glb, const hand::Hand& hand) {
  PlainJson json;
  json["name"] = hand.name;
  json["side"] = name_of(hand.side);
  json["provenance"] = hand.provenance;
  json["skin"] = write_mesh(glb, hand.skin);
  json["segment"] = write_numbers(glb, codes(hand.segment));
  json["region"] = write_numbers(glb, codes(hand.region));
  json["skeleton"] = skeleton_to_json(hand.skeleton);
  json["weights"] = PlainJson::array();
  for (const hand::JointWeights& weights : hand.weights) {
    PlainJson entry = {{"joint", name_of(weights.joint)},
                       {"vertex", write_whole(glb, weights.vertex)},
                       {"w1", write_numbers(glb, weights.w1)},
                       {"w2", write_numbers(glb, weights.w2)}};
    if (!weights.bulge.empty()) entry["bulge_mm_per_rad"] = write_points(glb, weights.bulge);
    json["weights"].push_back(std::move(entry));
  }
  json["thumb_ball"] = {{"beta_per_mm2", hand.thumb_ball.beta},
                        {"marker_mm", write_points(glb, hand.thumb_ball.marker)},
                        {"vertex", write_whole(glb, hand.thumb_ball.vertex)},
                        {"coefficient_mm", PlainJson::array()}};
  for (const std::vector<Vec3>& coefficient : hand.thumb_ball.coefficient) {
    json["thumb_ball"]["coefficient_mm"].push_back(write_points(glb, coefficient));
  }
  json["bones"] = PlainJson::array();
  for (const hand::Bone& bone : hand.bones) {
    PlainJson entry = {{"name", bone.name},
                       {"is_thumb_metacarpal", bone.is_thumb_metacarpal},
                       {"mesh", write_mesh(glb, bone.mesh)}};
    if (bone.segment) entry["segment"] = name_of(*bone.segment);
    json["bones"].push_back(std::move(entry));
  }
  json["dimensions"] = dimensions_to_json(hand.dimensions);
  json["tissue"] = tissue_to_json(hand.tissue);
  return json;
}

hand::Hand read_exact(const GlbReader& reader, const PlainJson& json) {
  hand::Hand hand;
  hand.name = json.at("name").get<std::string>();
  const auto side = json.at("side").get<std::string>();
  if (side != name_of(hand::Side::kRight) && side != name_of(hand::Side::kLeft)) {
    reader.fail("side \"" + side + "\"; right or left is allowed");
  }
  hand.side = side == name_of(hand::Side::kRight) ? hand::Side::kRight : hand::Side::kLeft;
  hand.provenance = json.at("provenance").get<std::string>();
  hand.skin = reader.mesh(json.at("skin"));
  hand.segment = reader.names<hand::Segment>(json.at("segment"), hand::kSegmentCount, "segment");
  hand.region = reader.names<hand::Region>(json.at("region"), hand::kRegionCount, "region");
  if (hand.segment.size() != hand.skin.vertices.size() ||
      hand.region.size() != hand.skin.vertices.size()) {
    reader.fail("segments and regions don't match the " + std::to_string(hand.skin.vertex_count()) +
                " vertices of the skin");
  }
  hand.skeleton = skeleton_from_json(json.at("skeleton"));
  for (const PlainJson& entry : json.at("weights")) {
    hand.weights.push_back(reader.weights(entry, hand.skin.vertex_count()));
  }
  const PlainJson& ball = json.at("thumb_ball");
  hand.thumb_ball.beta = ball.at("beta_per_mm2").get<double>();
  hand.thumb_ball.marker = reader.points(ball.at("marker_mm"));
  hand.thumb_ball.vertex =
      reader.whole(ball.at("vertex"), hand.skin.vertex_count(), "thumb-ball vertex");
  for (std::size_t k = 0; k < 4; ++k) {
    hand.thumb_ball.coefficient[k] = reader.points(ball.at("coefficient_mm").at(k));
    if (hand.thumb_ball.coefficient[k].size() != hand.thumb_ball.marker.size()) {
      reader.fail("the thumb ball's coefficients don't match its markers");
    }
  }
  for (const PlainJson& entry : json.at("bones")) {
    hand::Bone bone;
    bone.name = entry.at("name").get<std::string>();
    bone.is_thumb_metacarpal = entry.at("is_thumb_metacarpal").get<bool>();
    if (entry.contains("segment")) {
      bone.segment = hand::segment_named(entry.at("segment").get<std::string>());
      if (!bone.segment) reader.fail("bone \"" + bone.name + "\" is in an unknown segment");
    }
    bone.mesh = reader.mesh(entry.at("mesh"));
    hand.bones.push_back(std::move(bone));
  }
  hand.dimensions = dimensions_from_json(json.at("dimensions"));
  hand.tissue = tissue_from_json(json.at("tissue"));
  return hand;
}

PlainJson creases_to_json(const hand::DrawnCreases& creases) {
  PlainJson json = PlainJson::object();
  for (const auto& [segment, plane] : creases) {
    const Vec3 &p = plane.point, &n = plane.normal;
    json[std::string(name_of(segment))] = {{"point_mm", {p.x(), p.y(), p.z()}},
                                           {"normal", {n.x(), n.y(), n.z()}}};
  }
  return json;
}

hand::DrawnCreases creases_from_json(const GlbReader& reader, const PlainJson& json) {
  hand::DrawnCreases creases;
  const auto vector = [&](const PlainJson& numbers) {
    const Vec3 v(numbers.at(0).get<double>(), numbers.at(1).get<double>(),
                 numbers.at(2).get<double>());
    if (!v.allFinite()) reader.fail("a drawn crease is not finite");
    return v;
  };
  for (const auto& [name, entry] : json.items()) {
    const auto segment = hand::segment_named(name);
    if (!segment) reader.fail("drawn crease of an unknown segment \"" + name + "\"");
    hand::CreasePlane& plane = creases[*segment];
    plane = {vector(entry.at("point_mm")), vector(entry.at("normal"))};
    if (!(std::abs(plane.normal.norm() - 1.0) < 1e-6)) {
      reader.fail("drawn crease of \"" + name + "\": its normal is no unit vector");
    }
  }
  return creases;
}

formats::Glb make_glb(const hand::Hand& hand, const hand::DrawnCreases& creases = {}) {
  formats::Glb glb = make_hand_scene(hand);
  glb.json["extras"]["palmar_hand_version"] = kHandFileVersion;
  PlainJson exact = write_exact(glb, hand);
  if (!creases.empty()) exact["drawn_creases"] = creases_to_json(creases);
  glb.json["extras"]["palmar_hand"] = std::move(exact);
  return glb;
}

/// What `read` makes of the hand's own data in a file; throws as read_hand().
template <class Read>
auto read_extras(const formats::Glb& glb, const std::string& path, const Read& read) {
  const auto extras = glb.json.find("extras");
  if (extras == glb.json.end() || !extras->is_object() ||
      !extras->contains("palmar_hand_version") ||
      !(*extras)["palmar_hand_version"].is_number_integer()) {
    throw InputError(path +
                     ": a glTF file, but no Palmar hand (no palmar_hand_version in its extras); "
                     "`palmar hand template` makes one");
  }
  const auto version = formats::json_whole<std::int64_t>((*extras)["palmar_hand_version"]);
  if (version < 1 || version > kHandFileVersion) {
    throw InputError(path + ": hand file of version " + std::to_string(version) +
                     "; this program reads up to version " + std::to_string(kHandFileVersion) +
                     (version > kHandFileVersion ? " (a newer Palmar wrote it)" : ""));
  }
  const GlbReader reader(glb, path);
  try {
    return read(reader, extras->at("palmar_hand"));
  } catch (const PlainJson::exception& e) {
    reader.fail(formats::json_reason(e));
  } catch (const InputError& e) {
    if (std::string(e.what()).rfind(path, 0) == 0) throw;
    reader.fail(e.what());
  }
}

hand::Hand hand_of(const formats::Glb& glb, const std::string& path) {
  return read_extras(glb, path, read_exact);
}

}  // namespace

void write_hand(const std::string& path, const hand::Hand& hand,
                const hand::DrawnCreases& creases) {
  formats::write_glb(make_glb(hand, creases), path);
}

hand::DrawnCreases read_drawn_creases(const std::string& path) {
  return read_extras(
      formats::read_glb(path), path, [](const GlbReader& reader, const PlainJson& json) {
        const auto drawn = json.find("drawn_creases");
        return drawn == json.end() ? hand::DrawnCreases() : creases_from_json(reader, *drawn);
      });
}

hand::Hand read_hand(const std::string& path) { return hand_of(formats::read_glb(path), path); }

std::string format_hand(const hand::Hand& hand) {
  const std::vector<std::uint8_t> bytes = formats::format_glb(make_glb(hand));
  return {bytes.begin(), bytes.end()};
}

hand::Hand parse_hand(const std::string& bytes, const std::string& name) {
  return hand_of(formats::parse_glb({bytes.begin(), bytes.end()}, name), name);
}

}  // namespace palmar::records
