// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/workflow/redesign/redesign_feature.h"
#include "palmar/workflow/redesign/redesign_press.h"
#include "palmar/workflow/redesign/redesign_region.h"
#include "palmar/workflow/redesign/redesign_shape.h"

namespace palmar::cli {

// What redesigns found, in a few lines for people.
std::string press_text(const workflow::RedesignPressOutcome& outcome);
std::string region_text(const workflow::RedesignRegionOutcome& outcome);
std::string shape_text(const workflow::RedesignShapeOutcome& outcome);
std::string search_text(const workflow::SearchStory& story);
std::string proposals_text(const std::vector<workflow::TriedProposal>& tried,
                           const redesign::FeatureGoal& goal);

}  // namespace palmar::cli
