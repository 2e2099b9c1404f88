// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace palmar {

/// The script of the report's 3-D view: viewer/viewer.ts and three.js in one file, bundled when
/// Palmar is built. Needs no other file and no network.
std::string_view viewer_bundle();

/// Licence of three.js (MIT), which must stand beside the script.
std::string_view viewer_licence();

}  // namespace palmar
