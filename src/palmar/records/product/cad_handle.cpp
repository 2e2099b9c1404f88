// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_handle.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/records/handle_json.h"

namespace palmar::records {

namespace {

using Json = nlohmann::ordered_json;

}  // namespace

MadeHandle make_handle(const redesign::HandleShape& shape, const std::string& object,
                       const std::optional<CadSource>& source, double chordal_error,
                       const CadLimits& limits, const Progress& progress) {
  Json request = {{"shape", handle_shape_json(shape)}, {"chordal_error_mm", chordal_error}};
  if (source) request["source"] = Json::parse(source_text(*source));
  const CadFolder folder;
  const std::string reply = run_cad("handle", request.dump(), folder, object, limits, progress);
  MadeHandle made;
  try {
    const Json answer = Json::parse(reply);
    made.handle = {.step = formats::read_file(folder.path() / "product.step"),
                   .mesh = read_face_mesh(folder.path() / "mesh.bin"),
                   .volume = answer.at("volume_mm3").get<double>(),
                   .faces = answer.at("faces").get<int>(),
                   .poles = answer.at("poles").get<int>()};
    made.failure = answer.value("whole_failure", "");
    if (answer.contains("whole")) {
      made.whole = HandleSolid{.step = formats::read_file(folder.path() / "whole.step"),
                               .mesh = read_face_mesh(folder.path() / "whole.bin"),
                               .volume = answer.at("whole").at("volume_mm3").get<double>(),
                               .faces = answer.at("whole").at("faces").get<int>()};
    }
  } catch (const Json::exception& error) {
    throw InputError(object +
                     ": the CAD program's answer is damaged: " + formats::json_reason(error));
  } catch (const InputError& error) {
    throw InputError(object + ": the CAD program's answer can't be used: " + error.what());
  }
  return made;
}

}  // namespace palmar::records
