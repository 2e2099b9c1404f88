// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold_terms.h"

namespace palmar::grasp {

/// Precision and lateral holds that a product's shape suggests, or the one that is asked for, with
/// the fingertips set down by close_precision_grip(). Scores aren't summed up yet.
std::vector<RankedHold> precision_holds(const HoldScene& scene, const HoldOptions& options,
                                        const Progress& progress);

}  // namespace palmar::grasp
