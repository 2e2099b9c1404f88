// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/feature_proposals.h"
#include "palmar/workflow/redesign/feature_run.h"
#include "palmar/workflow/redesign/feature_settings.h"
#include "palmar/workflow/redesign/redesign_outcome.h"
#include "palmar/workflow/redesign/redesign_request.h"
#include "palmar/workflow/redesign/search_story.h"

namespace palmar::workflow {

struct RedesignFeatureOutcome;

/// Redesign 3: sizes of CAD features, chosen by what the hands feel.
struct RedesignFeatureRequest {
  RedesignRequest redesign;
  /// Features with their ranges, or one value that is just made, as feature_setting() reads them:
  /// "fillet:long=1:15", "diameter_mm=25:45".
  std::vector<std::string> vary;
  GrooveSettings grooves;
  double smallest_groove_radius = 3.0;  ///< mm; of the smallest cutter that can be used
  std::string goal = "peak";            ///< what is made better, as feature_goal() reads it
  FeatureLimits limits;
  redesign::SearchOptions search;
  double step = 0.05;     ///< mm (deg of tapers); sizes are rounded to it, as a machine keeps it
  bool proposes = false;  ///< no search: tries a change of every feature that carries peaks
  bool compares = true;   ///< in the end the same hands hold original and redesign
  /// Called when search or proposals are finished and written, before the redesign is made and held
  /// again; json and comparison of the outcome are still empty.
  std::function<void(const RedesignFeatureOutcome&)> on_search;

  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
};

/// A solid that was made.
struct MadeRedesign {
  std::string name;                          ///< "fillet:long 10.2 mm"
  std::filesystem::path step;                ///< STEP file; redesign.stl is beside it
  double volume = 0.0, volume_before = 0.0;  ///< mm^3
  double largest_change = 0.0;               ///< mm, of the surface
};

struct RedesignFeatureOutcome : RedesignOutcome {
  redesign::FeatureGoal goal;
  std::optional<SearchStory> story;      ///< nothing with `proposes`
  std::vector<TriedProposal> proposals;  ///< with `proposes`, best first
  std::optional<MadeRedesign> redesign;  ///< nothing if the best changes nothing
};

/// Searches (or proposes) and writes to OUT: history.csv, history.svg, search.json, redesign.step,
/// redesign.stl and what compare_redesigns() writes; proposals.csv with `proposes`. Throws
/// UsageError, InputError, NumericalError if no hand holds the original or no candidate is within
/// the limits, Cancelled.
RedesignFeatureOutcome redesign_features(const RedesignFeatureRequest& request,
                                         const Progress& progress = {});

}  // namespace palmar::workflow
