// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/feature_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <map>
#include <nlopt.hpp>

#include "palmar/core/error.h"
#include "palmar/redesign/surface_search.h"

namespace palmar::redesign {
namespace {

/// Not feasible by less than this share of a limit is feasible: values of constraints are measured.
constexpr double kExcess = 1e-9;
// A candidate that can't be made counts as this share of the goals' spread worse than the worst.
constexpr double kWorse = 0.5;

void check_problem(const SearchProblem& problem) {
  if (problem.variables.empty()) throw UsageError("search: nothing may vary");
  if (!problem.evaluate) throw UsageError("search: candidates can't be assessed");
  for (const SearchVariable& variable : problem.variables) {
    if (!std::isfinite(variable.lowest) || !std::isfinite(variable.highest) ||
        !(variable.lowest < variable.highest)) {
      throw UsageError(fmt::format("search: {} from {} to {}; from a smaller to a larger value",
                                   variable.name, variable.lowest, variable.highest));
    }
    if (!(variable.step > 0.0) || variable.step > variable.highest - variable.lowest) {
      throw UsageError(fmt::format("search: {} in steps of {}; above 0, at most its range of {}",
                                   variable.name, variable.step,
                                   variable.highest - variable.lowest));
    }
    if (!(variable.start >= variable.lowest && variable.start <= variable.highest)) {
      throw UsageError(fmt::format("search: {} starts at {}, outside of {} to {}", variable.name,
                                   variable.start, variable.lowest, variable.highest));
    }
  }
  for (const SearchConstraint& constraint : problem.constraints) {
    if (!std::isfinite(constraint.limit)) {
      throw UsageError(fmt::format("search: {} has no finite limit", constraint.name));
    }
  }
}

struct BudgetSpent {};

/// Candidates by whole steps, each made once.
class Candidates {
 public:
  Candidates(const SearchProblem& problem, int budget, const Progress& progress)
      : problem_(problem), budget_(budget), limit_(budget), progress_(progress) {}

  std::vector<SearchTrial>& history() { return history_; }
  /// Candidates that may be made until BudgetSpent is thrown.
  void limit(int candidates) { limit_ = std::min(candidates, budget_); }

  /// How far a variable can go from the start towards 0 or 1 (`end`), the others at the start: to
  /// whole steps, by bisection. In [0, 1].
  double reach(std::vector<double> x, size_t variable, double end) const {
    if (!problem_.measure) return end;
    const SearchVariable& own = problem_.variables[variable];
    const double range = own.highest - own.lowest;
    const auto is_allowed = [&](double at) {
      progress_.throw_if_cancelled();
      x[variable] = at;
      try {
        const SearchOutcome outcome =
            problem_.measure(values_at(problem_.variables, steps_at(problem_.variables, x)));
        if (!outcome.failure.empty()) return false;
        for (size_t i = 0; i < problem_.constraints.size(); ++i) {
          // NaN: not known without the assessment.
          if (excess(problem_.constraints[i], outcome.constraint.at(i)) > kExcess) return false;
        }
        return true;
      } catch (const NumericalError&) {
        return false;
      }
    };
    if (is_allowed(end)) return end;
    double good = (own.start - own.lowest) / range, bad = end;
    while (std::abs(bad - good) * range > 1.01 * own.step) {
      const double middle = 0.5 * (good + bad);
      (is_allowed(middle) ? good : bad) = middle;
    }
    return good;
  }

  /// `x` in [0, 1] per variable.
  const SearchTrial& at(const std::vector<double>& x) {
    const SearchSteps key = steps_at(problem_.variables, x);
    const std::vector<double> values = values_at(problem_.variables, key);
    const auto known = by_steps_.find(key);
    if (known != by_steps_.end()) return history_[known->second];
    if (static_cast<int>(history_.size()) >= limit_) throw BudgetSpent();
    by_steps_[key] = history_.size();
    history_.push_back(make(values));
    return history_.back();
  }

  /// What the optimiser is to make small: the goal by the spread of the start, its sign such that
  /// lower is better.
  double goal(const SearchTrial& trial) const {
    if (trial.outcome.failure.empty()) return signed_goal(trial);
    double best = INFINITY, worst = -INFINITY;
    for (const SearchTrial& one : history_) {
      if (!one.outcome.failure.empty()) continue;
      best = std::min(best, signed_goal(one));
      worst = std::max(worst, signed_goal(one));
    }
    if (worst < best) return 1.0;
    return worst + kWorse * std::max(worst - best, 0.1 * std::abs(worst));
  }

  double over(const SearchTrial& trial, size_t constraint) const {
    // What can't be made has no value: the optimiser learns of it by the goal alone.
    if (!trial.outcome.failure.empty()) return 0.0;
    return excess(problem_.constraints[constraint], trial.outcome.constraint[constraint]);
  }

  std::optional<int> best() const {
    std::optional<int> best;
    for (size_t i = 0; i < history_.size(); ++i) {
      if (!history_[i].is_feasible || history_[i].outcome.is_rough()) continue;
      if (!best || signed_goal(history_[i]) < signed_goal(history_[*best])) {
        best = static_cast<int>(i);
      }
    }
    return best;
  }

 private:
  double signed_goal(const SearchTrial& trial) const {
    const double scale = history_.empty() || !history_.front().outcome.failure.empty() ||
                                 history_.front().outcome.goal == 0.0
                             ? 1.0
                             : std::abs(history_.front().outcome.goal);
    return (problem_.is_lower_better ? 1.0 : -1.0) * trial.outcome.goal / scale;
  }

  SearchTrial make(const std::vector<double>& values) const {
    progress_.update(static_cast<double>(history_.size()) / budget_,
                     words_of(problem_.variables, values));
    return try_candidate(problem_, values);
  }

  const SearchProblem& problem_;
  int budget_ = 0, limit_ = 0;
  const Progress& progress_;
  std::vector<SearchTrial> history_;
  std::map<SearchSteps, size_t> by_steps_;
};

/// What NLopt calls back with.
struct Callback {
  Candidates* candidates = nullptr;
  size_t constraint = 0;
  /// DIRECT knows no constraints here: what exceeds them is penalised.
  size_t penalised_constraints = 0;
  /// NLopt lets no exceptions through: they are kept while it is asked to stop.
  std::exception_ptr* thrown = nullptr;
};

template <typename Function>
double guarded(const Callback& callback, const Function& function) {
  try {
    return function();
  } catch (...) {
    *callback.thrown = std::current_exception();
    throw nlopt::forced_stop();
  }
}

double goal_at(const std::vector<double>& x, std::vector<double>&, void* data) {
  const Callback& callback = *static_cast<Callback*>(data);
  return guarded(callback, [&] {
    const SearchTrial& trial = callback.candidates->at(x);
    double goal = callback.candidates->goal(trial);
    for (size_t i = 0; i < callback.penalised_constraints; ++i) {
      goal += std::max(0.0, callback.candidates->over(trial, i));
    }
    return goal;
  });
}

double excess_at(const std::vector<double>& x, std::vector<double>&, void* data) {
  const Callback& callback = *static_cast<Callback*>(data);
  return guarded(callback, [&] {
    return callback.candidates->over(callback.candidates->at(x), callback.constraint);
  });
}

/// True if it ended by itself, false if the budget was spent.
bool run(nlopt::algorithm algorithm, const SearchProblem& problem, const SearchOptions& options,
         Candidates& candidates, std::vector<double> x, double low = 0.0, double high = 1.0) {
  const unsigned n = static_cast<unsigned>(problem.variables.size());
  nlopt::opt optimiser(algorithm, n);
  optimiser.set_lower_bounds(low);
  optimiser.set_upper_bounds(high);
  const bool has_constraints = algorithm == nlopt::LN_COBYLA;
  std::exception_ptr thrown;
  Callback goal{&candidates, 0, has_constraints ? 0 : problem.constraints.size(), &thrown};
  optimiser.set_min_objective(goal_at, &goal);
  std::vector<Callback> excesses(problem.constraints.size(), Callback{&candidates, 0, 0, &thrown});
  if (has_constraints) {
    for (size_t i = 0; i < excesses.size(); ++i) {
      excesses[i].constraint = i;
      optimiser.add_inequality_constraint(excess_at, &excesses[i], 0.0);
    }
  }
  // Finer than half a step of the machine candidates are the same.
  std::vector<double> tolerance;
  for (const SearchVariable& variable : problem.variables) {
    tolerance.push_back(0.5 * variable.step / (variable.highest - variable.lowest));
  }
  optimiser.set_xtol_abs(tolerance);
  optimiser.set_xtol_rel(0.0);
  optimiser.set_initial_step(std::min(options.first_step, 0.5 * (high - low)));
  // Rounded values are answered from memory, so the optimiser might go on for long without a new
  // candidate.
  optimiser.set_maxeval(100 * options.evaluations);
  double value = 0.0;
  try {
    optimiser.optimize(x, value);
  } catch (const nlopt::forced_stop&) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const BudgetSpent&) {
      return false;
    }
  } catch (const nlopt::roundoff_limited&) {
    return true;
  }
  return true;
}

}  // namespace

std::string name_of(SearchMethod method) {
  switch (method) {
    case SearchMethod::kAutomatic:
      return "auto";
    case SearchMethod::kCobyla:
      return "cobyla";
    case SearchMethod::kBobyqa:
      return "bobyqa";
    case SearchMethod::kDirect:
      return "direct";
    case SearchMethod::kSurface:
      return "surface";
  }
  return "";
}

SearchMethod search_method(const std::string& name) {
  for (const SearchMethod method :
       {SearchMethod::kAutomatic, SearchMethod::kCobyla, SearchMethod::kBobyqa,
        SearchMethod::kDirect, SearchMethod::kSurface}) {
    if (name_of(method) == name) return method;
  }
  throw UsageError("optimiser \"" + name +
                   "\"; allowed are auto, cobyla, bobyqa, direct and surface");
}

void SearchOptions::check() const {
  if (evaluations < 2 || evaluations > 10000) {
    throw UsageError(fmt::format("evaluations is {}; 2 to 10000 are allowed", evaluations));
  }
  if (!(first_step > 0.0 && first_step <= 0.5)) {
    throw UsageError(
        fmt::format("first step is {} of the range; above 0 to 0.5 is allowed", first_step));
  }
}

double excess(const SearchConstraint& constraint, double value) {
  const double scale = constraint.limit == 0.0 ? 1.0 : std::abs(constraint.limit);
  return (constraint.is_highest ? value - constraint.limit : constraint.limit - value) / scale;
}

SearchTrial try_candidate(const SearchProblem& problem, const std::vector<double>& values) {
  SearchTrial trial;
  trial.values = values;
  const auto before = std::chrono::steady_clock::now();
  try {
    trial.outcome = problem.evaluate(values);
  } catch (const NumericalError& error) {
    trial.outcome = {.failure = error.what(), .constraint = {}};
  }
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  if (trial.outcome.failure.empty()) {
    if (trial.outcome.constraint.size() != problem.constraints.size()) {
      throw UsageError(fmt::format("search: {} values of {} constraints",
                                   trial.outcome.constraint.size(), problem.constraints.size()));
    }
    trial.is_feasible = std::isfinite(trial.outcome.goal);
    for (size_t i = 0; i < problem.constraints.size(); ++i) {
      if (!(excess(problem.constraints[i], trial.outcome.constraint[i]) <= kExcess)) {
        trial.is_feasible = false;
      }
    }
    if (!std::isfinite(trial.outcome.goal)) trial.outcome.failure = "its goal is not finite";
  }
  return trial;
}

SearchResult as_given(const SearchProblem& problem) {
  const SearchTrial only = try_candidate(problem, {});
  SearchResult result;
  result.history = {only};
  if (only.is_feasible) result.best = 0;
  result.method = "as given";
  result.ending = "one candidate";
  return result;
}

SearchResult search_features(const SearchProblem& problem, const SearchOptions& options,
                             const Progress& progress) {
  check_problem(problem);
  options.check();
  if (options.method == SearchMethod::kSurface) {
    return search_by_surface(problem, options.evaluations, progress);
  }
  const bool has_only_bounds = problem.constraints.empty() && problem.variables.size() > 1;
  if (options.method == SearchMethod::kBobyqa && !has_only_bounds) {
    throw UsageError("optimiser bobyqa: two or more variables and no constraints are needed");
  }
  const bool uses_quadratic = options.method == SearchMethod::kBobyqa ||
                              (options.method != SearchMethod::kCobyla && has_only_bounds);

  Candidates candidates(problem, options.evaluations, progress);
  std::vector<double> start;
  for (const SearchVariable& variable : problem.variables) start.push_back(variable.start);
  std::vector<double> x = place_of(problem.variables, start);
  SearchResult result;
  bool has_ended = true;
  try {
    candidates.at(x);
    double low = 0.0, high = 1.0;
    for (size_t i = 0; i < x.size(); ++i) {
      for (const double end : {1.0, 0.0}) {
        std::vector<double> far = x;
        far[i] = candidates.reach(x, i, end);
        candidates.at(far);
        if (x.size() == 1) (end == 1.0 ? high : low) = far[i];
      }
    }
    if (options.method == SearchMethod::kDirect) {
      candidates.limit(std::max(2, options.evaluations / 2));
      run(nlopt::GN_DIRECT_L, problem, options, candidates, x, low, high);
      candidates.limit(options.evaluations);
    }
    if (const auto best = candidates.best()) {
      x = place_of(problem.variables, candidates.history()[*best].values);
      for (double& one : x) one = std::clamp(one, low, high);
    }
    has_ended = run(uses_quadratic ? nlopt::LN_BOBYQA : nlopt::LN_COBYLA, problem, options,
                    candidates, x, low, high);
  } catch (const BudgetSpent&) {
    has_ended = false;
  }
  int major = 0, minor = 0, fix = 0;
  nlopt::version(major, minor, fix);
  result.method = fmt::format("{}{} (NLopt {}.{}.{})",
                              options.method == SearchMethod::kDirect ? "DIRECT-L, then " : "",
                              uses_quadratic ? "BOBYQA" : "COBYLA", major, minor, fix);
  result.ending = has_ended ? "converged" : "budget spent";
  result.best = candidates.best();
  result.history = std::move(candidates.history());
  progress.update(1.0, "searched");
  return result;
}

}  // namespace palmar::redesign
