// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/holds/hold_scene.h"
#include "palmar/grasp/holds/hold_site.h"

namespace palmar::grasp {

/// Reasons for and against a hold by the product's shape alone; docs/method/holds.md. `site` as
/// site_of() has it (of a precision grip: where its fingertips are, with `palm` any).
std::vector<HoldTerm> shape_terms(const HoldScene& scene, const Hold& hold, const HoldSite& site);

/// How well a closed hand goes with how the product lies, by the weights that were fitted to holds
/// of things that lay on a table: ln of how much rarer than the best. Only where that is known.
HoldTerm table_term(const HoldScene& scene, const HoldWeights& weights, const Grasp& grasp);
/// Its score of a power hold before the hand is closed, by where that would roughly be.
double rough_table_score(const HoldScene& scene, const HoldSite& at);

/// Where the working end sticks out from a site across its axis, beyond the hand on the thumb's
/// side: unit, product frame; nothing if it doesn't.
std::optional<Vec3> nose_of(const HoldScene& scene, const GripSite& site);

double sum_of(const std::vector<HoldTerm>& terms);

}  // namespace palmar::grasp
