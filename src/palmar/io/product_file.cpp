// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/product_file.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/io/cad_file.h"
#include "palmar/io/cad_format.h"
#include "palmar/io/made_product.h"
#include "palmar/io/mesh_file.h"
#include "palmar/product/make_product.h"
#include "palmar/product/unit_guard.h"

namespace palmar {
namespace {

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.4g", value);
  return text.data();
}

std::optional<LengthUnit> unit_of(const ImportedCad& cad) {
  if (cad.unit.empty()) return std::nullopt;
  for (const LengthUnit unit :
       {LengthUnit::kMillimetre, LengthUnit::kCentimetre, LengthUnit::kMetre, LengthUnit::kInch}) {
    if (std::abs(cad.millimetres_per_unit / millimetres_per(unit) - 1.0) < 1e-9) return unit;
  }
  return LengthUnit::kMillimetre;  // a foot, say: what it was converted to
}

Product load_cad(const std::filesystem::path& path, const LoadProductOptions& options) {
  const std::string object = path.string();
  ImportCadOptions import;
  import.chordal_error = options.chordal_error;
  ImportedCad cad;
  UnitDecision decision;
  // The second round is for a file without a unit whose size doesn't tell mm.
  for (int round = 0; round < 2; ++round) {
    if (options.unit) import.millimetres_per_unit = millimetres_per(*options.unit);
    cad = import_cad(path, import, options.limits, options.progress);
    const std::optional<LengthUnit> from_file = options.unit ? std::nullopt : unit_of(cad);
    const double per_unit =
        millimetres_per(options.unit.value_or(from_file.value_or(LengthUnit::kMillimetre)));
    Box3 box;
    for (const Vec3& v : cad.mesh.mesh.vertices) box.extend(Vec3(v / per_unit));
    if (round == 1) break;
    decision = decide_unit(box, from_file, options.unit, object);
    if (decision.source != UnitSource::kProposed || decision.unit == LengthUnit::kMillimetre) break;
    import.millimetres_per_unit = millimetres_per(decision.unit);
  }
  // The child has turned everything into mm.
  const LengthUnit unit = decision.unit;
  decision.unit = LengthUnit::kMillimetre;
  Product product =
      make_product(path.stem().string(), cad.mesh.mesh, decision, object, &cad.mesh.faces);
  product.unit = unit;
  product.notes.push_back(cad.format + ", unit " + (cad.unit.empty() ? "not told" : cad.unit) +
                          "; chordal error " + number(cad.chordal_error) + " mm (" +
                          cad.chordal_reason + ")");
  product.notes.insert(product.notes.end(), cad.notes.begin(), cad.notes.end());
  return product;
}

}  // namespace

Product load_product(const std::filesystem::path& path, const LoadProductOptions& options) {
  if (is_made(path.string())) return make_solid(made_from(path.string()));
  if (is_cad_file(path)) return load_cad(path, options);
  const MeshFile file = read_mesh(path);
  Box3 box;
  for (const Vec3& v : file.mesh.vertices) box.extend(v);
  const UnitDecision unit = decide_unit(box, file.unit, options.unit, path.string());
  Product product = make_product(path.stem().string(), file.mesh, unit, path.string());
  product.notes.insert(product.notes.end(), file.notes.begin(), file.notes.end());
  return product;
}

}  // namespace palmar
