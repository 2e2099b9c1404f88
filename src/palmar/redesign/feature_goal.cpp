// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/feature_goal.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/grasp/indices/grasp_index.h"
#include "palmar/statistics/distributions.h"
#include "palmar/statistics/summary.h"
#include "palmar/study/assessment/held_torque.h"

namespace palmar::redesign {
namespace {

constexpr double kPercentile = 0.95;

const std::map<std::string, std::string>& short_names() {
  static const std::map<std::string, std::string> names = {
      {"peak", "peak_pressure_cells_mpa"},  {"mean", "mean_pressure_mpa"},
      {"stability", "epsilon_l1"},          {"discomfort", "discomfort_onset_percent"},
      {"torque", study::kHeldTorqueKey},    {"strength", "grip_strength_needed_n"},
      {"effort", "flexion_strength_in_use"}};
  return names;
}

struct Known {
  std::string key, name, unit;
  grasp::Better better = grasp::Better::kNeither;
};

std::vector<Known> known_quantities() {
  std::vector<Known> all;
  for (const study::StudyQuantity& one : study::hand_quantities()) {
    all.push_back({one.key, one.name, one.unit, one.better});
  }
  for (const grasp::GraspIndex& one : study::index_catalogue()) {
    all.push_back({one.key, one.name, one.unit, one.better});
  }
  return all;
}

/// Values of one hand with both products, those of the second only if it is held.
struct Pair {
  double original = 0.0;
  std::optional<double> product;
};

std::vector<Pair> pairs_of(const study::StudyResults& results, const std::string& key, int product,
                           int original) {
  std::vector<Pair> pairs;
  for (const study::StudyCondition& condition : study::conditions_of(results.plan)) {
    if (condition.population) continue;  // the first ones cover all populations
    for (const int hand : study::hands_of(results.plan, condition)) {
      const study::StudyRecord* const first = study::record_of(results, condition, original, hand);
      const study::StudyRecord* const second = study::record_of(results, condition, product, hand);
      if (first == nullptr) continue;
      const std::optional<double> was = study::quantity_of(*first, key);
      if (!was || !std::isfinite(*was)) continue;
      pairs.push_back({*was, second == nullptr ? std::nullopt : study::quantity_of(*second, key)});
    }
  }
  return pairs;
}

}  // namespace

FeatureGoal feature_goal(const std::string& words) {
  FeatureGoal goal;
  const size_t colon = words.find(':');
  const std::string what = words.substr(0, colon);
  const auto short_name = short_names().find(what);
  goal.key = short_name == short_names().end() ? what : short_name->second;
  std::vector<std::string> names;
  std::optional<Known> quantity;
  for (const Known& one : known_quantities()) {
    names.push_back(one.key);
    if (one.key == goal.key) quantity = one;
  }
  for (const auto& [name, key] : short_names()) names.push_back(name);
  if (!quantity) {
    const std::string nearest = nearest_name(what, names);
    throw UsageError(
        fmt::format("goal \"{}\" is not known{}; peak, mean, discomfort, torque, strength, "
                    "effort, stability or the key of a quantity",
                    what, nearest.empty() ? "" : "; did you mean " + nearest + "?"));
  }
  if (quantity->better == grasp::Better::kNeither) {
    throw UsageError(
        fmt::format("goal \"{}\": {} is neither better higher nor lower", what, quantity->name));
  }
  goal.is_lower_better = quantity->better == grasp::Better::kDown;
  goal.unit = quantity->unit;
  goal.name = "mean of " + quantity->name;
  if (colon == std::string::npos) return goal;

  const std::string rest = words.substr(colon + 1);
  if (rest == "p95") {
    goal.statistic = FeatureGoal::Statistic::kP95;
    goal.name = "95th percentile of " + quantity->name;
    return goal;
  }
  constexpr std::string_view kAbove = "above=";
  const char* const end = rest.data() + rest.size();
  if (rest.rfind(kAbove, 0) == 0) {
    const auto [at, error] = std::from_chars(rest.data() + kAbove.size(), end, goal.threshold);
    if (error == std::errc() && at == end && std::isfinite(goal.threshold)) {
      goal.statistic = FeatureGoal::Statistic::kShareAbove;
      goal.name = fmt::format("share of hands with {} above {:.4g}{}{}", quantity->name,
                              goal.threshold, goal.unit.empty() ? "" : " ", goal.unit);
      goal.unit.clear();
      return goal;
    }
  }
  throw UsageError(
      fmt::format("goal \"{}\": behind the colon p95 or above=NUMBER is allowed", words));
}

bool is_index(const std::string& key) {
  return std::none_of(study::hand_quantities().begin(), study::hand_quantities().end(),
                      [&](const study::StudyQuantity& one) { return one.key == key; });
}

bool needs_indices(const FeatureGoal& goal) { return is_index(goal.key); }

GoalFigure goal_of(const study::StudyResults& results, const FeatureGoal& goal, int product,
                   int original) {
  const std::vector<Pair> pairs = pairs_of(results, goal.key, product, original);
  if (pairs.empty()) {
    throw UsageError(fmt::format("goal {}: no hand has a value of it with the original", goal.key));
  }
  double worst = pairs.front().original;
  for (const Pair& pair : pairs) {
    worst = goal.is_lower_better ? std::max(worst, pair.original) : std::min(worst, pair.original);
  }
  GoalFigure figure;
  std::vector<double> values;
  for (const Pair& pair : pairs) {
    const bool is_lost = !pair.product || !std::isfinite(*pair.product);
    figure.lost += is_lost ? 1 : 0;
    const double value = is_lost ? worst : *pair.product;
    const bool is_above = is_lost ? goal.is_lower_better : value > goal.threshold;
    values.push_back(goal.statistic == FeatureGoal::Statistic::kShareAbove ? (is_above ? 1.0 : 0.0)
                                                                           : value);
  }
  figure.hands = static_cast<int>(pairs.size());
  figure.values = values;
  if (goal.statistic == FeatureGoal::Statistic::kP95) {
    std::sort(values.begin(), values.end());
    figure.value = statistics::quantile(values, kPercentile);
    return figure;
  }
  const statistics::Summary summary = statistics::summarise(values);
  figure.value = summary.mean;
  figure.error = summary.standard_error;
  return figure;
}

GoalChange goal_change(const GoalFigure& from, const GoalFigure& to) {
  if (from.values.size() != to.values.size() || from.values.empty()) {
    throw UsageError(fmt::format("goals of {} and {} hands can't be compared", from.values.size(),
                                 to.values.size()));
  }
  if (from.value == 0.0) return {};
  std::vector<double> differences;
  for (size_t i = 0; i < from.values.size(); ++i) {
    differences.push_back(to.values[i] - from.values[i]);
  }
  return {(to.value - from.value) / from.value,
          statistics::summarise(differences).standard_error / std::abs(from.value)};
}

bool is_worse(const FeatureGoal& goal, const GoalFigure& than, const GoalFigure& figure,
              double level) {
  const GoalChange change = goal_change(than, figure);
  if (figure.values.size() < 2) return false;
  const double worse = goal.is_lower_better ? change.share : -change.share;
  return worse >
         statistics::student_quantile(level, static_cast<double>(figure.values.size()) - 1.0) *
             change.error;
}

GoalFigure first_of(const GoalFigure& figure, std::size_t count) {
  GoalFigure first = figure;
  first.values.resize(std::min(count, figure.values.size()));
  first.hands = static_cast<int>(first.values.size());
  if (first.values.empty()) return first;
  const statistics::Summary summary = statistics::summarise(first.values);
  first.value = summary.mean;
  first.error = summary.standard_error;
  return first;
}

double mean_ratio(const study::StudyResults& results, const std::string& key, int product,
                  int original) {
  double first = 0.0, second = 0.0;
  for (const Pair& pair : pairs_of(results, key, product, original)) {
    if (!pair.product) continue;
    first += pair.original;
    second += *pair.product;
  }
  return first > 0.0 ? second / first : 0.0;
}

}  // namespace palmar::redesign
