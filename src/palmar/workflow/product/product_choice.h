// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/product/product.h"
#include "palmar/records/product/product_file.h"

namespace palmar::workflow {

/// Which product a task is done with: a file, or a value that is in memory already.
struct ProductChoice {
  ProductChoice() = default;
  ProductChoice(std::filesystem::path path, records::LoadProductOptions options = {})
      : file(std::move(path)), reading(std::move(options)) {}
  ProductChoice(product::Product product) : value(std::move(product)) {}

  std::filesystem::path file;             ///< STL, OBJ, PLY, 3MF, glTF, STEP or IGES
  records::LoadProductOptions reading;    ///< of the file; its `progress` isn't used
  std::optional<product::Product> value;  ///< in place of `file`

  std::string name() const;  ///< path, or the value's name: what messages call it
  void check() const;        ///< throws UsageError: neither a file nor a value, limits of reading
};

/// Throws InputError naming the file and what is wrong with it.
product::Product load_product(const ProductChoice& choice, const Progress& progress = {});

/// Adds what a check of its mesh finds to the product's notes, unless they say so already.
void add_findings(product::Product& product);

/// How the product is held, where a solid made by Palmar states by itself which side the thumb is
/// on and nothing else is asked for.
grasp::GraspOptions options_for(const grasp::GraspSettings& settings,
                                const product::Product& product);

}  // namespace palmar::workflow
