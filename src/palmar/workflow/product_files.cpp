// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/product_files.h"

#include "palmar/core/error.h"
#include "palmar/formats/mesh/mesh_file.h"
#include "palmar/product/intake/unit_guard.h"
#include "palmar/records/product/cad_format.h"

namespace palmar::workflow {
namespace {

records::LoadProductOptions with_progress(records::LoadProductOptions options,
                                          const Progress& progress) {
  options.progress = progress;
  return options;
}

geometry::TriangleMesh in_millimetres(const formats::MeshFile& file, geometry::LengthUnit unit) {
  geometry::TriangleMesh mesh = file.mesh;
  const double scale = geometry::millimetres_per(unit);
  if (scale != 1.0) {
    for (Vec3& x : mesh.vertices) x *= scale;
  }
  return mesh;
}

}  // namespace

InspectOutcome inspect_product(const InspectRequest& request, const Progress& progress) {
  InspectOutcome outcome;
  if (records::is_cad_file(request.file)) {
    records::CadProduct read =
        records::load_cad_product(request.file, with_progress(request.reading, progress));
    outcome.product = std::move(read.product);
    const auto& faces = outcome.product.faces;
    outcome.check =
        product::check_mesh(outcome.product.mesh, true,
                            faces ? product::bodies_of_triangles(*faces) : std::vector<int>());
    if (request.asks_kernel) {
      outcome.kernel = records::check_cad_file(request.file, read.cad.millimetres_per_unit,
                                               request.reading.limits, progress);
    }
    outcome.cad = std::move(read.cad);
    return outcome;
  }
  outcome.product = records::load_product(
      request.file, records::LoadProductOptions{.unit = request.reading.unit});
  const formats::MeshFile raw = formats::read_mesh(request.file);
  // STL has no shared corners; what the product's own weld joins isn't a fault of the file.
  outcome.check = raw.format.find("STL") == std::string::npos
                      ? product::check_mesh(in_millimetres(raw, outcome.product.unit))
                      : product::check_mesh(outcome.product.mesh);
  return outcome;
}

void convert_product(const ConvertRequest& request, const Progress& progress) {
  if (records::cad_format_of_name(request.out) == records::CadFormat::kStep) {
    if (!records::is_cad_file(request.file)) {
      throw UsageError(request.file +
                       ": a mesh has no surfaces that STEP could hold; setting \"out\" with .stl, "
                       ".obj or .ply is required");
    }
    const auto& unit = request.reading.unit;
    records::convert_to_step(request.file, request.out,
                             unit ? std::optional(geometry::millimetres_per(*unit)) : std::nullopt,
                             request.reading.limits, progress);
    return;
  }
  const product::Product product =
      records::load_product(request.file, with_progress(request.reading, progress));
  for (const std::string& text : product.notes) note_to(request.note, text);
  formats::write_mesh(request.out, product.mesh);
}

RepairOutcome repair_product(const RepairRequest& request) {
  request.options.check();
  RepairOutcome outcome;
  const formats::MeshFile file = formats::read_mesh(request.file);
  Box3 box;
  for (const Vec3& x : file.mesh.vertices) box.extend(x);
  const product::UnitDecision unit =
      product::decide_unit(box, file.unit, request.unit, request.file);
  if (!unit.explanation.empty()) note_to(request.note, unit.explanation);
  for (const std::string& text : file.notes) note_to(request.note, text);
  const geometry::TriangleMesh mesh = in_millimetres(file, unit.unit);
  outcome.before = product::check_mesh(mesh);
  outcome.repaired = product::repair_mesh(mesh, request.options);
  formats::write_mesh(request.out, outcome.repaired.mesh);
  outcome.after = product::check_mesh(formats::read_mesh(request.out).mesh);
  return outcome;
}

}  // namespace palmar::workflow
