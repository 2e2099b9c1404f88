// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "palmar/grasp/holds/hold_scene.h"
#include "palmar/grasp/holds/hold_site.h"

namespace palmar::grasp {

/// Reasons for and against a hold by the product's shape alone; docs/method/holds.md. `site` as
/// site_of() has it (of a precision grip: where its fingertips are, with `palm` any).
std::vector<HoldTerm> shape_terms(const HoldScene& scene, const Hold& hold, const HoldSite& site);

/// How much there is a better handle than that part (its number from 1).
HoldTerm handle_term(const HoldScene& scene, int part);

/// How well a closed hand goes with how the product lies, by the weights that were fitted to holds
/// of things that lay on a table: ln of how much rarer than the best. Only where that is known.
HoldTerm table_term(const HoldScene& scene, const HoldWeights& weights, const Grasp& grasp);
/// Its score of a power hold before the hand is closed, by where that would roughly be.
double rough_table_score(const HoldScene& scene, const HoldSite& at);

/// How much a term counts, by its name; 1 where nothing was fitted.
double weight_of(std::string_view term);

double sum_of(const std::vector<HoldTerm>& terms);

}  // namespace palmar::grasp
