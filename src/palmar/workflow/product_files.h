// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/core/progress.h"
#include "palmar/product/intake/check.h"
#include "palmar/product/intake/repair.h"
#include "palmar/product/product.h"
#include "palmar/records/product/product_file.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

// What a product's file holds, another format for it, and its repair.

struct InspectRequest {
  std::string file;                          ///< STL, OBJ, PLY, 3MF, glTF, STEP or IGES
  records::LoadProductOptions reading = {};  ///< its `progress` isn't used
  bool asks_kernel = false;                  ///< CAD: the kernel's verdict on its solids as well
};
struct InspectOutcome {
  product::Product product;
  product::ProductCheck check;              ///< of the mesh as the file has it, not yet repaired
  std::optional<records::ImportedCad> cad;  ///< of a CAD file
  std::optional<records::CadVerdict> kernel;
};
/// Throws InputError naming the file, UsageError, Cancelled.
InspectOutcome inspect_product(const InspectRequest& request, const Progress& progress = {});

struct ConvertRequest {
  std::string file;                          ///< STL, OBJ, PLY, 3MF, glTF, STEP or IGES
  std::string out;                           ///< .stl, .obj or .ply; .step if it was CAD
  records::LoadProductOptions reading = {};  ///< its `progress` isn't used
  NoteSink note = {};                        ///< what was found in a mesh
};
/// The same product in mm: a mesh welded and oriented, or the exact solids as STEP. Throws
/// UsageError for STEP of a mesh; InputError, OutputError, Cancelled.
void convert_product(const ConvertRequest& request, const Progress& progress = {});

struct RepairRequest {
  std::string file;                               ///< mesh file
  std::optional<geometry::LengthUnit> unit = {};  ///< of a file that carries none
  std::string out;                                ///< .stl, .obj or .ply; not the file itself
  product::RepairOptions options = {};
  NoteSink note = {};  ///< how the unit was known, what was found
};
struct RepairOutcome {
  product::ProductCheck before;
  product::RepairResult repaired;
  product::ProductCheck after;  ///< of the file that was written: single precision may join
                                ///< vertices
};
/// Throws UsageError, InputError naming the file, OutputError.
RepairOutcome repair_product(const RepairRequest& request);

}  // namespace palmar::workflow
