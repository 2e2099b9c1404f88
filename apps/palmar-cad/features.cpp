// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// features: {source, reference?, edits: [...], keep_out?, step?, mesh?, change?, chordal_error_mm?,
//            describe_only?}
// -> product.step, mesh.bin, volumes and the largest change of the surface.
//
// A source is {file, millimetres_per_unit?} or {kind, parameters}. Edits:
//   {feature: "fillet", edges, radius_mm}           {feature: "offset", faces, offset_mm}
//   {feature: "taper", faces, taper_deg}
//   {feature: "groove", points_mm | ring_at_mm, is_closed?, radius_mm, depth_mm, rim_mm?}
#include <fmt/format.h>

#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "palmar/cad/edits/feature_choice.h"
#include "palmar/cad/edits/feature_edits.h"
#include "palmar/cad/edits/surface_change.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/model/tessellation.h"
#include "palmar/cad/solids/solids.h"
#include "palmar/core/error.h"
#include "palmar/records/product/face_mesh_file.h"
#include "read_back.h"
#include "source_model.h"
#include "verbs.h"

namespace palmar::cad_worker {
namespace {

cad::FeatureEdits edits_of(const Json& list) {
  cad::FeatureEdits edits;
  for (const Json& one : list) {
    const std::string feature = one.at("feature").get<std::string>();
    if (feature == "fillet") {
      edits.fillets.push_back(
          {one.at("edges").get<std::string>(), one.at("radius_mm").get<double>()});
    } else if (feature == "offset") {
      edits.offsets.push_back(
          {one.at("faces").get<std::string>(), one.at("offset_mm").get<double>()});
    } else if (feature == "taper") {
      cad::TaperEdit taper;
      taper.faces = one.value("faces", taper.faces);
      taper.angle = one.at("taper_deg").get<double>() * std::numbers::pi / 180;
      edits.tapers.push_back(taper);
    } else if (feature == "groove") {
      cad::GrooveEdit groove;
      if (one.contains("ring_at_mm")) groove.ring_at = one.at("ring_at_mm").get<double>();
      for (const Json& point : one.value("points_mm", Json::array())) {
        groove.points.push_back(
            {point.at(0).get<double>(), point.at(1).get<double>(), point.at(2).get<double>()});
      }
      groove.is_closed = one.value("is_closed", false);
      groove.radius = one.at("radius_mm").get<double>();
      groove.depth = one.at("depth_mm").get<double>();
      groove.rim = one.value("rim_mm", 0.0);
      if (groove.depth != 0.0) edits.grooves.push_back(std::move(groove));
    } else {
      throw UsageError(
          fmt::format("feature \"{}\"; allowed are fillet, offset, taper and groove", feature));
    }
  }
  return edits;
}

}  // namespace

Json features(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  Json notes = Json::array();
  const cad::CadModel source = model_of(request.at("source"), notes);
  progress.update(0.2, "read the product");
  const cad::FeatureEdits edits = edits_of(request.value("edits", Json::array()));
  Json fillets = Json::array();
  for (const cad::FilletEdit& fillet : edits.fillets) {
    const cad::EdgeChoice choice = cad::choose_edges(source, fillet.edges);
    fillets.push_back(
        {{"text", cad::words_of(choice)}, {"radius_mm", cad::mean_radius(source, choice)}});
  }
  if (request.value("describe_only", false)) {
    for (const cad::OffsetEdit& offset : edits.offsets) cad::choose_faces(source, offset.faces);
    for (const cad::TaperEdit& taper : edits.tapers) cad::choose_faces(source, taper.faces);
    const std::string keep_out = request.value("keep_out", std::string());
    if (!keep_out.empty()) cad::choose_faces(source, keep_out);
    return {{"fillets", std::move(fillets)}};
  }
  const cad::EditedModel edited = cad::edit_features(source, edits);
  for (const std::string& note : edited.notes) notes.push_back(note);
  progress.update(0.5, "changed its features");

  Json reply = {{"volume_mm3", edited.volume},
                {"fillets", std::move(fillets)},
                {"faces", edited.model.face_count()},
                {"edges", edited.model.edge_count()},
                {"solids", edited.model.solid_count()}};
  if (request.value("change", true)) {
    Json none = Json::array();
    const cad::CadModel before =
        request.contains("reference") ? model_of(request.at("reference"), none) : source;
    const std::string keep_out = request.value("keep_out", std::string());
    const cad::SurfaceChange change = cad::surface_change(
        before, edited.model,
        keep_out.empty() ? std::vector<int>() : cad::choose_faces(before, keep_out));
    reply["volume_before_mm3"] = cad::volume_of(before);
    reply["largest_change_mm"] = change.largest;
    reply["keep_out_change_mm"] = change.of_faces;
  }
  progress.update(0.7, "measured the change");
  if (request.value("step", false)) {
    cad::write_step(folder / "product.step", edited.model);
    require_same(folder / "product.step", "the changed product", edited.volume);
  }
  if (request.value("mesh", true)) {
    cad::TessellationOptions options;
    if (request.contains("chordal_error_mm")) {
      options.chordal_error = request.at("chordal_error_mm").get<double>();
    }
    cad::Tessellation mesh = cad::tessellate(edited.model, options);
    for (const std::string& note : mesh.notes) notes.push_back(note);
    reply["chordal_error_mm"] = mesh.chordal_error;
    records::write_face_mesh(folder / "mesh.bin", {std::move(mesh.mesh), std::move(mesh.faces)});
  }
  reply["notes"] = std::move(notes);
  progress.update(1.0, "made");
  return reply;
}

}  // namespace palmar::cad_worker
