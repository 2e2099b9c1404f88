// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/workflow/redesign/feature_run.h"

namespace palmar {

/// A change of one feature that is worth trying, because of what hands feel there.
struct TriedProposal {
  std::string words;   ///< as feature_setting() reads them: "fillet:face=7=6"
  std::string reason;  ///< "face 7 (fillet r 3) has the highest pressure in 63 % of hands"
  SearchOutcome outcome;
  double gain = 0.0;  ///< share by which the goal gets better; below 0: worse
  bool is_feasible = false;
  double grip_force_ratio = 0.0;  ///< by the original's
};

/// From the original's grasps: faces that carry the highest pressure in a tenth of hands or more.
/// A fillet gets twice its radius (as far as the budget of change allows), sharp edges of a face a
/// radius, a plane or a cylinder moves in and out. Each is tried once; best first.
std::vector<TriedProposal> try_proposals(FeatureRun& run, const Progress& progress);

std::string proposals_csv(const std::vector<TriedProposal>& tried);
/// One JSON object.
std::string proposals_json(const std::vector<TriedProposal>& tried, const FeatureGoal& goal);

}  // namespace palmar
