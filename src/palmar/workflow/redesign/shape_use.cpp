// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/shape_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"
#include "palmar/records/study/study_file.h"
#include "palmar/statistics/summary.h"

namespace palmar::workflow {
namespace {

constexpr int kFirstOfPlace = 2;  // hands that hold a candidate before it may be given up

[[noreturn]] void refuse(const std::string& words, const std::string& why) {
  throw UsageError(fmt::format("setting \"use\" \"{}\": {}", words, why));
}

double number_of_use(const std::string& words, const std::string& key, const std::string& value,
                     double lowest, double highest) {
  const std::optional<double> number = formats::parse_double(value);
  if (!number || !(*number >= lowest && *number <= highest)) {
    refuse(words,
           fmt::format("{} is \"{}\"; {:g} to {:g} is allowed", key, value, lowest, highest));
  }
  return *number;
}

}  // namespace

ShapeUseRequest shape_use(const std::string& words, const RedesignRequest& usual) {
  ShapeUseRequest use{.name = words, .asked = usual};
  std::vector<std::string> populations;
  std::istringstream text(words);
  std::string one;
  while (text >> one) {
    const std::size_t equals = one.find('=');
    const std::string key = one.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : one.substr(equals + 1);
    if (key == "weight") {
      use.weight = number_of_use(words, key, value, 1e-3, 1e3);
    } else if (key == "grip-force-n") {
      use.asked.grip_force = number_of_use(words, key, value, 1.0, 500.0);
    } else if (key == "hands") {
      use.asked.hands = static_cast<int>(std::lround(number_of_use(words, key, value, 1.0, 1e5)));
    } else if (key == "population" && !value.empty()) {
      populations.push_back(value);
    } else if (key == "grip" && !value.empty()) {
      use.asked.grips = {records::asked_grip_named(value)};
    } else if (key == "hand" && (value == "left" || value == "right")) {
      use.asked.is_left = value == "left";
    } else {
      refuse(words, fmt::format("\"{}\" is not known; weight=, grip-force-n=, grip=, population=, "
                                "hands=, hand=left and hand=right are allowed",
                                one));
    }
  }
  if (!populations.empty()) use.asked.populations = populations;
  return use;
}

int ShapeUse::first_hands() const { return kFirstOfPlace * static_cast<int>(offsets.size()); }

void ShapeUse::hold_original(const redesign::FeatureGoal& goal, const Progress& progress) {
  OffsetGrasps grasps({.original = original,
                       .shapes = {{original.product(), 0}},
                       .offsets = offsets,
                       .with_indices = redesign::needs_indices(goal)});
  before.clear();
  grasp(grasps, 0, hand_count(), before, progress);
  figure = redesign::goal_of(results_with({}, hand_count()), goal, 0);
  const int first = std::min(first_hands(), hand_count());
  first_values = redesign::goal_of(results_with({}, first), goal, 0).values.size();
}

void ShapeUse::grasp(OffsetGrasps& grasps, int from, int to,
                     std::vector<study::StudyRecord>& records, const Progress& progress) const {
  const auto is_wanted = [&](int hand, std::size_t offset) {
    return hand >= from && hand < to && static_cast<std::size_t>(hand) % offsets.size() == offset;
  };
  for (const auto& those : grasps.of(is_wanted, progress)) {
    records.insert(records.end(), those.begin(), those.end());
  }
}

study::StudyResults ShapeUse::results_with(const std::vector<study::StudyRecord>& after,
                                           int hands) const {
  study::StudyResults results{.plan = plan_of_two(original), .records = {}};
  for (const auto* const those : {&before, &after}) {
    for (const study::StudyRecord& record : *those) {
      if (study::task_at(results.plan, record.number).hand < hands)
        results.records.push_back(record);
    }
  }
  std::sort(
      results.records.begin(), results.records.end(),
      [](const study::StudyRecord& a, const study::StudyRecord& b) { return a.number < b.number; });
  return results;
}

redesign::GoalFigure figure_of_uses(const std::vector<ShapeUse>& uses,
                                    const std::vector<redesign::GoalFigure>& figures) {
  if (figures.size() == 1) return figures.front();
  redesign::GoalFigure all;
  std::vector<double> others;
  for (std::size_t u = 0; u < figures.size(); ++u) {
    const redesign::GoalFigure& one = figures[u];
    const double original = uses[u].figure.value;
    if (original == 0.0) {
      throw UsageError(fmt::format(
          "setting \"use\" \"{}\": the goal is 0 with the original; no share of it can be taken",
          uses[u].name));
    }
    all.value += uses[u].weight * one.value / original;
    all.hands += one.hands;
    all.lost += one.lost;
    const double each = uses[u].weight * static_cast<double>(uses.size()) / original;
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      (i < uses[u].first_values ? all.values : others).push_back(each * one.values[i]);
    }
    // At most: people may be the same in several uses.
    all.error += uses[u].weight * one.error / original;
  }
  all.values.insert(all.values.end(), others.begin(), others.end());
  return all;
}

redesign::FeatureGoal goal_of_uses(const redesign::FeatureGoal& goal, std::size_t uses) {
  if (uses == 1) return goal;
  redesign::FeatureGoal all = goal;
  all.name = goal.name + " over the original's, by the weights of all uses";
  all.unit = "";
  return all;
}

}  // namespace palmar::workflow
