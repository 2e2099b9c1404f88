// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/server/product_shelf.h"

namespace palmar::server {

/// How far each vertex of a changed shape lies from the surface of the original, mm; negative where
/// material went.
std::vector<double> change_of(const product::Product& original,
                              const geometry::TriangleMesh& changed);

/// What a page draws of a redesign: the original (`changed` empty: a product frame, live_frame.h),
/// or the mesh that was made of it with how far its surface moved, mm, in place of pressures (a
/// footprint frame). In the product's own frame, mm. Throws InputError.
std::string shape_frame(const ShelvedProduct& original, const std::filesystem::path& changed);

}  // namespace palmar::server
