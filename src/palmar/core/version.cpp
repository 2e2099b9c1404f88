// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/core/version.h"

namespace palmar {

std::string version() { return PALMAR_VERSION; }

std::string build_description() {
  return "palmar " PALMAR_VERSION ", " PALMAR_COMPILER ", " PALMAR_BUILD_TYPE;
}

}  // namespace palmar
