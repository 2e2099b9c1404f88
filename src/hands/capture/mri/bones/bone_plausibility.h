// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"

namespace palmar::capture {

/// What doesn't look right about the bones of a scan, as clauses: a bone far shorter or longer than
/// the model's, by the size of the hand (outside of 0.7 to 1.4 times; 0.6 to 1.7 for carpals, whose
/// shapes vary; of the scaphoid, than people's), or one that doesn't reach the next bone of its
/// finger (8 mm and more apart, where people have 1 to 3). A shaft that came in two parts, or a
/// wrong name, shows itself so. Bones that the image cuts, and lengths of radius and ulna, are left
/// out.
std::vector<std::string> doubtful_bones(const ScanSurfaces& surfaces, const hand::Hand& model);

}  // namespace palmar::capture
