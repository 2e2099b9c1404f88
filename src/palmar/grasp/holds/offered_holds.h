// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold_terms.h"

namespace palmar::grasp {

/// Whether holds to hand a product over are asked for that offered_holds() has: between the pads of
/// thumb and fingers, not at a place along a part that is stated.
bool are_offered(const HoldOptions& options);

/// How people take a product to hand it over, by weights that were fitted to such holds: where the
/// density of theirs is largest (modes_of()) the fingertips come down. Best first by score; of
/// those whose fingertips don't reach it, or run into it, the terms say so.
std::vector<RankedHold> offered_holds(const HoldScene& scene, const HoldOptions& options,
                                      int& considered, const Progress& progress);

}  // namespace palmar::grasp
