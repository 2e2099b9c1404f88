// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// check: {file, millimetres_per_unit?} -> what the CAD kernel finds.
// convert: the same -> product.step. version: {} -> the kernel's.
#include <Standard_Version.hxx>
#include <cmath>
#include <string>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/core/error.h"
#include "read_request.h"
#include "verbs.h"

namespace palmar::cad_worker {

cad::CadFile read_request(const Json& request, const Progress& progress) {
  cad::ReadCadOptions read;
  if (request.contains("millimetres_per_unit")) {
    read.millimetres_per_unit = request.at("millimetres_per_unit").get<double>();
  }
  const std::string object = request.at("file").get<std::string>();
  return on_file(object, [&] { return cad::read_cad(object, read, progress); });
}

Json check(const Json& request, const std::filesystem::path&, const Progress& progress) {
  const cad::CadFile file = read_request(request, progress);
  const cad::CadCheck result = cad::check_cad(file.model);
  return {{"format", file.format},         {"unit", file.unit},
          {"is_good", result.is_good()},   {"is_valid", result.is_valid},
          {"is_closed", result.is_closed}, {"bodies", result.bodies},
          {"solids", result.solids},       {"faces", result.faces},
          {"edges", result.edges},         {"free_edges", result.free_edges},
          {"volume_mm3", result.volume},   {"area_mm2", result.area},
          {"findings", result.findings},   {"notes", file.notes}};
}

Json convert(const Json& request, const std::filesystem::path& folder, const Progress& progress) {
  const std::string object = request.at("file").get<std::string>();
  const cad::CadFile file = read_request(request, progress);
  cad::write_step(folder / "product.step", file.model);
  const double before = cad::volume_of(file.model);
  const double after = cad::volume_of(cad::read_step(folder / "product.step").model);
  constexpr double kSame = 1e-3;
  if (std::abs(after - before) > kSame * std::abs(before)) {
    throw NumericalError(object + ": written as STEP and read back its volume is " +
                         std::to_string(after) + " mm3; it was " + std::to_string(before) + " mm3");
  }
  return {{"bodies", cad::body_names(file.model)}, {"faces", file.model.face_count()}};
}

Json version(const Json&, const std::filesystem::path&, const Progress&) {
  return {{"opencascade", OCC_VERSION_COMPLETE}};
}

}  // namespace palmar::cad_worker
