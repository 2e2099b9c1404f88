// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// region: {file?, millimetres_per_unit?, curves: [{name, colour, points_mm}], surfaces: [{name,
// colour, kind, point_mm, axis, radius_mm, tube_radius_mm, half_angle_deg, points_mm, outline_mm}],
// reliefs?: [...], junction_radius_mm?, chordal_error_mm?} -> region.step; with reliefs also
// redesign.step and its mesh, mesh.bin; and how near curves and surfaces came.
#include <numbers>

#include "palmar/cad/edits/region_model.h"
#include "palmar/cad/edits/relief_cut.h"
#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/core/error.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/region_json.h"
#include "verbs.h"

namespace palmar::cad_worker {
namespace {

Json verdict(const cad::CadModel& model) {
  const cad::CadCheck check = cad::check_cad(model);
  return {{"is_valid", check.is_valid}, {"is_closed", check.is_closed},
          {"solids", check.solids},     {"faces", check.faces},
          {"volume_mm3", check.volume}, {"findings", check.findings}};
}

/// The file as it was written, read again.
Json read_back(const std::filesystem::path& path) { return verdict(cad::read_step(path).model); }

}  // namespace

Json region(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  cad::CadModel product;
  Json reply;
  if (request.contains("file")) {
    cad::ReadCadOptions read;
    if (request.contains("millimetres_per_unit")) {
      read.millimetres_per_unit = request.at("millimetres_per_unit").get<double>();
    }
    product = cad::read_cad(request.at("file").get<std::string>(), read).model;
    reply["product"] = verdict(product);
  }
  progress.update(0.2, "product read");
  const cad::RegionModel region = cad::make_region_model(product, records::region_curves(request),
                                                         records::region_surfaces(request));
  cad::write_step(folder / "region.step", region.model);
  reply["region"] = product.is_empty() ? Json() : read_back(folder / "region.step");
  reply["curves"] = Json::array();
  for (const cad::CurveReport& one : region.curves) {
    reply["curves"].push_back({{"poles", one.poles},
                               {"length_mm", one.length},
                               {"deviation_mm", one.deviation},
                               {"is_closed", one.is_closed}});
  }
  reply["surfaces"] = Json::array();
  for (const cad::SurfaceReport& one : region.surfaces) {
    reply["surfaces"].push_back({{"ends_at_outline", one.ends_at_outline}, {"area_mm2", one.area}});
  }
  progress.update(0.5, "region written");
  const std::vector<redesign::RidgeRelief> reliefs = records::region_reliefs(request);
  if (reliefs.empty()) return reply;
  const cad::RelievedModel relieved =
      cad::cut_reliefs(product, reliefs, request.value("junction_radius_mm", 0.0));
  cad::write_step(folder / "redesign.step", relieved.model);
  progress.update(0.8, "redesign cut");
  cad::TessellationOptions options;
  if (request.contains("chordal_error_mm")) {
    options.chordal_error = request.at("chordal_error_mm").get<double>();
  }
  cad::Tessellation mesh = cad::tessellate(relieved.model, options);
  records::write_face_mesh(folder / "mesh.bin", {std::move(mesh.mesh), std::move(mesh.faces)});
  reply["redesign"] = {{"volume_before_mm3", relieved.volume_before},
                       {"volume_mm3", relieved.volume_after},
                       {"rounded_junctions", relieved.rounded_junctions},
                       {"notes", relieved.notes},
                       {"read_back", read_back(folder / "redesign.step")}};
  progress.update(1.0, "redesign read back");
  return reply;
}

}  // namespace palmar::cad_worker
