// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "source_model.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "palmar/cad/model/cad_file.h"
#include "palmar/cad/solids/solids.h"
#include "palmar/core/error.h"

namespace palmar::cad_worker {

cad::CadModel model_of(const Json& source, Json& notes) {
  if (source.contains("kind")) {
    const product::ParametricKind& kind =
        product::parametric_kind(source.at("kind").get<std::string>());
    std::vector<std::pair<std::string, double>> given;
    const Json parameters = source.value("parameters", Json::object());
    for (const auto& [name, value] : parameters.items()) {
      given.emplace_back(name, value.get<double>());
    }
    return cad::make_kind_solid(kind, product::complete_values(kind, given));
  }
  cad::ReadCadOptions options;
  if (source.contains("millimetres_per_unit")) {
    options.millimetres_per_unit = source.at("millimetres_per_unit").get<double>();
  }
  const std::string file = source.at("file").get<std::string>();
  cad::CadFile read = cad::read_cad(file, options);
  if (read.solids == 0) {
    throw InputError(
        fmt::format("{}: no solid, only open surfaces; features of a solid can change", file));
  }
  for (const std::string& note : read.notes) notes.push_back(note);
  return read.model;
}

}  // namespace palmar::cad_worker
