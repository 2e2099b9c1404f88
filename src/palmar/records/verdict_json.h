// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "palmar/study/assessment/verdict.h"

namespace palmar {

/// What is said of one product.
struct ProductWords {
  std::string held;      ///< whether it is held, a sentence
  std::string comfort;   ///< the three questions in one sentence
  std::string strength;  ///< empty if nothing is known
  std::string hardest;   ///< where it presses hardest, on which part of the product
};

/// What is said of all.
struct VerdictWords {
  std::string sentence;              ///< the answer
  std::vector<std::string> reasons;  ///< why, and what restricts it
  std::string next;                  ///< what to do next, to be followed by the command
  std::string command;               ///< for it; empty if there is none
  std::vector<ProductWords> products;
};

/// {"sentence", "reasons", "next", "command", "best", "comparisons"}: what stands as "verdict" of a
/// set of assessments. `names`: of the products.
nlohmann::ordered_json verdict_object(const SetVerdict& verdict, const VerdictWords& words,
                                      const std::vector<std::string>& names);

/// {"held", "comfort", "strength", "hardest"} of one product.
nlohmann::ordered_json verdict_object(const AssessedProduct& product, const ProductVerdict& verdict,
                                      const ProductWords& words);

}  // namespace palmar
