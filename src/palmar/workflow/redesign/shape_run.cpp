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

void require(bool holds, const char* field, double value, const char* allowed) {
  if (holds) return;
  throw UsageError(fmt::format("setting \"{}\" is {:g}; {} is allowed", field, value, allowed));
}

}  // namespace

void ShapeLimits::check() const {
  if (largest_change) {
    require(*largest_change > 0.0, "largest change", *largest_change, "above 0 mm");
  }
  if (smallest_volume) {
    require(*smallest_volume > 0.0, "smallest volume", *smallest_volume, "above 0");
  }
  if (largest_volume) {
    require(*largest_volume > 0.0, "largest volume", *largest_volume, "above 0");
  }
  require(smallest_radius >= 0.0, "smallest radius", smallest_radius, "0 mm or more");
  require(lost_hands >= 0.0 && lost_hands <= 1.0, "lost hands", lost_hands, "0 to 1");
  require(kept_ends >= 0.0 && kept_ends <= 200.0, "kept ends", kept_ends, "0 to 200 mm");
}

void HoldSpread::check() const {
  require(places >= 2 && places <= 20, "places", places, "2 to 20");
  require(along >= 0.0 && along <= 30.0, "spread along", along, "0 to 30 mm");
  require(turn >= 0.0 && turn <= 1.0, "spread of the turn", turn, "0 to 1 rad");
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

std::function<bool(int, std::size_t)> ShapeRun::own_place() const {
  return [n = offsets.size()](int hand, std::size_t offset) {
    return static_cast<std::size_t>(hand) % n == offset;
  };
}

void ShapeRun::hold_original(const Progress& progress) {
  offsets = spread_offsets(spread.places, spread.along, spread.turn);
  before.clear();
  for (auto& those : grasp_at_offsets({.original = original,
                     .product = original.product(),
                     .offsets = offsets,
                     .is_wanted = own_place(),
                     .with_indices = needs_indices(goal),
                     .as = 0},
                                      progress)) {
    before.insert(before.end(), those.begin(), those.end());
  }
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
  if (limits.smallest_volume) {
    all.push_back({"volume by the original's", "", *limits.smallest_volume, false});
  }
  if (limits.largest_volume) {
    all.push_back({"volume by the original's", "", *limits.largest_volume, true});
  }
  all.push_back({"share of hands that lose hold", "", limits.lost_hands, true});
  return all;
}

std::vector<double> ShapeRun::values_of(const ShapeChange& change, double lost_share) const {
  std::vector<double> values = {change.smallest_radius};
  if (limits.largest_change) values.push_back(change.largest);
  if (limits.smallest_volume) values.push_back(change.volume_ratio);
  if (limits.largest_volume) values.push_back(change.volume_ratio);
  values.push_back(lost_share);
  return values;
}

StudyResults ShapeRun::results_with(std::vector<StudyRecord> after) const {
  StudyResults results{.plan = plan_of_two(original), .records = before};
  results.records.insert(results.records.end(), after.begin(), after.end());
  std::sort(results.records.begin(), results.records.end(),
            [](const StudyRecord& a, const StudyRecord& b) { return a.number < b.number; });
  return results;
}

SearchOutcome ShapeRun::assess(const HandleShape& shape, SearchStory::Beside& beside,
                               const Progress& progress) const {
  const Product candidate = shaped_product(original.product(), shape, "candidate");
  std::vector<StudyRecord> after;
  for (auto& those : grasp_at_offsets({.original = original,
                     .product = candidate,
                     .offsets = offsets,
                     .is_wanted = own_place(),
                     .with_indices = needs_indices(goal),
                     .as = 1},
                                      silent(progress))) {
    after.insert(after.end(), those.begin(), those.end());
  }
  const StudyResults results = results_with(std::move(after));
  const GoalFigure figure = goal_of(results, goal, 1);
  const ShapeChange change = shape_change(shape);
  beside = {.hands = figure.hands,
            .lost = figure.lost,
            .grip_force_ratio = mean_ratio(results, "grip_force_n", 1),
            .volume_ratio = change.volume_ratio,
            .largest_change = change.largest,
            .figure = figure};
  return {.failure = "",
          .goal = figure.value,
          .goal_error = figure.error,
          .constraint = values_of(change, static_cast<double>(figure.lost) / figure.hands)};
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
  story.problem.evaluate = [&](const std::vector<double>& values) {
    story.beside.emplace_back();
    return assess(shape_of(values), story.beside.back(), progress);
  };
  story.problem.measure = [&](const std::vector<double>& values) {
    return SearchOutcome{.failure = "",
                         .constraint = values_of(shape_change(shape_of(values)),
                                                 std::numeric_limits<double>::quiet_NaN())};
  };
  story.original = goal_of(results_with({}), goal, 0);
  story.result = story.problem.variables.empty()
                     ? as_given(story.problem)
                     : search_features(story.problem, options, progress);
  return story;
}

}  // namespace palmar
