// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "palmar/study/statistics/study_results.h"

namespace palmar::redesign {

/// One figure of a product over all hands that a search makes better.
struct FeatureGoal {
  enum class Statistic { kMean, kP95, kShareAbove };
  std::string key = "peak_pressure_cells_mpa";  ///< of a quantity, see quantities_of()
  Statistic statistic = Statistic::kMean;
  double threshold = 0.0;  ///< of kShareAbove; in the quantity's unit
  std::string name, unit;  ///< "mean of peak pressure on sensor cells", "MPa"
  bool is_lower_better = true;
};

/// From words: "peak" (pressure on sensor cells), "mean" (pressure), "discomfort" (largest pressure
/// of a region over its onset of discomfort), "torque" (the largest about the grip axis that
/// friction holds), "strength" (least grip strength of a person who holds the task's force),
/// "effort" (share of the muscles' strength in use), "stability" (largest wrench that every
/// direction resists), or the key of any quantity that has a better direction; with ":p95" the 95th
/// percentile over hands, with ":above=0.3" the share of hands above that. Throws UsageError.
FeatureGoal feature_goal(const std::string& words);
/// Whether a quantity is an index of grasps, not one that every grasp has.
bool is_index(const std::string& key);
/// Whether grasps need their indices for it.
bool needs_indices(const FeatureGoal& goal);

struct GoalFigure {
  double value = 0.0;
  double error = 0.0;          ///< standard error over hands; 0 of a percentile
  int hands = 0;               ///< that hold the original and have a value of it
  int lost = 0;                ///< of these don't hold this product
  std::vector<double> values;  ///< by hand that holds the original
};

/// The goal of product `product` over the hands that hold the original (product `original`). A hand
/// that loses hold counts as the worst hand does with the original: no shape gets better by
/// falling out of hands. Throws UsageError if no hand has a value with the original.
GoalFigure goal_of(const study::StudyResults& results, const FeatureGoal& goal, int product,
                   int original = 0);

/// From one product to another in the same hands, both against the same original: the difference of
/// the figures as a share of the first, and its standard error from the hands' own differences (of
/// the 95th percentile that of the mean).
struct GoalChange {
  double share = 0.0, error = 0.0;
};
/// Throws UsageError if they are of different hands.
GoalChange goal_change(const GoalFigure& from, const GoalFigure& to);

/// Whether, in the same hands, `figure` is worse than `than` beyond chance: by a paired t test,
/// one-sided at `level`. False with fewer than two hands. Throws UsageError if they are of
/// different hands.
bool is_worse(const FeatureGoal& goal, const GoalFigure& than, const GoalFigure& figure,
              double level);

/// A mean over all hands in the first `count` of them alone.
GoalFigure first_of(const GoalFigure& figure, std::size_t count);

/// Mean of a quantity over the hands that have it with both products: of `product` divided by that
/// of `original`. 0 if there is no such hand.
double mean_ratio(const study::StudyResults& results, const std::string& key, int product,
                  int original = 0);

}  // namespace palmar::redesign
