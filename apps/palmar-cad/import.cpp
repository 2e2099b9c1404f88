// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// import: {file, millimetres_per_unit?, chordal_error_mm?, angle_deg?, max_triangles?} -> mesh.bin
// and what the file held.
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/records/product/face_mesh_file.h"
#include "read_request.h"
#include "verbs.h"

namespace palmar::cad_worker {
namespace {

/// The parent judges the size with care; this one keeps triangles from being made of what is no
/// product in any unit.
void check_size(const cad::CadFile& file, const std::string& object) {
  constexpr double kLargest = 20'000.0;  // mm
  const Box3 box = cad::box_of(file.model);
  const double size = box.isEmpty() ? 0.0 : box.sizes().maxCoeff();
  if (size <= kLargest) return;
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", size);
  throw InputError(object + ": its longest side is " + text + " mm (unit " +
                   (file.unit.empty() ? "not stated" : file.unit) +
                   "); up to 10000 mm is allowed. If the unit is wrong, give it by setting "
                   "\"unit\": mm, cm, m or inch");
}

/// Geometry with numbers that are none gives triangles that are none.
void check_numbers(const cad::Tessellation& mesh, const std::string& object) {
  for (const product::ProductFace& face : mesh.faces.face) {
    if (std::isfinite(face.area) && std::isfinite(face.radius)) continue;
    throw InputError(object + ": the size of face " + std::to_string(face.number) +
                     " is no finite number; the file is damaged");
  }
  for (int t = 0; t < mesh.mesh.triangle_count(); ++t) {
    for (const int v : mesh.mesh.triangles[t]) {
      if (mesh.mesh.vertices[v].allFinite()) continue;
      throw InputError(object + ": face " +
                       std::to_string(mesh.faces.face[mesh.faces.face_of_triangle[t]].number) +
                       " has a point that is no finite number; the file is damaged");
    }
  }
}

}  // namespace

Json import(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  cad::TessellationOptions options;
  if (request.contains("chordal_error_mm")) {
    options.chordal_error = request.at("chordal_error_mm").get<double>();
  }
  if (request.contains("angle_deg")) {
    options.angle = request.at("angle_deg").get<double>() * std::numbers::pi / 180.0;
  }
  options.max_triangles = request.value("max_triangles", options.max_triangles);
  options.check();

  const std::string object = request.at("file").get<std::string>();
  const cad::CadFile file = read_request(request, part_of(progress, 0.0, 0.5));
  cad::Tessellation mesh = on_file(object, [&] {
    check_size(file, object);
    const std::string crossing = cad::self_crossing(file.model);
    if (!crossing.empty()) throw InputError(object + ": " + crossing);
    try {
      return cad::tessellate(file.model, options, part_of(progress, 0.5, 0.95));
    } catch (const InputError& error) {
      throw InputError(object + ": " + error.what());
    }
  });
  check_numbers(mesh, object);
  Json notes = file.notes;
  for (const std::string& note : mesh.notes) notes.push_back(note);
  Json bodies = Json::array();
  for (const auto& name : cad::body_names(file.model)) bodies.push_back(name);
  const Json reply = {{"format", file.format},
                      {"unit", file.unit},
                      {"millimetres_per_unit", file.millimetres_per_unit},
                      {"bodies", std::move(bodies)},
                      {"solids", file.solids},
                      {"open_shells", file.open_shells},
                      {"faces", file.model.face_count()},
                      {"edges", file.model.edge_count()},
                      {"chordal_error_mm", mesh.chordal_error},
                      {"chordal_reason", mesh.chordal_reason},
                      {"triangles", mesh.mesh.triangle_count()},
                      {"volume_mm3", cad::volume_of(file.model)},
                      {"notes", std::move(notes)}};
  records::write_face_mesh(folder / "mesh.bin", {std::move(mesh.mesh), std::move(mesh.faces)});
  progress.update(1.0, "imported");
  return reply;
}

}  // namespace palmar::cad_worker
