// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/workflow/redesign/feature_run.h"

namespace palmar::workflow {

/// What is to be said of a proposal that was tried.
enum class ProposalVerdict {
  kChange,      ///< better, beyond chance: the interval of the gain is above 0
  kLeave,       ///< no gain is shown: it isn't worth a change
  kWorse,       ///< worse, beyond chance
  kNotAllowed,  ///< beyond a constraint
  kImpossible   ///< it can't be made or held
};
std::string name_of(ProposalVerdict verdict);  ///< "change", "leave", "worse", ...

/// A change of features with what the hands said of it.
struct TriedProposal {
  std::string words;   ///< as feature_setting() reads them: "fillet:face=7=6"
  std::string reason;  ///< "face 7 (fillet r 3) has the highest pressure in 63 % of hands"
  redesign::SearchOutcome outcome;
  double gain = 0.0;              ///< share by which the goal gets better; below 0: worse
  double gain_error = 0.0;        ///< its standard error, over the hands' own differences
  double largest_change = 0.0;    ///< mm, of the surface
  double grip_force_ratio = 0.0;  ///< by the original's
  ProposalVerdict verdict = ProposalVerdict::kLeave;
  /// Gain per millimetre by which the surface moves: what they are ranked by.
  double gain_per_mm() const { return largest_change > 0.0 ? gain / largest_change : 0.0; }
};

/// What a gain and its standard error say, 95 % certain.
ProposalVerdict verdict_on(double gain, double gain_error);

/// proposals_for() the original's grasps, each tried once in the same hands at the same task.
/// Changes first, most gain per millimetre first; then what should stay as it is.
std::vector<TriedProposal> try_proposals(FeatureRun& run, const Progress& progress);

std::string proposals_csv(const std::vector<TriedProposal>& tried);
/// One JSON object.
std::string proposals_json(const std::vector<TriedProposal>& tried,
                           const redesign::FeatureGoal& goal);

}  // namespace palmar::workflow
