// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/search_variable.h"

namespace palmar::redesign {

/// Something of a candidate that must stay on one side of a limit: value <= limit, or >= it.
struct SearchConstraint {
  std::string name;  ///< "largest change of the surface"
  std::string unit;
  double limit = 0.0;
  bool is_highest = true;  ///< the limit is the highest value allowed; else the lowest
};

/// What a candidate turned out to be.
struct SearchOutcome {
  std::string failure = {};        ///< why it can't be made or held; empty if it could
  double goal = 0.0;               ///< in its own unit
  double goal_error = 0.0;         ///< standard error over hands; 0: none
  std::vector<double> constraint;  ///< values, by SearchProblem::constraints
  /// Variance of the goal by that of a whole assessment. Above 1 the assessment was broken off, as
  /// the candidate was clearly worse than another one: it tells something, but is never the best.
  double roughness = 1.0;
  bool is_rough() const { return roughness > 1.0; }
};

struct SearchProblem {
  std::vector<SearchVariable> variables;
  std::vector<SearchConstraint> constraints;
  bool is_lower_better = true;
  /// Makes and assesses a candidate. What throws NumericalError counts as a candidate that can't be
  /// made; other errors end the search.
  std::function<SearchOutcome(const std::vector<double>&)> evaluate;
  /// Makes a candidate without assessing it, if that is much quicker: values of constraints, NaN of
  /// those that need the assessment. May be empty.
  std::function<SearchOutcome(const std::vector<double>&)> measure{};
};

enum class SearchMethod {
  kAutomatic,  ///< BOBYQA for two or more variables with bounds only, else COBYLA
  kCobyla,     ///< linear models, constraints (Powell 1994)
  kBobyqa,     ///< quadratic models, bounds only (Powell 2009)
  kDirect,     ///< half of the budget by DIRECT-L over all of the range (Gablonsky, Kelley 2001),
               ///< then from the best of it as kAutomatic
  kSurface     ///< a smooth surface through what was found so far (surface_search.h): for many
               ///< variables and goals that scatter
};
std::string name_of(SearchMethod method);  ///< "auto", "cobyla", "bobyqa", "direct", "surface"
SearchMethod search_method(const std::string& name);  ///< throws UsageError

struct SearchOptions {
  SearchMethod method = SearchMethod::kAutomatic;
  int evaluations = 20;  ///< most candidates that are made, the start among them
  /// First step of a variable as a share of its range.
  double first_step = 0.25;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// One candidate, in the order in which they were tried.
struct SearchTrial {
  std::vector<double> values;  ///< by variable, rounded to its step
  SearchOutcome outcome;
  bool is_feasible = false;  ///< made, held and within all constraints
  double seconds = 0.0;      ///< spent; not a result
};

struct SearchResult {
  std::vector<SearchTrial> history;  ///< each combination of values once; the start first
  std::optional<int> best;           ///< index of the best feasible one
  std::optional<double> expected;    ///< its goal by the smooth surface, without its own luck
  std::string method;                ///< "COBYLA (NLopt 2.7.1)"
  std::string ending;                ///< "converged", "budget spent"
};

/// Looks for the values with the best goal within bounds and constraints, without derivatives: a
/// fixed number of candidates, none twice. What hands feel has more than one valley (a fillet that
/// grows is felt only when it reaches the skin), so the start is followed by both ends of every
/// variable: as far as `measure` says that it can go with the others at the start, found by
/// bisection; a single variable stays within these ends. The optimiser goes on from the best.
/// Candidates that can't be made are penalised: they count as somewhat worse than the worst one
/// that could. The same problem gives the same history. Throws UsageError on a problem that makes
/// no sense (field and value), Cancelled.
SearchResult search_features(const SearchProblem& problem, const SearchOptions& options = {},
                             const Progress& progress = {});

/// One candidate of `problem`, made and assessed. What throws NumericalError, and a goal that is
/// not finite, is a failure of the trial.
SearchTrial try_candidate(const SearchProblem& problem, const std::vector<double>& values);

/// The result where nothing varies: the one candidate, assessed.
SearchResult as_given(const SearchProblem& problem);

/// How far a candidate is beyond a constraint, as a share of its limit; 0 or below within it.
double excess(const SearchConstraint& constraint, double value);

}  // namespace palmar::redesign
