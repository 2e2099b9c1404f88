// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/records/product/product_file.h"

namespace palmar::workflow {

/// What hands can take hold of on a product.
struct ProductPartsRequest {
  std::string file;                          ///< STL, OBJ, PLY, 3MF, glTF, STEP or IGES
  records::LoadProductOptions reading = {};  ///< its `progress` isn't used
  product::PartOptions options = {};
  std::string out;     ///< picture of the parts: .png or .svg; empty: none
  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct ProductPartsOutcome {
  product::Product product;
  product::ProductParts parts;
};

/// Throws UsageError, InputError naming the file, OutputError, Cancelled.
ProductPartsOutcome list_product_parts(const ProductPartsRequest& request,
                                       const Progress& progress = {});

}  // namespace palmar::workflow
