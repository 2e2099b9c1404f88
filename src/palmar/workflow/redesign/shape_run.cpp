// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/shape_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar {
namespace {

/// Ranges of features that a search looks through unless it is told otherwise, in their units; of
/// width and depth shares of the start. Choices: what a hand closes round, and what still is a
/// fair handle.
struct UsualRange {
  const char* name;
  double lowest, highest;
};
constexpr double kThinnestShare = 0.8, kThickestShare = 1.25;
constexpr UsualRange kUsual[] = {{"squareness", 0.0, 0.6},   {"taper", -6.0, 6.0},
                                 {"swell", 0.0, 6.0},        {"waist", 0.0, 4.0},
                                 {"egg", -0.2, 0.2},         {"palm_swell", 0.0, 5.0},
                                 {"finger_swell", 0.0, 4.0}, {"thumb_rest", 0.0, 2.0},
                                 {"turn", -30.0, 30.0},      {"twist", -20.0, 20.0}};

double read_number(const std::string& text, const std::string& words) {
  const std::optional<double> value = parse_double(text);
  if (value && std::isfinite(*value)) return *value;
  throw UsageError(fmt::format(
      "setting \"vary\" \"{}\": \"{}\" is no number; a feature as width, with a range as "
      "width=28:40 or with a value as width=34 is required",
      words, text));
}

constexpr int kFirstOfPlace = 2;        // hands that hold a candidate before it may be given up
constexpr double kSure = 0.95;          // one-sided; that a candidate is worse
constexpr double kWorthStopping = 1.5;  // times as many hands have to be there in all

}  // namespace

void ShapeLimits::check() const {
  CandidateLimits::check();
  if (largest_change) {
    require_setting(*largest_change > 0.0, "largest change", *largest_change, "above 0 mm");
  }
  require_setting(smallest_radius >= 0.0, "smallest radius", smallest_radius, "0 mm or more");
  require_setting(kept_ends >= 0.0 && kept_ends <= 200.0, "kept ends", kept_ends, "0 to 200 mm");
}

void HoldSpread::check() const {
  require_setting(places >= 2 && places <= 20, "places", places, "2 to 20");
  require_setting(along >= 0.0 && along <= 30.0, "spread along", along, "0 to 30 mm");
  require_setting(turn >= 0.0 && turn <= 1.0, "spread of the turn", turn, "0 to 1 rad");
}

ShapeVariable shape_variable(const std::string& words, const HandleFeatures& start) {
  const std::size_t equals = words.find('=');
  ShapeVariable variable{.feature = &handle_feature(words.substr(0, equals))};
  const HandleFeature& feature = *variable.feature;
  if (equals == std::string::npos) {
    const double now = feature.scale * start.*feature.value;
    variable.lowest = kThinnestShare * now;
    variable.highest = kThickestShare * now;
    for (const UsualRange& one : kUsual) {
      if (feature.name != one.name) continue;
      variable.lowest = one.lowest;
      variable.highest = one.highest;
    }
  } else {
    const std::string range = words.substr(equals + 1);
    const std::size_t colon = range.find(':');
    variable.lowest = read_number(range.substr(0, colon), words);
    variable.highest =
        colon == std::string::npos ? variable.lowest : read_number(range.substr(colon + 1), words);
  }
  if (variable.lowest > variable.highest || variable.lowest < feature.lowest ||
      variable.highest > feature.highest) {
    throw UsageError(fmt::format(
        "setting \"vary\" \"{}\": {:g} to {:g}{}{} are allowed, from the smaller to the larger",
        words, feature.lowest, feature.highest, feature.unit.empty() ? "" : " ", feature.unit));
  }
  return variable;
}

void ShapeRun::grasp(OffsetGrasps& grasps, int from, int to, std::vector<StudyRecord>& records,
                     const Progress& progress) const {
  const auto is_wanted = [&](int hand, std::size_t offset) {
    return hand >= from && hand < to && static_cast<std::size_t>(hand) % offsets.size() == offset;
  };
  for (const auto& those : grasps.of(is_wanted, progress)) {
    records.insert(records.end(), those.begin(), those.end());
  }
}

void ShapeRun::hold_original(const Progress& progress) {
  offsets = spread_offsets(spread.places, spread.along, spread.turn);
  OffsetGrasps grasps({.original = original,
                       .product = original.product(),
                       .offsets = offsets,
                       .with_indices = needs_indices(goal),
                       .as = 0});
  before.clear();
  grasp(grasps, 0, hand_count(), before, progress);
}

HandleShape ShapeRun::shape_of(const std::vector<double>& varying) const {
  HandleShape shape = start;
  std::size_t next = 0;
  for (const ShapeVariable& one : variables) {
    const double value = one.lowest < one.highest ? varying.at(next++) : one.lowest;
    shape.features.*one.feature->value = value / one.feature->scale;
  }
  check(shape.features);
  return shape;
}

std::vector<SearchConstraint> ShapeRun::constraints() const {
  std::vector<SearchConstraint> all = {
      {"smallest radius round the handle", "mm", limits.smallest_radius, false}};
  if (limits.largest_change) {
    all.push_back({"largest change of the surface", "mm", *limits.largest_change, true});
  }
  for (const SearchConstraint& one : limits.on_volume()) all.push_back(one);
  all.push_back(limits.on_lost_hands());
  return all;
}

std::vector<double> ShapeRun::values_of(const ShapeChange& change, double lost_share) const {
  std::vector<double> values = {change.smallest_radius};
  if (limits.largest_change) values.push_back(change.largest);
  for (const double ratio : limits.volumes(change.volume_ratio)) values.push_back(ratio);
  values.push_back(lost_share);
  return values;
}

StudyResults ShapeRun::results_with(const std::vector<StudyRecord>& after, int hands) const {
  StudyResults results{.plan = plan_of_two(original), .records = {}};
  for (const auto* const those : {&before, &after}) {
    for (const StudyRecord& record : *those) {
      if (task_at(results.plan, record.number).hand < hands) results.records.push_back(record);
    }
  }
  std::sort(results.records.begin(), results.records.end(),
            [](const StudyRecord& a, const StudyRecord& b) { return a.number < b.number; });
  return results;
}

SearchOutcome ShapeRun::assess(const HandleShape& shape, std::optional<GoalFigure>& lead,
                               SearchStory::Beside& beside, const Progress& progress) const {
  const Product candidate = shaped_product(original.product(), shape, "candidate");
  OffsetGrasps grasps({.original = original,
                       .product = candidate,
                       .offsets = offsets,
                       .with_indices = needs_indices(goal),
                       .as = 1});
  const Progress quiet = silent(progress);
  const int all = hand_count(), first = kFirstOfPlace * static_cast<int>(offsets.size());
  const bool may_stop =
      lead && goal.statistic == FeatureGoal::Statistic::kMean && all >= kWorthStopping * first;
  std::vector<StudyRecord> after;
  int hands = may_stop ? first : all;
  grasp(grasps, 0, hands, after, quiet);
  StudyResults results = results_with(after, hands);
  GoalFigure figure = goal_of(results, goal, 1);
  SearchOutcome outcome;
  if (may_stop) {
    const GoalFigure of_lead = first_of(*lead, figure.values.size());
    if (is_worse(goal, of_lead, figure, kSure)) {
      const GoalChange change = goal_change(of_lead, figure);
      outcome.goal = lead->value * (1.0 + change.share);
      outcome.goal_error = std::abs(lead->value) * change.error;
      outcome.roughness = static_cast<double>(all) / hands;
    } else {
      grasp(grasps, hands, all, after, quiet);
      hands = all;
      results = results_with(after, hands);
      figure = goal_of(results, goal, 1);
    }
  }
  if (!outcome.is_rough()) {
    outcome.goal = figure.value;
    outcome.goal_error = figure.error;
  }
  const ShapeChange change = shape_change(shape);
  beside = {.hands = figure.hands,
            .lost = figure.lost,
            .grip_force_ratio = mean_ratio(results, "grip_force_n", 1),
            .volume_ratio = change.volume_ratio,
            .largest_change = change.largest,
            .figure = figure};
  const double lost_share = static_cast<double>(figure.lost) / figure.hands;
  outcome.constraint = values_of(change, lost_share);
  const bool is_better =
      !lead || (goal.is_lower_better ? figure.value < lead->value : figure.value > lead->value);
  if (!outcome.is_rough() && is_better && lost_share <= limits.lost_hands) lead = figure;
  return outcome;
}

SearchStory ShapeRun::search(const SearchOptions& options, const Progress& progress) const {
  SearchStory story{
      .settings = {}, .problem = {}, .goal = goal, .result = {}, .original = {}, .beside = {}};
  for (const ShapeVariable& one : variables) {
    if (one.lowest >= one.highest) continue;
    FeatureSetting setting;
    setting.name = one.feature->name;
    setting.unit = one.feature->unit;
    setting.lowest = one.lowest;
    setting.highest = one.highest;
    story.settings.push_back(setting);
    const double now = one.feature->scale * start.features.*one.feature->value;
    story.problem.variables.push_back({setting.name, setting.unit, one.lowest, one.highest,
                                       std::clamp(now, one.lowest, one.highest),
                                       one.feature->step});
  }
  story.problem.constraints = constraints();
  story.problem.is_lower_better = goal.is_lower_better;
  story.problem.measure = [&](const std::vector<double>& values) {
    return SearchOutcome{.failure = "",
                         .constraint = values_of(shape_change(shape_of(values)),
                                                 std::numeric_limits<double>::quiet_NaN())};
  };
  story.original = goal_of(results_with({}, hand_count()), goal, 0);
  std::optional<GoalFigure> lead;
  run_search(
      story,
      [&](const std::vector<double>& values, SearchStory::Beside& beside) {
        return assess(shape_of(values), lead, beside, progress);
      },
      options, progress);
  return story;
}

}  // namespace palmar
