// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::capture {

/// Where the palm of the reference scan is in another scan: the way from one patient frame to the
/// other that places metacarpals II and III, which hardly move against each other, and the carpals
/// next to them on their counterparts. Starts from the middles of bones of the same name. Nothing
/// if the scans share fewer than three bones of the palm.
std::optional<geometry::Rigid3> place_palm(const ScanSurfaces& reference,
                                           const ScanSurfaces& posture);

}  // namespace palmar::capture
