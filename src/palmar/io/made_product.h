// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "palmar/product/product.h"

namespace palmar {

/// A simple solid as a study tells it: kind and lengths.
struct MadeProduct {
  std::string kind;                                    ///< "cylinder", "prism", ...
  std::vector<std::pair<std::string, double>> length;  ///< "diameter_mm", 35
};

/// "cylinder", "prism", "sphere", "ellipsoid".
const std::vector<std::string>& made_kinds();
/// "diameter_mm", "length_mm", ... of a kind, in the order in which they are told; empty for an
/// unknown kind.
std::vector<std::string> made_lengths(const std::string& kind);

/// "made: cylinder diameter_mm=35 length_mm=130": what StudyProduct::file says of it. Lengths that
/// aren't given are left out.
std::string words_of(const MadeProduct& product);
bool is_made(const std::string& words);
/// Throws InputError: not such words.
MadeProduct made_from(const std::string& words);

/// The solid with all its lengths times `size`. Throws UsageError: lengths outside their limits.
Product make_solid(const MadeProduct& product, double size = 1.0);

}  // namespace palmar
