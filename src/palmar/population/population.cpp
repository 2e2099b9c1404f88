// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/population/population.h"

namespace palmar {

std::string name_of(Evidence evidence) {
  switch (evidence) {
    case Evidence::kMeasured:
      return "measured";
    case Evidence::kRegressed:
      return "regressed";
    case Evidence::kScaled:
      break;
  }
  return "scaled";
}

}  // namespace palmar
