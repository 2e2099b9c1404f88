// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "palmar/product/product.h"

namespace palmar {

struct LoadProductOptions {
  /// Unit of the file. Unset: the format's own unit, else one proposed from the size against a hand
  /// and told in Product::notes.
  std::optional<LengthUnit> unit;
};

/// Reads a mesh file (see read_mesh()), settles its unit, converts to mm, checks and repairs it,
/// and prepares its distance field. The file's stem becomes the name. Throws InputError naming the
/// file and what is wrong with it, also when the unit can't be decided.
Product load_product(const std::filesystem::path& path, const LoadProductOptions& options = {});

}  // namespace palmar
