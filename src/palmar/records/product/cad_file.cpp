// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/cad_file.h"

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

/// The child's answer; it may have been led astray by a hostile file, so nothing of it is taken for
/// granted.
template <typename Take>
auto take_reply(const std::string& reply, const std::string& object, const Take& take) {
  try {
    return take(Json::parse(reply));
  } catch (const Json::exception& error) {
    throw InputError(object +
                     ": the CAD program's answer is damaged: " + formats::json_reason(error));
  }
}

std::vector<std::string> texts_of(const Json& list) {
  constexpr std::size_t kMost = 10'000;
  std::vector<std::string> texts;
  for (const Json& text : list) {
    if (texts.size() < kMost) texts.push_back(text.get<std::string>());
  }
  return texts;
}

double finite(const Json& value, const char* name) {
  const double number = value.at(name).get<double>();
  return std::isfinite(number) ? number : 0.0;
}

}  // namespace

ImportedCad import_cad(const fs::path& path, const ImportCadOptions& options,
                       const CadLimits& limits, const Progress& progress) {
  check_cad_format(path);  // what needs no child is said without one
  const std::string object = path.string();
  Json request = {{"file", path.string()}, {"max_triangles", options.max_triangles}};
  if (options.millimetres_per_unit) request["millimetres_per_unit"] = *options.millimetres_per_unit;
  if (options.chordal_error) request["chordal_error_mm"] = *options.chordal_error;
  const CadFolder folder;
  const std::string reply = run_cad("import", request.dump(), folder, object, limits, progress);
  ImportedCad result = take_reply(reply, object, [](const Json& json) {
    ImportedCad cad;
    cad.format = json.at("format").get<std::string>();
    cad.unit = json.at("unit").get<std::string>();
    cad.millimetres_per_unit = finite(json, "millimetres_per_unit");
    cad.bodies = texts_of(json.at("bodies"));
    cad.solids = json.at("solids").get<int>();
    cad.open_shells = json.at("open_shells").get<int>();
    cad.chordal_error = finite(json, "chordal_error_mm");
    cad.chordal_reason = json.at("chordal_reason").get<std::string>();
    cad.volume = finite(json, "volume_mm3");
    cad.notes = texts_of(json.at("notes"));
    return cad;
  });
  try {
    result.mesh = read_face_mesh(folder.path() / "mesh.bin");
  } catch (const InputError& error) {
    throw InputError(object + ": the CAD program's answer can't be used: " + error.what());
  }
  return result;
}

std::string cad_kernel_version() {
  const CadFolder folder;
  const std::string reply = run_cad("version", "{}", folder, "palmar-cad", {.seconds = 10.0});
  return take_reply(reply, "palmar-cad",
                    [](const Json& json) { return json.at("opencascade").get<std::string>(); });
}

void convert_to_step(const fs::path& path, const fs::path& out,
                     std::optional<double> millimetres_per_unit, const CadLimits& limits,
                     const Progress& progress) {
  check_cad_format(path);
  Json request = {{"file", path.string()}};
  if (millimetres_per_unit) request["millimetres_per_unit"] = *millimetres_per_unit;
  const CadFolder folder;
  run_cad("convert", request.dump(), folder, path.string(), limits, progress);
  formats::write_file(out, formats::read_file(folder.path() / "product.step"));
}

CadVerdict check_cad_file(const fs::path& path, std::optional<double> millimetres_per_unit,
                          const CadLimits& limits, const Progress& progress) {
  check_cad_format(path);
  const std::string object = path.string();
  Json request = {{"file", path.string()}};
  if (millimetres_per_unit) request["millimetres_per_unit"] = *millimetres_per_unit;
  const CadFolder folder;
  const std::string reply = run_cad("check", request.dump(), folder, object, limits, progress);
  return take_reply(reply, object, [](const Json& json) {
    CadVerdict verdict;
    verdict.is_valid = json.at("is_valid").get<bool>();
    verdict.is_closed = json.at("is_closed").get<bool>();
    verdict.bodies = json.at("bodies").get<int>();
    verdict.solids = json.at("solids").get<int>();
    verdict.faces = json.at("faces").get<int>();
    verdict.edges = json.at("edges").get<int>();
    verdict.free_edges = json.at("free_edges").get<int>();
    verdict.volume = finite(json, "volume_mm3");
    verdict.area = finite(json, "area_mm2");
    verdict.findings = texts_of(json.at("findings"));
    return verdict;
  });
}

}  // namespace palmar::records
