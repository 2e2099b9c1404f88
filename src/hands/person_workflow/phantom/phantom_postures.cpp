// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/phantom/phantom_postures.h"

#include <algorithm>

namespace palmar::person_workflow {

std::vector<hand::ScanPosture> sorted_postures(const std::vector<hand::ScanPosture>& postures) {
  std::vector<hand::ScanPosture> sorted = postures;
  for (int p = 0; postures.empty() && p < hand::kScanPostureCount; ++p) {
    sorted.push_back(static_cast<hand::ScanPosture>(p));
  }
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  return sorted;
}

}  // namespace palmar::person_workflow
