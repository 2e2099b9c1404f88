// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace palmar::records {

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

}  // namespace palmar::records
