// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "palmar/core/error.h"
#include "palmar/phantom/mri/tissue_image.h"

namespace palmar {

void ScannerOptions::check() const {
  if (subsamples < 1 || subsamples > 8) {
    throw UsageError(fmt::format("subsamples is {}; allowed are 1 to 8", subsamples));
  }
  if (!(snr == 0.0 || (snr >= 1.0 && snr <= 1000.0))) {
    throw UsageError(fmt::format("snr is {}; allowed are 0 (no noise) and 1 to 1000", snr));
  }
  if (!(bias >= 0.0 && bias <= 0.9)) {
    throw UsageError(fmt::format("bias is {}; allowed are 0 to 0.9", bias));
  }
}

}  // namespace palmar
