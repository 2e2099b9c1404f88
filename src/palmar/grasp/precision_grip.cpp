// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision_grip.h"

#include <string>

#include "palmar/core/error.h"

namespace palmar {

void PrecisionGripOptions::check() const {}

Grasp close_precision_grip(const Hand& /*hand*/, const Product& /*product*/,
                           const PrecisionGripOptions& options, const Progress& /*progress*/) {
  throw UsageError("grip " + std::string(name_of(options.grip)) + " is not built yet");
}

}  // namespace palmar
