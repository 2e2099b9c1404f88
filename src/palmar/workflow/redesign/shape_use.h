// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/feature_goal.h"
#include "palmar/workflow/redesign/hold_offsets.h"

namespace palmar::workflow {

/// One of several ways in which a handle is used, as it is asked for: by whom, how firmly, with
/// which hand and grip. What isn't said is as in the redesign's request.
struct ShapeUseRequest {
  std::string name;       ///< the words that it was asked for by: "hand=left weight=0.1"
  double weight = 1.0;    ///< among all uses; above 0
  RedesignRequest asked;  ///< with what this use has otherwise
};

/// From words, separated by spaces: "weight=2", "grip-force-n=40", "grip=medium_wrap",
/// "population=ansur2_women" (may be repeated), "hands=12" (of each population), "hand=left" or
/// "hand=right". Throws UsageError naming `use` and the words.
ShapeUseRequest shape_use(const std::string& words, const RedesignRequest& usual);

/// A use with its hands on the original.
struct ShapeUse {
  std::string name;
  double weight = 1.0;  ///< share of all uses' weights
  RedesignRequest request;
  HeldOriginal original;
  std::vector<HoldOffset> offsets = {};  ///< hand h lies at the one number h modulo their count
  std::vector<study::StudyRecord> before = {};  ///< of the original, one per hand, there
  redesign::GoalFigure figure = {};             ///< of the original
  std::size_t first_values =
      0;  ///< values of it in those hands that hold a candidate before others

  int hand_count() const { return static_cast<int>(original.study.plan.hands.size()); }
  /// The first two hands of every place.
  int first_hands() const;

  /// Fills in `before`, `figure` and `first_values`.
  void hold_original(const redesign::FeatureGoal& goal, const Progress& progress);
  /// Grasps of hands `from` to before `to`, each at its own place, added to `records`.
  void grasp(OffsetGrasps& grasps, int from, int to, std::vector<study::StudyRecord>& records,
             const Progress& progress) const;
  /// In the first `hands` hands, with `after` of the candidate.
  study::StudyResults results_with(const std::vector<study::StudyRecord>& after, int hands) const;
};

/// Figures of one candidate (or the original) in all uses as one. Of one use it is that figure. Of
/// several the mean, by the uses' weights, of the figures as shares of the original's; its values
/// are those of all hands, the first hands of all uses before the others, weighted so that their
/// mean is this one where uses have equally many hands. Throws UsageError if the original's figure
/// of a use is 0.
redesign::GoalFigure figure_of_uses(const std::vector<ShapeUse>& uses,
                                    const std::vector<redesign::GoalFigure>& figures);

/// What the figure of several uses is called.
redesign::FeatureGoal goal_of_uses(const redesign::FeatureGoal& goal, std::size_t uses);

}  // namespace palmar::workflow
