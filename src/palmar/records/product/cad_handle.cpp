// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_handle.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/json_reason.h"
#include "palmar/records/handle_json.h"

namespace palmar {

using Json = nlohmann::ordered_json;

HandleSolid make_handle(const HandleShape& shape, const std::string& object, double chordal_error,
                        const CadLimits& limits, const Progress& progress) {
  const Json request = {{"shape", handle_shape_json(shape)}, {"chordal_error_mm", chordal_error}};
  const CadFolder folder;
  const std::string reply = run_cad("handle", request.dump(), folder, object, limits, progress);
  HandleSolid made;
  try {
    const Json answer = Json::parse(reply);
    made.volume = answer.at("volume_mm3").get<double>();
    made.faces = answer.at("faces").get<int>();
    made.poles = answer.at("poles").get<int>();
    made.mesh = read_face_mesh(folder.path() / "mesh.bin");
    made.step = read_file(folder.path() / "product.step");
  } catch (const Json::exception& error) {
    throw InputError(object + ": the CAD program's answer is damaged: " + json_reason(error));
  } catch (const InputError& error) {
    throw InputError(object + ": the CAD program's answer can't be used: " + error.what());
  }
  return made;
}

}  // namespace palmar
