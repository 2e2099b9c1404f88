// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/redesign/feature_goal.h"
#include "palmar/redesign/handle_shape.h"
#include "palmar/workflow/redesign/candidate_limits.h"
#include "palmar/workflow/redesign/search_story.h"
#include "palmar/workflow/redesign/shape_use.h"

namespace palmar::workflow {

/// What a shape must keep to; volumes are those of the handle.
struct ShapeLimits : CandidateLimits {
  std::optional<double> largest_change;  ///< mm; that any point of the handle may move
  /// mm, 0 or more; of a hollow handle, if the hollow stays as it is (handle_wall.h). Unset: a
  /// redesign may cut into it.
  std::optional<double> smallest_wall;
  double smallest_radius = 3.0;  ///< mm; of curvature, round the handle
  /// Along which a mould of two halves opens, product frame; unset: none. Then nothing may be
  /// undercut, and no wall of more than `land` [mm] lean less than `draft` [rad] (mould_release.h).
  std::optional<Vec3> pull;
  double draft = 0.035, land = 3.0;  ///< 2 degrees
  bool suits_both_hands = false;     ///< the same for left and right hands: no one-sided features
  /// mm at both flat ends that stay as they are, 0 to 200. Unset: what isn't the handle stays as it
  /// is beyond where hands grip (other_ends()).
  std::optional<double> kept_ends;
  std::vector<Box3> kept_boxes = {};  ///< product frame, mm: what lies in them stays as it is
  std::vector<std::string> kept_faces = {};  ///< CAD faces that stay, by number or name
  void check() const;                        ///< throws UsageError: setting, value, allowed range
};

/// Where hands come to lie, about the hold: independent normal distributions.
struct HoldSpread {
  int places = 5;      ///< that stand for them, 2 to 20; a hand takes one of them
  double along = 5.0;  ///< standard deviation along the handle, mm
  double turn = 0.14;  ///< about it, rad; 8 degrees
  void check() const;  ///< throws UsageError
};

/// A feature that may vary, or one that is set.
struct ShapeVariable {
  const redesign::HandleFeature* feature = nullptr;
  double lowest = 0.0, highest = 0.0;  ///< in the feature's unit; equal: set
};
/// "width", "width=28:40" or "width=34"; without values from a range about `start` that suits the
/// feature. Throws UsageError naming `vary`.
ShapeVariable shape_variable(const std::string& words, const redesign::HandleFeatures& start);

/// Making and judging shapes of a handle in hands that lie at different places on it, in one use or
/// several (figure_of_uses()).
///
/// A candidate is held by the first two hands of every place and use; if it is worse there than the
/// best one so far, beyond chance (95 %, paired), the others don't take it: its goal is that of the
/// best one times the ratio in these hands (SearchOutcome::roughness).
struct ShapeRun {
  std::vector<ShapeUse> uses;  ///< at least one
  redesign::FeatureGoal goal;  ///< of each of them
  ShapeLimits limits;
  redesign::HandleShape start;  ///< nearest to what there is
  std::vector<ShapeVariable> variables;

  /// Of every use: where hands lie, and the original there.
  void hold_original(const HoldSpread& spread, const Progress& progress);
  /// All features; `varying` are those of the variables that vary, in their units.
  redesign::HandleShape shape_of(const std::vector<double>& varying) const;
  SearchStory search(const redesign::SearchOptions& options, const Progress& progress) const;

 private:
  std::vector<redesign::SearchConstraint> constraints() const;
  /// `lead`: the best candidate so far, which this one may take the place of.
  redesign::SearchOutcome assess(const redesign::HandleShape& shape,
                                 std::optional<redesign::GoalFigure>& lead,
                                 SearchStory::Beside& beside, const Progress& progress) const;
  /// By constraints().
  std::vector<double> values_of(const redesign::HandleShape& shape,
                                const redesign::ShapeChange& change, double lost_share) const;
};

}  // namespace palmar::workflow
