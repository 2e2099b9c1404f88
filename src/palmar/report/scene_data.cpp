// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scene_data.h"

#include <bit>
#include <cstdint>
#include <cstring>

#include "palmar/io/vtk.h"
#include "palmar/report/assessment_pictures.h"
#include "palmar/report/plain_words.h"

namespace palmar {

namespace {

void append_little_endian(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(word >> shift & 0xffU);
}

std::string floats(const std::vector<double>& values) {
  std::string bytes;
  bytes.reserve(4 * values.size());
  for (const double v : values) {
    append_little_endian(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(v)));
  }
  return base64(bytes);
}

std::string positions(const TriangleMesh& mesh) {
  std::vector<double> values;
  values.reserve(3 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) values.insert(values.end(), {v.x(), v.y(), v.z()});
  return floats(values);
}

std::string indices(const TriangleMesh& mesh) {
  std::string bytes;
  bytes.reserve(12 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) append_little_endian(bytes, static_cast<std::uint32_t>(v));
  }
  return base64(bytes);
}

std::string mesh_object(const TriangleMesh& mesh, const std::vector<double>& pressure) {
  return "{\"position\":\"" + positions(mesh) + "\",\"index\":\"" + indices(mesh) +
         "\",\"pressure\":\"" + floats(pressure) + "\"}";
}

std::string triple(double a, double b, double c) {
  return "[" + exact_number(a) + "," + exact_number(b) + "," + exact_number(c) + "]";
}

std::string triple(const Vec3& v) { return triple(v.x(), v.y(), v.z()); }
std::string triple(Rgb c) { return triple(c.r, c.g, c.b); }

}  // namespace

std::string scene_data_json(const Hand& hand, const AssessedProduct& assessed,
                            const ColourScale& scale) {
  const Assessment& assessment = assessed.assessment;
  std::string table;
  for (const Rgb c : colour_table(scale.map)) {
    for (const std::uint8_t byte : {c.r, c.g, c.b}) table += static_cast<char>(byte);
  }
  const Quat& rotation = assessment.grasp.product_from_hand.rotation;
  const double radial = hand.side == Side::kLeft ? -1.0 : 1.0;
  const ProductFootprint footprint = footprint_of(assessed);
  return "{\"upper\":" + exact_number(scale.upper) + ",\"table\":\"" + base64(table) +
         "\",\"neutral\":" + triple(scale.neutral) + ",\"skinColour\":" + triple(kSkinColour) +
         ",\"productColour\":" + triple(kProductColour) +
         ",\"palmward\":" + triple(rotation * Vec3::UnitZ()) +
         ",\"distal\":" + triple(rotation * Vec3::UnitY()) +
         ",\"radial\":" + triple(rotation * (radial * Vec3::UnitX())) + ",\"skin\":" +
         mesh_object(deformed_skin(hand, assessment), skin_pressure(hand, assessment)) +
         ",\"undeformed\":\"" + positions(undeformed_skin(hand, assessment)) +
         "\",\"product\":" + mesh_object(footprint.surface, footprint.pressure) + "}";
}

}  // namespace palmar
