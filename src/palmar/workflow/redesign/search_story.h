// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/feature_goal.h"
#include "palmar/redesign/feature_search.h"
#include "palmar/report/chart/figure.h"
#include "palmar/workflow/redesign/feature_settings.h"

namespace palmar::workflow {

/// A search with what is to be said of it.
struct SearchStory {
  std::vector<FeatureSetting> settings;
  redesign::SearchProblem problem;
  redesign::FeatureGoal goal;
  redesign::SearchResult result;
  redesign::GoalFigure original;  ///< in the same hands
  /// One per trial that could be made: hands that lost hold, grip force by the original's.
  struct Beside {
    int hands = 0, lost = 0;
    double grip_force_ratio = 0.0;
    double volume_ratio = 0.0;
    double largest_change = 0.0;  ///< mm, of the surface
    redesign::GoalFigure figure;
    std::vector<double> by_use = {};  ///< goal by the original's, by `uses`; none if broken off
  };
  std::vector<Beside> beside;
  std::vector<std::string> uses = {};  ///< names, if there are several
};

/// Makes a candidate from the values of its variables, assesses it and says what is beside the
/// goal.
using CandidateJudge =
    std::function<redesign::SearchOutcome(const std::vector<double>&, SearchStory::Beside&)>;

/// Searches the problem of a story, or assesses the one candidate if nothing varies: `result` and
/// `beside`. Throws as search_features().
void run_search(SearchStory& story, const CandidateJudge& judge,
                const redesign::SearchOptions& options, const Progress& progress);

/// Whether the goal of the best candidate, which there must be, is better than the original's.
bool is_better_than_original(const SearchStory& story);

/// One row per candidate, in the order in which they were tried.
std::string history_csv(const SearchStory& story);
/// One JSON object.
std::string history_json(const SearchStory& story);
/// Candidates within the constraints that no other one beats both in the goal and in how little of
/// the surface moves: indices into the history, the smallest change first.
std::vector<int> fair_choices(const SearchStory& story);
/// The goal over the largest change of the surface: all candidates, and the fair choices as a line
/// with their numbers. Any of them can be picked.
std::string choices_svg(const SearchStory& story);

/// With several uses: candidates within the constraints that no other one beats in every use,
/// ascending by the first use.
std::vector<int> fair_uses(const SearchStory& story);
/// The same candidates drawn: of every use but the first its goal over that of the first, as shares
/// of the original's, with the fair ones and the best one marked.
std::vector<report::Figure> uses_figures(const SearchStory& story);
/// The picture of choices_svg().
report::Figure choices_figure(const SearchStory& story);

/// The goal over the candidates, and the best feasible one so far.
std::string history_svg(const SearchStory& story);

}  // namespace palmar::workflow
