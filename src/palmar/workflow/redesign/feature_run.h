// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/redesign/feature_goal.h"
#include "palmar/workflow/redesign/candidate_limits.h"
#include "palmar/workflow/redesign/candidate_study.h"
#include "palmar/workflow/redesign/feature_settings.h"
#include "palmar/workflow/redesign/search_story.h"

namespace palmar::workflow {

/// What a candidate must keep to.
struct FeatureLimits : CandidateLimits {
  std::optional<double> largest_offset;    ///< mm; that any point of the surface may move
  std::string keep_out;                    ///< faces that must stay, in words; "": none
  double smallest_radius = 0.5;            ///< mm; of fillets
  std::optional<double> least_grip_force;  ///< share of the original's
  void check() const;                      ///< throws UsageError: setting, value, allowed range
};

/// What hands say of one shape.
struct JudgedShape {
  redesign::GoalFigure figure;
  double grip_force_ratio = 0.0;  ///< by the original's
};

/// Surfaces that lie nearer to each other are one, mm.
inline constexpr double kUnchanged = 0.005;

/// Making and assessing candidates: what a search and proposals share.
struct FeatureRun {
  const RedesignRequest& request;
  records::CadSource source;
  std::vector<FeatureSetting> settings;
  FeatureLimits limits;
  redesign::FeatureGoal goal;
  const HeldOriginal* original = nullptr;
  std::vector<double> start;  ///< by setting: what the original has, within the range
  mutable std::optional<JudgedShape> kept_as_it_is = {};  ///< of as_it_is()

  /// Asks the CAD program which edges and faces are meant and what they are now. Throws UsageError
  /// on unknown ones.
  void find_starts(const Progress& progress);
  /// Values of all settings from those of the ones that vary.
  std::vector<double> all_values(const std::vector<double>& varying) const;
  /// The solid of a candidate.
  records::ChangedCad make(const std::vector<double>& varying, bool mesh, bool step,
                           const Progress& progress) const;
  product::Product product_of(const records::ChangedCad& made, const std::string& name,
                              const std::string& source_name) const;
  std::vector<redesign::SearchConstraint> constraints() const;
  JudgedShape judge(const records::ChangedCad& made, const Progress& progress) const;
  /// The original, made and meshed like a candidate, so that differences come from the shape alone;
  /// judged once.
  const JudgedShape& as_it_is(const Progress& progress) const;
  /// Made, held by all hands, judged. A candidate that changes nothing is the original.
  redesign::SearchOutcome assess(const std::vector<double>& varying, SearchStory::Beside& beside,
                                 const Progress& progress) const;
  /// Made only: constraints that hands decide are NaN.
  redesign::SearchOutcome measure(const std::vector<double>& varying,
                                  const Progress& progress) const;
  /// By constraints().
  std::vector<double> values_of(const records::ChangedCad& made, double grip_force_ratio,
                                double lost_share) const;
  /// With nothing that varies: the one candidate.
  SearchStory search(double step, const redesign::SearchOptions& options,
                     const Progress& progress) const;
};

}  // namespace palmar::workflow
