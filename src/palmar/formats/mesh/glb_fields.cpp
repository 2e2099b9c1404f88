// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/mesh/glb_fields.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/mesh/glb.h"

namespace palmar::formats {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;

/// glTF vertex colours are linear light (Khronos glTF 2.0, section 3.7.2.1); IEC 61966-2-1.
float linear(std::uint8_t value) {
  const double s = value / 255.0;
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

std::string attribute_name(const std::string& field) {
  std::string name = "_";
  for (const char c : field) {
    name += std::isalnum(static_cast<unsigned char>(c)) != 0
                ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                : '_';
  }
  return name;
}

std::vector<float> smooth_normals(const geometry::TriangleMesh& mesh) {
  std::vector<Vec3> sum(mesh.vertices.size(), Vec3::Zero());
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[static_cast<std::size_t>(t[0])];
    const Vec3& b = mesh.vertices[static_cast<std::size_t>(t[1])];
    const Vec3& c = mesh.vertices[static_cast<std::size_t>(t[2])];
    const Vec3 n = (b - a).cross(c - a);
    for (const int v : t) sum[static_cast<std::size_t>(v)] += n;
  }
  std::vector<float> normals;
  normals.reserve(3 * sum.size());
  for (const Vec3& s : sum) {
    const double length = s.norm();
    const Vec3 n = length > 0.0 ? Vec3(s / length) : Vec3::UnitZ();
    for (int c = 0; c < 3; ++c) normals.push_back(static_cast<float>(n[c]));
  }
  return normals;
}

void check_fit(const FieldMesh& one) {
  const std::size_t n = one.mesh.vertices.size();
  if (one.colour.size() > 1 && one.colour.size() != n) {
    throw Error("mesh \"" + one.name + "\": " + std::to_string(one.colour.size()) +
                " colours; none, one or one for each of " + std::to_string(n) +
                " vertices is required");
  }
  for (const PointField& field : one.field) {
    if (field.components != 1 || field.value.size() != n) {
      throw Error("mesh \"" + one.name + "\": field \"" + field.name + "\" has " +
                  std::to_string(field.value.size()) + " numbers; one for each of " +
                  std::to_string(n) + " vertices is required");
    }
  }
}

nlohmann::json primitive(Glb& glb, const FieldMesh& one) {
  std::vector<float> positions;
  positions.reserve(3 * one.mesh.vertices.size());
  for (const Vec3& v : one.mesh.vertices) {
    for (int c = 0; c < 3; ++c) {
      positions.push_back(static_cast<float>(v[c] * kMetresPerMillimetre));
    }
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * one.mesh.triangles.size());
  for (const Triangle& t : one.mesh.triangles) {
    for (const int v : t) indices.push_back(static_cast<std::uint32_t>(v));
  }
  nlohmann::json attributes;
  attributes["POSITION"] = add_floats(glb, positions, 3, true);
  attributes["NORMAL"] = add_floats(glb, smooth_normals(one.mesh), 3);
  if (one.colour.size() > 1 || (one.colour.size() == 1 && one.mesh.vertices.size() == 1)) {
    std::vector<float> colours;
    colours.reserve(3 * one.colour.size());
    for (const VertexColour& rgb : one.colour) {
      for (const std::uint8_t value : rgb) colours.push_back(linear(value));
    }
    attributes["COLOR_0"] = add_floats(glb, colours, 3);
  }
  for (const PointField& field : one.field) {
    attributes[attribute_name(field.name)] =
        add_floats(glb, std::vector<float>(field.value.begin(), field.value.end()), 1, true);
  }
  return {
      {"attributes", std::move(attributes)}, {"indices", add_indices(glb, indices)}, {"mode", 4}};
}

/// Vertex colours multiply the base colour, so that is white where there are any.
nlohmann::json material(const FieldMesh& one) {
  std::array<float, 4> base = {1.0f, 1.0f, 1.0f, 1.0f};
  if (one.colour.empty()) base = {0.6f, 0.6f, 0.6f, 1.0f};
  if (one.colour.size() == 1) {
    for (std::size_t c = 0; c < 3; ++c) base[c] = linear(one.colour[0][c]);
  }
  return {{"name", one.name},
          {"doubleSided", true},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", base}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
}

}  // namespace

std::string format_glb_fields(const std::vector<FieldMesh>& meshes) {
  Glb glb;
  glb.json = {{"asset", {{"version", "2.0"}, {"generator", "Palmar " + version()}}},
              {"scene", 0},
              {"scenes", nlohmann::json::array({{{"nodes", nlohmann::json::array()}}})}};
  for (const FieldMesh& one : meshes) {
    check_fit(one);
    if (one.mesh.triangles.empty()) continue;  // glTF allows no empty accessor
    nlohmann::json part = primitive(glb, one);
    nlohmann::json& json = glb.json;
    json["materials"].push_back(material(one));
    part["material"] = json["materials"].size() - 1;
    json["meshes"].push_back(
        {{"name", one.name}, {"primitives", nlohmann::json::array({std::move(part)})}});
    json["nodes"].push_back({{"name", one.name}, {"mesh", json["meshes"].size() - 1}});
    json["scenes"][0]["nodes"].push_back(json["nodes"].size() - 1);
  }
  const std::vector<std::uint8_t> bytes = format_glb(glb);
  return {bytes.begin(), bytes.end()};
}

}  // namespace palmar::formats
