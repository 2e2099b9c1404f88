// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/product/product_file.h"

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/records/product/cad_format.h"
#include "palmar/records/product/made_product.h"

namespace palmar::records {
namespace {

/// In which unit the size is judged. A foot, say, is none of Palmar's: its lengths are in mm
/// already.
product::UnitDecision decide(const ImportedCad& cad, const LoadProductOptions& options,
                             const std::string& object) {
  std::optional<geometry::LengthUnit> from_file = geometry::length_unit_named(cad.unit);
  if (!from_file && !cad.unit.empty() && !options.unit)
    from_file = geometry::LengthUnit::kMillimetre;
  const double per_unit = geometry::millimetres_per(
      options.unit.value_or(from_file.value_or(geometry::LengthUnit::kMillimetre)));
  Box3 box;
  for (const Vec3& v : cad.mesh.mesh.vertices) box.extend(Vec3(v / per_unit));
  return product::decide_unit(box, from_file, options.unit, object);
}

/// read_mesh() for a place that takes CAD as well, and whose messages say so.
formats::MeshFile read_shape(const std::filesystem::path& path) {
  try {
    return formats::read_mesh(path);
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string meshes = "glTF and GLB are read";
    if (!text.ends_with(meshes)) throw;
    text.replace(text.size() - meshes.size(), meshes.size(), "glTF, GLB, STEP and IGES are read");
    throw InputError(text);
  }
}

}  // namespace

CadProduct load_cad_product(const std::filesystem::path& path, const LoadProductOptions& options) {
  const std::string object = path.string();
  ImportCadOptions import;
  import.chordal_error = options.chordal_error;
  if (options.unit) import.millimetres_per_unit = geometry::millimetres_per(*options.unit);
  CadProduct result;
  result.cad = import_cad(path, import, options.limits, options.progress);
  product::UnitDecision decision = decide(result.cad, options, object);
  if (decision.source == product::UnitSource::kProposed &&
      decision.unit != geometry::LengthUnit::kMillimetre) {
    // A file without a unit whose size doesn't suggest mm: once more, so that the chordal error is
    // in mm.
    import.millimetres_per_unit = geometry::millimetres_per(decision.unit);
    result.cad = import_cad(path, import, options.limits, options.progress);
  }
  const ImportedCad& cad = result.cad;
  const geometry::LengthUnit unit = decision.unit;
  decision.unit = geometry::LengthUnit::kMillimetre;  // the child has turned everything into mm
  product::Product& product = result.product;
  product =
      product::make_product(path.stem().string(), cad.mesh.mesh, decision, object, &cad.mesh.faces);
  product.unit = unit;
  const std::string in_file = cad.unit.empty() ? "not stated" : cad.unit;
  product.notes.push_back(
      cad.format + ", unit " +
      (options.unit ? name_of(*options.unit) + " as given (file: " + in_file + ")" : in_file) +
      "; chordal error " + significant(cad.chordal_error, 4) + " mm (" + cad.chordal_reason + ")");
  product.notes.insert(product.notes.end(), cad.notes.begin(), cad.notes.end());
  return result;
}

product::Product load_product(const std::filesystem::path& path,
                              const LoadProductOptions& options) {
  if (is_made(path.string())) return make_solid(made_from(path.string()));
  if (is_cad_file(path)) return load_cad_product(path, options).product;
  const formats::MeshFile file = read_shape(path);
  Box3 box;
  for (const Vec3& v : file.mesh.vertices) box.extend(v);
  const product::UnitDecision unit =
      product::decide_unit(box, file.unit, options.unit, path.string());
  product::Product product =
      product::make_product(path.stem().string(), file.mesh, unit, path.string());
  product.notes.insert(product.notes.end(), file.notes.begin(), file.notes.end());
  return product;
}

}  // namespace palmar::records
