// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "product/product_cad_text.h"

#include <fmt/format.h>

#include <cmath>

#include "text.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::size_t kMostFaces = 100;  // lines of text; JSON has all

/// "#3366cc"
std::string hex_of(const std::array<float, 3>& colour) {
  const auto byte = [](float share) { return static_cast<int>(std::lround(255.0F * share)); };
  return fmt::format("#{:02x}{:02x}{:02x}", byte(colour[0]), byte(colour[1]), byte(colour[2]));
}

}  // namespace

std::string cad_text(const records::ImportedCad& cad, const std::string& stated_unit) {
  const std::string in_file = cad.unit.empty() ? "not stated" : cad.unit;
  const std::string unit = stated_unit.empty()
                               ? fmt::format("{} ({:.6g} mm)", in_file, cad.millimetres_per_unit)
                               : fmt::format("{} as given (file: {})", stated_unit, in_file);
  std::string text = fmt::format(
      "{}, unit {}: {} bod{}, {} solid{}, {} faces, {} edges, volume {}\n"
      "chordal error {:.4g} mm: {}\n",
      cad.format, unit, cad.bodies.size(), cad.bodies.size() == 1 ? "y" : "ies", cad.solids,
      cad.solids == 1 ? "" : "s", cad.mesh.faces.face.size(), cad.mesh.faces.edge.size(),
      volume_text(cad.volume, 1), cad.chordal_error, cad.chordal_reason);
  for (const std::string& name : cad.bodies) text += "body     " + name + "\n";
  std::size_t lines = 0;
  for (const product::ProductFace& face : cad.mesh.faces.face) {
    if (lines++ == kMostFaces) {
      text += fmt::format("         and {} more faces (--json has all)\n",
                          cad.mesh.faces.face.size() - kMostFaces);
      break;
    }
    text += fmt::format("{:<40} {:10.2f} mm2{}{}\n", product::title_of(face), face.area,
                        face.colour ? " " + hex_of(*face.colour) : "",
                        cad.bodies.size() > 1 ? " of " + face.part : "");
  }
  lines = 0;
  for (const product::ProductEdge& edge : cad.mesh.faces.edge) {
    if (edge.is_smooth || edge.faces[0] < 0 || edge.faces[1] < 0) continue;
    if (lines++ == kMostFaces) return text + "         and more sharp edges (--json has all)\n";
    text += fmt::format("edge {} between faces {} and {}: {}, {:.0f} deg, {:.1f} mm\n", edge.number,
                        edge.faces[0] + 1, edge.faces[1] + 1, edge.is_convex ? "convex" : "concave",
                        degrees(edge.angle), edge.length);
  }
  return text;
}

Json cad_json(const records::ImportedCad& cad) {
  Json faces = Json::array();
  for (const product::ProductFace& face : cad.mesh.faces.face) {
    Json one = {{"number", face.number},
                {"title", product::title_of(face)},
                {"name", face.name},
                {"part", face.part},
                {"kind", name_of(face.kind)},
                {"radius_mm", face.radius},
                {"is_concave", face.is_concave},
                {"is_fillet", face.is_fillet},
                {"area_mm2", face.area}};
    if (face.colour) one["colour"] = hex_of(*face.colour);
    faces.push_back(std::move(one));
  }
  Json edges = Json::array();
  for (const product::ProductEdge& edge : cad.mesh.faces.edge) {
    Json met = Json::array();
    for (const int face : edge.faces) {
      if (face >= 0) met.push_back(face + 1);
    }
    edges.push_back({{"number", edge.number},
                     {"faces", std::move(met)},
                     {"is_convex", edge.is_convex},
                     {"is_smooth", edge.is_smooth},
                     {"angle_deg", degrees(edge.angle)},
                     {"length_mm", edge.length}});
  }
  return {{"format", cad.format},
          {"unit", cad.unit},
          {"millimetres_per_unit", cad.millimetres_per_unit},
          {"bodies", cad.bodies},
          {"solids", cad.solids},
          {"open_shells", cad.open_shells},
          {"chordal_error_mm", cad.chordal_error},
          {"chordal_reason", cad.chordal_reason},
          {"exact_volume_mm3", cad.volume},
          {"faces", std::move(faces)},
          {"edges", std::move(edges)}};
}

std::string verdict_text(const records::CadVerdict& verdict) {
  std::string text =
      fmt::format("CAD kernel: {}, {}, {} solid{}, volume {}\n",
                  verdict.is_valid ? "valid" : "not valid", verdict.is_closed ? "closed" : "open",
                  verdict.solids, verdict.solids == 1 ? "" : "s", volume_text(verdict.volume, 1));
  for (const std::string& finding : verdict.findings) text += "CAD      " + finding + "\n";
  return text;
}

Json verdict_json(const records::CadVerdict& verdict) {
  return {{"is_good", verdict.is_good()},     {"is_valid", verdict.is_valid},
          {"is_closed", verdict.is_closed},   {"solids", verdict.solids},
          {"free_edges", verdict.free_edges}, {"exact_volume_mm3", verdict.volume},
          {"exact_area_mm2", verdict.area},   {"findings", verdict.findings}};
}

}  // namespace palmar::cli
