// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_features.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/records/product/cad_format.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json source_json(const CadSource& source) {
  if (source.made) {
    Json parameters = Json::object();
    for (const auto& [name, value] : source.made->given) parameters[name] = value;
    return {{"kind", source.made->kind}, {"parameters", std::move(parameters)}};
  }
  check_cad_format(source.file);
  Json json = {{"file", fs::absolute(source.file).string()}};
  if (source.millimetres_per_unit) json["millimetres_per_unit"] = *source.millimetres_per_unit;
  return json;
}

Json feature_json(const CadFeature& feature) {
  Json json = {{"feature", feature.feature}};
  if (feature.feature == "fillet") {
    json["edges"] = feature.where;
    json["radius_mm"] = feature.value;
  } else if (feature.feature == "offset") {
    json["faces"] = feature.where;
    json["offset_mm"] = feature.value;
  } else if (feature.feature == "taper") {
    json["faces"] = feature.where;
    json["taper_deg"] = feature.value;
  } else {
    if (feature.ring_at) json["ring_at_mm"] = *feature.ring_at;
    Json points = Json::array();
    for (const Vec3& point : feature.points) points.push_back({point.x(), point.y(), point.z()});
    json["points_mm"] = std::move(points);
    json["is_closed"] = feature.is_closed;
    json["radius_mm"] = feature.section_radius;
    json["depth_mm"] = feature.value;
    json["rim_mm"] = feature.rim_radius;
  }
  return json;
}

double number(const Json& json, const char* name) {
  const double value = json.value(name, 0.0);
  return std::isfinite(value) ? value : 0.0;
}

std::string object_of(const CadFeatureRequest& request) {
  return request.source.made ? title_of(*request.source.made) : request.source.file.string();
}

Json request_json(const CadFeatureRequest& request) {
  Json features = Json::array();
  for (const CadFeature& feature : request.features) features.push_back(feature_json(feature));
  Json json = {{"source", source_json(request.source)},
               {"edits", std::move(features)},
               {"keep_out", request.keep_out},
               {"mesh", request.mesh},
               {"step", request.step}};
  if (request.reference) json["reference"] = source_json(*request.reference);
  if (request.chordal_error) json["chordal_error_mm"] = *request.chordal_error;
  return json;
}

std::vector<ChosenEdges> fillets_in(const Json& answer) {
  std::vector<ChosenEdges> fillets;
  for (const Json& fillet : answer.at("fillets")) {
    fillets.push_back({fillet.at("text").get<std::string>(), number(fillet, "radius_mm")});
  }
  return fillets;
}

}  // namespace

std::string source_text(const CadSource& source) { return source_json(source).dump(); }

ChangedCad change_features(const CadFeatureRequest& request, const CadLimits& limits,
                           const Progress& progress) {
  const std::string object = object_of(request);
  const CadFolder folder;
  const std::string reply =
      run_cad("features", request_json(request).dump(), folder, object, limits, progress);
  ChangedCad changed;
  try {
    const Json answer = Json::parse(reply);
    changed.volume = number(answer, "volume_mm3");
    changed.volume_before = number(answer, "volume_before_mm3");
    changed.largest_change = number(answer, "largest_change_mm");
    changed.keep_out_change = number(answer, "keep_out_change_mm");
    changed.chordal_error = number(answer, "chordal_error_mm");
    changed.fillets = fillets_in(answer);
    for (const Json& note : answer.at("notes")) changed.notes.push_back(note.get<std::string>());
    if (request.mesh) changed.mesh = read_face_mesh(folder.path() / "mesh.bin");
    if (request.step) changed.step = formats::read_file(folder.path() / "product.step");
  } catch (const Json::exception& error) {
    throw InputError(object +
                     ": the CAD program's answer is damaged: " + formats::json_reason(error));
  } catch (const InputError& error) {
    throw InputError(object + ": the CAD program's answer can't be used: " + error.what());
  }
  return changed;
}

std::vector<ChosenEdges> describe_features(const CadFeatureRequest& request,
                                           const CadLimits& limits, const Progress& progress) {
  const std::string object = object_of(request);
  Json json = request_json(request);
  json["describe_only"] = true;
  const CadFolder folder;
  const std::string reply = run_cad("features", json.dump(), folder, object, limits, progress);
  try {
    return fillets_in(Json::parse(reply));
  } catch (const Json::exception& error) {
    throw InputError(object +
                     ": the CAD program's answer is damaged: " + formats::json_reason(error));
  }
}

}  // namespace palmar::records
