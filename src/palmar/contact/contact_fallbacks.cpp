// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "palmar/contact/contact.h"

namespace palmar::contact {

const std::array<FallbackCount, 11> kFallbackCounts = {{
    {"refused_matrices", "systems had a matrix that is not positive definite",
     &ContactFallbacks::refused_matrices},
    {"gradient_limits", "systems were given up by conjugate gradients",
     &ContactFallbacks::gradient_limits},
    {"exchange_limits", "systems reached the limit of exchanges",
     &ContactFallbacks::exchange_limits},
    {"dense_solutions", "systems were solved by dense block pivoting",
     &ContactFallbacks::dense_solutions},
    {"lemke_solutions", "systems were solved by Lemke's method",
     &ContactFallbacks::lemke_solutions},
    {"by_region", "problems were solved region by region", &ContactFallbacks::by_region},
    {"unsolved_regions", "regions have no solution and carry no force",
     &ContactFallbacks::unsolved_regions},
    {"extension_limits", "problems were left with skin that bulges into the product",
     &ContactFallbacks::extension_limits},
    {"stiffening_limits", "problems were left before their stiffening was steady",
     &ContactFallbacks::stiffening_limits},
    {"without_bulge", "regions were solved with the bulge left out of the printed equations",
     &ContactFallbacks::without_bulge},
    {"band_levels", "levels or slopes of the error band have no solution",
     &ContactFallbacks::band_levels},
}};

ContactFallbacks& ContactFallbacks::operator+=(const ContactFallbacks& other) {
  for (const FallbackCount& one : kFallbackCounts) this->*one.count += other.*one.count;
  return *this;
}

std::string fallbacks_in_words(const ContactFallbacks& fallbacks) {
  std::string words;
  for (const FallbackCount& one : kFallbackCounts) {
    const int count = fallbacks.*one.count;
    if (count == 0) continue;
    if (!words.empty()) words += "; ";
    words += std::to_string(count) + " " + std::string(one.words);
  }
  return words;
}

}  // namespace palmar::contact
