// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product_files.h"

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/records/product/cad_format.h"

namespace palmar {
namespace {

LoadProductOptions with_progress(LoadProductOptions options, const Progress& progress) {
  options.progress = progress;
  return options;
}

TriangleMesh in_millimetres(const MeshFile& file, LengthUnit unit) {
  TriangleMesh mesh = file.mesh;
  const double scale = millimetres_per(unit);
  if (scale != 1.0) {
    for (Vec3& x : mesh.vertices) x *= scale;
  }
  return mesh;
}

}  // namespace

InspectOutcome inspect_product(const InspectRequest& request, const Progress& progress) {
  InspectOutcome outcome;
  if (is_cad_file(request.file)) {
    CadProduct read = load_cad_product(request.file, with_progress(request.reading, progress));
    outcome.product = std::move(read.product);
    const auto& faces = outcome.product.faces;
    outcome.check = check_mesh(outcome.product.mesh, true,
                               faces ? bodies_of_triangles(*faces) : std::vector<int>());
    if (request.asks_kernel) {
      outcome.kernel = check_cad_file(request.file, read.cad.millimetres_per_unit,
                                      request.reading.limits, progress);
    }
    outcome.cad = std::move(read.cad);
    return outcome;
  }
  outcome.product = load_product(request.file, LoadProductOptions{.unit = request.reading.unit});
  const MeshFile raw = read_mesh(request.file);
  // STL has no shared corners; what the product's own weld joins isn't a fault of the file.
  outcome.check = raw.format.find("STL") == std::string::npos
                      ? check_mesh(in_millimetres(raw, outcome.product.unit))
                      : check_mesh(outcome.product.mesh);
  return outcome;
}

void convert_product(const ConvertRequest& request, const Progress& progress) {
  if (cad_format_of_name(request.out) == CadFormat::kStep) {
    if (!is_cad_file(request.file)) {
      throw UsageError(request.file +
                       ": a mesh has no surfaces that STEP could hold; setting \"out\" with .stl, "
                       ".obj or .ply is required");
    }
    const auto& unit = request.reading.unit;
    convert_to_step(request.file, request.out,
                    unit ? std::optional(millimetres_per(*unit)) : std::nullopt,
                    request.reading.limits, progress);
    return;
  }
  const Product product = load_product(request.file, with_progress(request.reading, progress));
  for (const std::string& text : product.notes) note_to(request.note, text);
  write_mesh(request.out, product.mesh);
}

RepairOutcome repair_product(const RepairRequest& request) {
  request.options.check();
  RepairOutcome outcome;
  const MeshFile file = read_mesh(request.file);
  Box3 box;
  for (const Vec3& x : file.mesh.vertices) box.extend(x);
  const UnitDecision unit = decide_unit(box, file.unit, request.unit, request.file);
  if (!unit.explanation.empty()) note_to(request.note, unit.explanation);
  for (const std::string& text : file.notes) note_to(request.note, text);
  const TriangleMesh mesh = in_millimetres(file, unit.unit);
  outcome.before = check_mesh(mesh);
  outcome.repaired = repair_mesh(mesh, request.options);
  write_mesh(request.out, outcome.repaired.mesh);
  outcome.after = check_mesh(read_mesh(request.out).mesh);
  return outcome;
}

}  // namespace palmar
