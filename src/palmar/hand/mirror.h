// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// The mirror image (right <-> left): x -> -x, triangles turned, axes reflected so that the same
/// posture angles give the mirrored posture.
Hand mirrored(const Hand& hand);

}  // namespace palmar::hand
