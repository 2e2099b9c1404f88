// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "palmar/core/progress.h"
#include "palmar/product/product.h"
#include "palmar/records/product/cad_file.h"
#include "palmar/records/product/cad_worker.h"

namespace palmar::records {

struct LoadProductOptions {
  /// Unit of the file. Unset: the format's own unit, else one proposed from the size against a hand
  /// and reported in Product::notes.
  std::optional<geometry::LengthUnit> unit = {};
  // Of CAD files (STEP, IGES):
  std::optional<double> chordal_error =
      {};  ///< mm; unset: from size and smallest radius, reported in notes
  CadLimits limits = {};
  Progress progress = {};
};

/// Reads a mesh file (see read_mesh()) or a CAD file (see import_cad()), settles its unit, converts
/// to mm, checks and repairs it, and prepares its distance field. The file's stem becomes the name.
/// Of CAD, Product::faces shows the faces. Throws InputError naming the file and what is wrong with
/// it, also when the unit can't be decided.
product::Product load_product(const std::filesystem::path& path,
                              const LoadProductOptions& options = {});

/// A CAD file as product, and what else the file holds.
struct CadProduct {
  product::Product product;
  ImportedCad cad;  ///< its mesh is the one before make_product()
};
CadProduct load_cad_product(const std::filesystem::path& path,
                            const LoadProductOptions& options = {});

}  // namespace palmar::records
