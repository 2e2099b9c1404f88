// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/made_product.h"

#include <algorithm>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/product/primitives.h"
#include "palmar/product/scaled_product.h"

namespace palmar::records {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kMade = "made: ";
constexpr std::size_t kKept = 64;  // solids; a sweep's worth

product::KindValues values_of(const MadeProduct& product) {
  return product::complete_values(product::parametric_kind(product.kind), product.given);
}

product::Product make_analytic(const MadeProduct& product, const SolidOptions& options) {
  const product::KindValues values = values_of(product);
  const auto mm = [&](const char* name) { return options.size * values.at(name); };
  const product::MeshFineness fineness{.chordal_error = options.chordal_error};
  if (product.kind == "cylinder") {
    return product::make_cylinder_product(
        {.diameter = mm("diameter_mm"), .length = mm("length_mm"), .fineness = fineness});
  }
  if (product.kind == "prism") {
    return product::make_prism_product({.width = mm("width_mm"),
                                        .depth = mm("depth_mm"),
                                        .length = mm("length_mm"),
                                        .fillet_radius = mm("fillet_mm"),
                                        .fineness = fineness});
  }
  if (product.kind == "sphere")
    return product::make_sphere_product({.diameter = mm("diameter_mm"), .fineness = fineness});
  return product::make_ellipsoid_product(
      {.diameters = {mm("x_mm"), mm("y_mm"), mm("z_mm")}, .fineness = fineness});
}

product::Product make_by_cad(const MadeProduct& product, double chordal_error) {
  const MadeCad cad = make_cad(product, {.step = false, .chordal_error = chordal_error});
  product::Product made = product::make_product(title_of(product), cad.mesh.mesh,
                                                {.unit = geometry::LengthUnit::kMillimetre,
                                                 .source = product::UnitSource::kMade,
                                                 .explanation = ""},
                                                words_of(product), &cad.mesh.faces);
  made.notes.insert(made.notes.end(), cad.notes.begin(), cad.notes.end());
  return made;
}

/// Solids that the CAD program has made in this process, the latest first.
product::Product kept_or_made(const MadeProduct& product, double chordal_error) {
  static std::mutex mutex;
  static std::list<std::pair<std::string, product::Product>> kept;
  const std::string words = words_of(product) + " " + formats::shortest(chordal_error);
  const std::lock_guard lock(mutex);
  const auto found =
      std::find_if(kept.begin(), kept.end(), [&](const auto& one) { return one.first == words; });
  if (found != kept.end()) {
    kept.splice(kept.begin(), kept, found);
  } else {
    kept.emplace_front(words, make_by_cad(product, chordal_error));
    if (kept.size() > kKept) kept.pop_back();
  }
  return kept.front().second;
}

}  // namespace

std::string words_of(const MadeProduct& product) {
  std::string words = std::string(kMade) + product.kind;
  for (const auto& [name, value] : product.given)
    words += " " + name + "=" + formats::shortest(value);
  return words;
}

bool is_made(const std::string& words) { return words.rfind(kMade, 0) == 0; }

MadeProduct made_from(const std::string& words) {
  formats::TextScanner scanner(
      std::string_view(words).substr(std::min(kMade.size(), words.size())));
  const auto kind = scanner.next_word();
  if (!is_made(words) || !kind) {
    throw InputError(
        formats::in_quotes(words) +
        " describes no product that Palmar makes; \"made: cylinder diameter_mm=35\" does");
  }
  MadeProduct product{std::string(*kind), {}};
  while (const auto word = scanner.next_word()) {
    const std::size_t equals = word->find('=');
    const auto value =
        equals == word->npos ? std::nullopt : formats::parse_double(word->substr(equals + 1));
    if (!value) {
      throw InputError(formats::in_quotes(words) + ": " + formats::in_quotes(*word) +
                       " is no parameter with its value, as diameter_mm=35 is");
    }
    product.given.emplace_back(word->substr(0, equals), *value);
  }
  values_of(product);
  return product;
}

std::string title_of(const MadeProduct& product) {
  std::string title = product.kind;
  for (const auto& [name, value] : product.given) {
    const std::string unit = product::unit_of_parameter(name);
    const std::string what = unit.empty() ? name : name.substr(0, name.size() - unit.size() - 1);
    title += " " + what + " " + formats::shortest(value) + (unit.empty() ? "" : " " + unit);
  }
  std::replace(title.begin(), title.end(), '_', ' ');
  return title;
}

std::optional<Vec3> thumb_side_of(const MadeProduct& product) {
  const product::ParametricKind& kind = product::parametric_kind(product.kind);
  if (!kind.thumb_side) return std::nullopt;
  return kind.thumb_side(product::complete_values(kind, product.given));
}

bool is_analytic(const MadeProduct& product) {
  if (product.kind == "sphere" || product.kind == "ellipsoid") return true;
  if (product.kind != "cylinder" && product.kind != "prism") return false;
  return std::none_of(product.given.begin(), product.given.end(), [](const auto& one) {
    return one.first == "end_fillet_mm" && one.second != 0.0;
  });
}

product::Product make_solid(const MadeProduct& product, const SolidOptions& options) {
  product::Product solid =
      is_analytic(product)
          ? make_analytic(product, options)
          : product::scaled(kept_or_made(product, options.chordal_error), options.size);
  solid.source = words_of(product);
  return solid;
}

MadeCad make_cad(const MadeProduct& product, const MakeCadOptions& options,
                 const Progress& progress) {
  values_of(product);  // before a process is started
  Json request = {{"kind", product.kind},
                  {"parameters", Json::object()},
                  {"step", options.step},
                  {"mesh", options.mesh}};
  for (const auto& [name, value] : product.given) request["parameters"][name] = value;
  if (options.chordal_error) request["chordal_error_mm"] = *options.chordal_error;
  const CadFolder folder;
  const std::string what = words_of(product);
  const Json reply =
      Json::parse(run_cad("make", request.dump(), folder, what, options.limits, progress));
  MadeCad made;
  made.volume = reply.at("volume_mm3").get<double>();
  made.notes = reply.at("notes").get<std::vector<std::string>>();
  if (options.step) made.step = formats::read_file(folder.path() / "product.step");
  if (options.mesh) {
    made.mesh = face_mesh_from_bytes(formats::read_file(folder.path() / "mesh.bin"), what);
    made.chordal_error = reply.at("chordal_error_mm").get<double>();
  }
  return made;
}

}  // namespace palmar::records
