// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "hands/phantom/mri/tissue_image.h"
#include "palmar/core/error.h"

namespace palmar::phantom {

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
  const auto require = [](bool holds, const char* field, double value, const char* allowed) {
    if (!holds) throw UsageError(fmt::format("{} is {}; allowed are {}", field, value, allowed));
  };
  require(fat_shift >= -5.0 && fat_shift <= 5.0, "fat_shift", fat_shift, "-5 to 5 mm");
  require(acquired >= 0.3 && acquired <= 1.0, "acquired", acquired, "0.3 to 1");
  require(marrow_texture >= 0.0 && marrow_texture <= 0.5, "marrow_texture", marrow_texture,
          "0 to 0.5");
  require(mask >= 0.0 && mask <= 20.0, "mask", mask, "0 to 20");
}

}  // namespace palmar::phantom
