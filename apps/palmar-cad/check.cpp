// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// check: {file, millimetres_per_unit?} -> what the CAD kernel finds. version: {} -> the kernel's.
#include <Standard_Version.hxx>

#include "palmar/cad/cad_check.h"
#include "palmar/cad/cad_file.h"
#include "verbs.h"

namespace palmar::cad_worker {

Json check(const Json& request, const std::filesystem::path&, const Progress& progress) {
  ReadCadOptions read;
  if (request.contains("millimetres_per_unit")) {
    read.millimetres_per_unit = request.at("millimetres_per_unit").get<double>();
  }
  const CadFile file = read_cad(request.at("file").get<std::string>(), read, progress);
  const CadCheck result = check_cad(file.model);
  return {{"format", file.format},         {"unit", file.unit},
          {"is_good", result.is_good()},   {"is_valid", result.is_valid},
          {"is_closed", result.is_closed}, {"bodies", result.bodies},
          {"solids", result.solids},       {"faces", result.faces},
          {"edges", result.edges},         {"free_edges", result.free_edges},
          {"volume_mm3", result.volume},   {"area_mm2", result.area},
          {"findings", result.findings},   {"notes", file.notes}};
}

Json version(const Json&, const std::filesystem::path&, const Progress&) {
  return {{"opencascade", OCC_VERSION_COMPLETE}};
}

}  // namespace palmar::cad_worker
