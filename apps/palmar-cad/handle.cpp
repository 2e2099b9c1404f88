// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// handle: {shape: as handle_shape_json(), chordal_error_mm, source?} -> product.step, mesh.bin, and
// what the solid is. With a source, the product that goes on beyond the handle, also whole.step and
// whole.bin: the product with the new handle, or why there is none.
#include "palmar/cad/edits/replace_handle.h"
#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/cad/solids/handle_solid.h"
#include "palmar/core/error.h"
#include "palmar/records/handle_json.h"
#include "palmar/records/product/face_mesh_file.h"
#include "read_back.h"
#include "source_model.h"
#include "verbs.h"

namespace palmar::cad_worker {

Json handle(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  const redesign::HandleShape shape = records::handle_shape_from(request.at("shape"));
  const cad::CadModel model = cad::make_handle_solid(shape);
  progress.update(0.4, "made the handle");
  cad::write_step(folder / "product.step", model);
  require_same(folder / "product.step", "the handle", cad::volume_of(model));
  progress.update(0.7, "wrote and read back the handle");
  cad::TessellationOptions options;
  options.chordal_error = request.at("chordal_error_mm").get<double>();
  cad::Tessellation mesh = cad::tessellate(model, options, progress);
  Json reply = {{"volume_mm3", cad::volume_of(model)},
                {"faces", model.face_count()},
                {"poles", cad::most_poles(model)},
                {"triangles", mesh.mesh.triangle_count()}};
  records::write_face_mesh(folder / "mesh.bin", {std::move(mesh.mesh), std::move(mesh.faces)});
  if (request.contains("source")) {
    try {
      Json notes = Json::array();
      const cad::CadModel whole = cad::replace_handle(model_of(request.at("source"), notes), shape);
      cad::write_step(folder / "whole.step", whole);
      require_same(folder / "whole.step", "the product", cad::volume_of(whole));
      cad::Tessellation of_whole = cad::tessellate(whole, {}, progress);
      records::write_face_mesh(folder / "whole.bin",
                               {std::move(of_whole.mesh), std::move(of_whole.faces)});
      reply["whole"] = {{"volume_mm3", cad::volume_of(whole)}, {"faces", whole.face_count()}};
    } catch (const NumericalError& error) {
      reply["whole_failure"] = error.what();
    }
  }
  progress.update(1.0, "made the handle");
  return reply;
}

}  // namespace palmar::cad_worker
