// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/scene_data.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/picture/assessment_pictures.h"
#include "palmar/report/picture/display_mesh.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"
#include "palmar/report/words/texts.h"

namespace palmar::report {

namespace {

constexpr int kMostProductTriangles = 60000;  // some 0.7 MB in the page

void append_16(std::string& bytes, std::uint32_t word) {
  bytes += static_cast<char>(word & 0xffU);
  bytes += static_cast<char>(word >> 8 & 0xffU);
}

// Share of [0, 1] as a 16 bit number.
std::uint32_t share_16(double share) {
  return static_cast<std::uint32_t>(std::lround(65535.0 * std::clamp(share, 0.0, 1.0)));
}

// {"low": corner of the box, "size": its sides, "data": positions as shares of the sides}
std::string positions(const geometry::TriangleMesh& mesh) {
  Box3 box;
  for (const Vec3& v : mesh.vertices) box.extend(v);
  const Vec3 low = box.isEmpty() ? Vec3(Vec3::Zero()) : Vec3(box.min());
  const Vec3 size = (box.isEmpty() ? Vec3(Vec3::Ones()) : Vec3(box.sizes())).cwiseMax(1e-9);
  std::string bytes;
  bytes.reserve(6 * mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    for (int k = 0; k < 3; ++k) append_16(bytes, share_16((v[k] - low[k]) / size[k]));
  }
  return "{\"low\":" + json_triple(low) + ",\"size\":" + json_triple(size) + ",\"data\":\"" +
         formats::base64(bytes) + "\"}";
}

// uint16 where that is enough for the number of vertices, else uint32; the viewer decides alike.
std::string indices(const geometry::TriangleMesh& mesh) {
  const bool is_short = mesh.vertices.size() <= 65536;
  std::string bytes;
  bytes.reserve((is_short ? 6 : 12) * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    for (const int v : t) {
      append_16(bytes, static_cast<std::uint32_t>(v) & 0xffffU);
      if (!is_short) append_16(bytes, static_cast<std::uint32_t>(v) >> 16);
    }
  }
  return formats::base64(bytes);
}

// Pressures as shares of the scale's upper end: what is above has the colour of the end anyway.
std::string mesh_object(const geometry::TriangleMesh& mesh, const std::vector<double>& pressure,
                        double upper) {
  std::string shares;
  shares.reserve(2 * pressure.size());
  for (const double p : pressure) append_16(shares, share_16(p / upper));
  return "{\"position\":" + positions(mesh) + ",\"index\":\"" + indices(mesh) + "\",\"share\":\"" +
         formats::base64(shares) + "\"}";
}

std::string quoted_list(const std::vector<std::string>& words) {
  return page_text(PageJson(words));
}

// {"names": of regions, "ofVertex": uint8 per vertex of the skin}
std::string regions(const hand::Hand& hand, Language language) {
  const Texts texts(language);
  std::vector<std::string> names;
  for (int r = 0; r < hand::kRegionCount; ++r) {
    names.push_back(texts("region." + std::string(name_of(static_cast<hand::Region>(r)))));
  }
  std::string bytes;
  for (const hand::Region region : hand.region) bytes += static_cast<char>(region);
  return "{\"names\":" + quoted_list(names) + ",\"ofVertex\":\"" + formats::base64(bytes) + "\"}";
}

// {"names": of faces, "ofTriangle": uint16 per triangle of the mesh that is shown}, or null.
std::string faces(const product::Product& product, const contact::ProductFootprint& footprint,
                  const geometry::TriangleMesh& shown, Language language) {
  const bool is_whole = shown.triangles.size() == footprint.parent.size();
  if (product.faces == nullptr || !is_whole) return "null";
  std::vector<std::string> names;
  const Phrases phrases(language);
  for (const product::ProductFace& face : product.faces->face)
    names.push_back(phrases(product::title_of(face)));
  std::string bytes;
  for (const int parent : footprint.parent) {
    append_16(bytes, static_cast<std::uint32_t>(product.faces->face_of_triangle[parent]));
  }
  return "{\"names\":" + quoted_list(names) + ",\"ofTriangle\":\"" + formats::base64(bytes) + "\"}";
}

}  // namespace

std::string scene_data_json(const hand::Hand& hand, const study::AssessedProduct& assessed,
                            const ColourScale& scale, Language language) {
  const study::Assessment& assessment = assessed.assessment;
  std::string table;
  for (const Rgb c : colour_table(scale.map)) {
    for (const std::uint8_t byte : {c.r, c.g, c.b}) table += static_cast<char>(byte);
  }
  const Quat& rotation = assessment.grasp.product_from_hand.rotation;
  const double radial = hand.side == hand::Side::kLeft ? -1.0 : 1.0;
  const contact::ProductFootprint footprint = footprint_of(assessed);
  const DisplayMesh product =
      display_mesh(footprint.surface, footprint.pressure, kMostProductTriangles);
  return "{\"table\":\"" + formats::base64(table) + "\",\"neutral\":" + json_triple(scale.neutral) +
         ",\"skinColour\":" + json_triple(kSkinColour) +
         ",\"productColour\":" + json_triple(kProductColour) +
         ",\"palmward\":" + json_triple(rotation * Vec3::UnitZ()) +
         ",\"distal\":" + json_triple(rotation * Vec3::UnitY()) +
         ",\"radial\":" + json_triple(rotation * (radial * Vec3::UnitX())) + ",\"skin\":" +
         mesh_object(deformed_skin(hand, assessment), skin_pressure(hand, assessment),
                     scale.upper) +
         ",\"undeformed\":" + positions(undeformed_skin(hand, assessment)) +
         ",\"product\":" + mesh_object(product.mesh, product.value, scale.upper) +
         ",\"upper\":" + exact_number(scale.upper) + ",\"regions\":" + regions(hand, language) +
         ",\"faces\":" + faces(assessed.product, footprint, product.mesh, language) + "}";
}

}  // namespace palmar::report
