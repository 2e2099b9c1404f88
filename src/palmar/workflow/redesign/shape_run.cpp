// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/shape_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"
#include "palmar/geometry/degrees.h"
#include "palmar/redesign/handle_wall.h"
#include "palmar/redesign/mould_release.h"

namespace palmar::workflow {
namespace {

/// Ranges of features that a search looks through unless it is told otherwise, in their units; of
/// width and depth shares of the start. Choices: what a hand closes round, and what still is a
/// fair handle.
struct UsualRange {
  const char* name;
  double lowest, highest;
};
constexpr double kThinnestShare = 0.8, kThickestShare = 1.25;
constexpr UsualRange kUsual[] = {
    {"squareness", 0.0, 0.6},   {"taper", -6.0, 6.0},     {"swell", 0.0, 6.0},
    {"waist", 0.0, 4.0},        {"egg", -0.2, 0.2},       {"palm_swell", 0.0, 5.0},
    {"finger_swell", 0.0, 4.0}, {"thumb_rest", 0.0, 2.0}, {"finger_grooves", 0.0, 3.0},
    {"turn", -30.0, 30.0},      {"twist", -20.0, 20.0}};

double read_number(const std::string& text, const std::string& words) {
  const std::optional<double> value = formats::parse_double(text);
  if (value && std::isfinite(*value)) return *value;
  throw UsageError(fmt::format(
      "setting \"vary\" \"{}\": \"{}\" is no number; a feature as width, with a range as "
      "width=28:40 or with a value as width=34 is required",
      words, text));
}

constexpr double kLeastUndercut = 0.05;  // mm; what plastic gives way to as it leaves a mould
constexpr double kSure = 0.95;           // one-sided; that a candidate is worse
constexpr double kWorthStopping = 1.5;   // times as many hands have to be there in all

}  // namespace

void ShapeLimits::check() const {
  CandidateLimits::check();
  if (largest_change) {
    require_setting(*largest_change > 0.0, "largest change", *largest_change, "above 0 mm");
  }
  if (smallest_wall) {
    require_setting(*smallest_wall >= 0.0 && *smallest_wall <= 50.0, "smallest wall",
                    *smallest_wall, "0 to 50 mm");
  }
  constexpr double kMostDraft = 0.5236;  // 30 degrees
  require_setting(draft >= 0.0 && draft <= kMostDraft, "draft", draft / geometry::kDegree,
                  "0 to 30 degrees");
  require_setting(land >= 0.0, "draft land", land, "0 mm or more");
  require_setting(smallest_radius >= 0.0, "smallest radius", smallest_radius, "0 mm or more");
  if (kept_ends) {
    require_setting(*kept_ends >= 0.0 && *kept_ends <= 200.0, "kept ends", *kept_ends,
                    "0 to 200 mm");
  }
}

void HoldSpread::check() const {
  require_setting(places >= 2 && places <= 20, "places", places, "2 to 20");
  require_setting(along >= 0.0 && along <= 30.0, "spread along", along, "0 to 30 mm");
  require_setting(turn >= 0.0 && turn <= 1.0, "spread of the turn", turn, "0 to 1 rad");
}

ShapeVariable shape_variable(const std::string& words, const redesign::HandleFeatures& start) {
  const std::size_t equals = words.find('=');
  ShapeVariable variable{.feature = &redesign::handle_feature(words.substr(0, equals))};
  const redesign::HandleFeature& feature = *variable.feature;
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

void ShapeRun::hold_original(const HoldSpread& spread, const Progress& progress) {
  for (ShapeUse& use : uses) {
    use.offsets = spread_offsets(spread.places, spread.along, spread.turn);
    use.hold_original(goal, progress);
  }
}

redesign::HandleShape ShapeRun::shape_of(const std::vector<double>& varying) const {
  redesign::HandleShape shape = start;
  std::size_t next = 0;
  for (const ShapeVariable& one : variables) {
    const double value = one.lowest < one.highest ? varying.at(next++) : one.lowest;
    shape.features.*one.feature->value = value / one.feature->scale;
  }
  redesign::check(shape.features);
  return shape;
}

std::vector<redesign::SearchConstraint> ShapeRun::constraints() const {
  std::vector<redesign::SearchConstraint> all = {
      {"smallest radius round the handle", "mm", limits.smallest_radius, false}};
  if (limits.largest_change) {
    all.push_back({"largest change of the surface", "mm", *limits.largest_change, true});
  }
  if (limits.smallest_wall) {
    all.push_back({"wall over the hollow", "mm", *limits.smallest_wall, false});
  }
  if (limits.pull) {
    all.push_back({"undercut against the mould's pull", "mm", kLeastUndercut, true});
    all.push_back({"height that leans less than the draft angle", "mm", limits.land, true});
  }
  for (const redesign::SearchConstraint& one : limits.on_volume()) all.push_back(one);
  all.push_back(limits.on_lost_hands());
  return all;
}

std::vector<double> ShapeRun::values_of(const redesign::HandleShape& shape,
                                        const redesign::ShapeChange& change,
                                        double lost_share) const {
  std::vector<double> values = {change.smallest_radius};
  if (limits.largest_change) values.push_back(change.largest);
  if (limits.smallest_wall) {
    values.push_back(
        redesign::thinnest_wall(shape).value_or(std::numeric_limits<double>::infinity()));
  }
  if (limits.pull) {
    const redesign::MouldRelease release =
        redesign::mould_release(shape, *limits.pull, limits.draft);
    values.push_back(release.undercut);
    values.push_back(release.steep_height);
  }
  for (const double ratio : limits.volumes(change.volume_ratio)) values.push_back(ratio);
  values.push_back(lost_share);
  return values;
}

redesign::SearchOutcome ShapeRun::assess(const redesign::HandleShape& shape,
                                         std::optional<redesign::GoalFigure>& lead,
                                         SearchStory::Beside& beside,
                                         const Progress& progress) const {
  const product::Product candidate =
      redesign::shaped_product(uses.front().original.product(), shape, "candidate");
  const Progress quiet = silent(progress);
  /// One use's hands on the candidate.
  struct Held {
    OffsetGrasps grasps;
    std::vector<study::StudyRecord> after = {};
  };
  std::vector<std::unique_ptr<Held>> held;
  int all = 0, first = 0;
  for (const ShapeUse& use : uses) {
    held.push_back(std::unique_ptr<Held>(
        new Held{.grasps = OffsetGrasps({.original = use.original,
                                         .shapes = {{candidate, 1}},
                                         .offsets = use.offsets,
                                         .with_indices = redesign::needs_indices(goal)})}));
    all += use.hand_count();
    first += std::min(use.first_hands(), use.hand_count());
  }
  std::vector<redesign::GoalFigure> figures(uses.size());
  double grip_force = 0.0;
  const auto take = [&](bool only_first, bool goes_on) {
    grip_force = 0.0;
    for (std::size_t u = 0; u < uses.size(); ++u) {
      const ShapeUse& use = uses[u];
      const int hands =
          only_first ? std::min(use.first_hands(), use.hand_count()) : use.hand_count();
      const int from = goes_on ? std::min(use.first_hands(), use.hand_count()) : 0;
      use.grasp(held[u]->grasps, from, hands, held[u]->after, quiet);
      const study::StudyResults results = use.results_with(held[u]->after, hands);
      figures[u] = redesign::goal_of(results, goal, 1);
      grip_force += use.weight * redesign::mean_ratio(results, "grip_force_n", 1);
    }
    return figure_of_uses(uses, figures);
  };
  const bool may_stop = lead && goal.statistic == redesign::FeatureGoal::Statistic::kMean &&
                        all >= kWorthStopping * first;
  redesign::GoalFigure figure = take(may_stop, false);
  redesign::SearchOutcome outcome;
  if (may_stop) {
    const std::size_t count = figure.values.size();
    const redesign::GoalFigure of_lead = redesign::first_of(*lead, count),
                               now = redesign::first_of(figure, count);
    if (redesign::is_worse(goal, of_lead, now, kSure)) {
      const redesign::GoalChange change = redesign::goal_change(of_lead, now);
      outcome.goal = lead->value * (1.0 + change.share);
      outcome.goal_error = std::abs(lead->value) * change.error;
      outcome.roughness = static_cast<double>(all) / first;
    } else {
      figure = take(false, true);
    }
  }
  if (!outcome.is_rough()) {
    outcome.goal = figure.value;
    outcome.goal_error = figure.error;
  }
  const redesign::ShapeChange change = redesign::shape_change(shape);
  beside = {.hands = figure.hands,
            .lost = figure.lost,
            .grip_force_ratio = grip_force,
            .volume_ratio = change.volume_ratio,
            .largest_change = change.largest,
            .figure = figure,
            .by_use = {}};
  if (uses.size() > 1 && !outcome.is_rough()) {
    for (std::size_t u = 0; u < uses.size(); ++u) {
      beside.by_use.push_back(figures[u].value / uses[u].figure.value);
    }
  }
  const double lost_share = static_cast<double>(figure.lost) / figure.hands;
  outcome.constraint = values_of(shape, change, lost_share);
  const bool is_better =
      !lead || (goal.is_lower_better ? figure.value < lead->value : figure.value > lead->value);
  if (!outcome.is_rough() && is_better && lost_share <= limits.lost_hands) lead = figure;
  return outcome;
}

SearchStory ShapeRun::search(const redesign::SearchOptions& options,
                             const Progress& progress) const {
  SearchStory story{.settings = {},
                    .problem = {},
                    .goal = goal_of_uses(goal, uses.size()),
                    .result = {},
                    .original = {},
                    .beside = {}};
  if (uses.size() > 1) {
    for (const ShapeUse& one : uses) story.uses.push_back(one.name);
  }
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
    const redesign::HandleShape shape = shape_of(values);
    return redesign::SearchOutcome{
        .failure = "",
        .constraint = values_of(shape, redesign::shape_change(shape),
                                std::numeric_limits<double>::quiet_NaN())};
  };
  std::vector<redesign::GoalFigure> originals;
  for (const ShapeUse& one : uses) originals.push_back(one.figure);
  story.original = figure_of_uses(uses, originals);
  std::optional<redesign::GoalFigure> lead;
  run_search(
      story,
      [&](const std::vector<double>& values, SearchStory::Beside& beside) {
        return assess(shape_of(values), lead, beside, progress);
      },
      options, progress);
  return story;
}

}  // namespace palmar::workflow
