// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// make: {kind, parameters: {diameter_mm: 35, ...}, step?: true, mesh?: true, chordal_error_mm?}
// -> product.step, mesh.bin, and what the solid is.
#include <string>
#include <utility>
#include <vector>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/cad/solids/solids.h"
#include "palmar/core/error.h"
#include "palmar/records/product/face_mesh_file.h"
#include "read_back.h"
#include "verbs.h"

namespace palmar::cad_worker {

Json make(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  const product::ParametricKind& kind =
      product::parametric_kind(request.at("kind").get<std::string>());
  std::vector<std::pair<std::string, double>> given;
  if (request.contains("parameters")) {
    for (const auto& [name, value] : request.at("parameters").items()) {
      given.emplace_back(name, value.get<double>());
    }
  }
  const cad::CadModel model = cad::make_kind_solid(kind, product::complete_values(kind, given));
  progress.update(0.4, "made " + kind.name);
  Json reply = {{"volume_mm3", cad::volume_of(model)},
                {"faces", model.face_count()},
                {"edges", model.edge_count()},
                {"notes", Json::array()}};
  if (request.value("step", false)) {
    cad::write_step(folder / "product.step", model);
    require_same(folder / "product.step", kind.name, cad::volume_of(model));
    progress.update(0.7, "wrote and read back " + kind.name);
  }
  if (request.value("mesh", false)) {
    cad::TessellationOptions options;
    if (request.contains("chordal_error_mm")) {
      options.chordal_error = request.at("chordal_error_mm").get<double>();
    }
    cad::Tessellation mesh = cad::tessellate(model, options, progress);
    for (const std::string& note : mesh.notes) reply["notes"].push_back(note);
    reply["chordal_error_mm"] = mesh.chordal_error;
    reply["triangles"] = mesh.mesh.triangle_count();
    records::write_face_mesh(folder / "mesh.bin", {std::move(mesh.mesh), std::move(mesh.faces)});
  }
  progress.update(1.0, "made " + kind.name);
  return reply;
}

}  // namespace palmar::cad_worker
