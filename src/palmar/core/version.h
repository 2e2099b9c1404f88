// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace palmar {

/// Version of the program, "major.minor.patch".
std::string version();

/// Version, compiler and build type, for provenance in results.
std::string build_description();

}  // namespace palmar
