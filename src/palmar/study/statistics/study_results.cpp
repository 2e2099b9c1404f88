// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/study_results.h"

#include <algorithm>
#include <numeric>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"

namespace palmar::study {
namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

std::optional<double> hand_value(const StudyRecord& record, const std::string& key) {
  if (key == "force_n") return record.force;
  // 0 where it isn't known: not at rest, no load.
  const auto above_0 = [](double value) {
    return value > 0.0 ? std::optional(value) : std::nullopt;
  };
  if (key == "grip_force_n") return above_0(record.grip_force);
  if (key == "contact_area_mm2") return record.area;
  if (key == "peak_pressure_mpa") return record.peak_pressure;
  if (key == "peak_pressure_cells_mpa") return record.peak_pressure_cells;
  if (key == "mean_pressure_mpa") return record.mean_pressure;
  if (key == "range_share_needed") return record.demand.range_share;
  if (key == "grip_strength_needed_n") return above_0(record.demand.grip_strength);
  if (key == "nail_room_mm") return record.demand.nail_room;
  return std::nullopt;
}

StudyQuantity described(const std::string& key) {
  for (const grasp::GraspIndex& row : index_catalogue()) {
    if (row.key == key) return {key, row.name, row.unit, row.better};
  }
  return {key, key, "", grasp::Better::kNeither};
}

}  // namespace

void StudyResults::check() const {
  const std::int64_t tasks = task_count(plan);
  for (std::size_t i = 0; i < records.size(); ++i) {
    const std::int64_t number = records[i].number;
    if (number < 0 || number >= tasks) {
      throw UsageError("study results: record of task " + std::to_string(number) +
                       " in a plan of " + std::to_string(tasks) + " tasks");
    }
    if (i > 0 && records[i - 1].number >= number) {
      throw UsageError("study results: record of task " + std::to_string(number) +
                       " comes after that of task " + std::to_string(records[i - 1].number) +
                       "; ascending numbers are required");
    }
  }
}

bool is_same(const StudyCondition& a, const StudyCondition& b) {
  return a.population == b.population && a.profile == b.profile && a.setting == b.setting &&
         a.grip == b.grip;
}

std::vector<StudyCondition> conditions_of(const StudyPlan& plan) {
  std::vector<StudyCondition> conditions;
  const auto populations = static_cast<int>(plan.populations.size());
  for (int profile = 0; profile < static_cast<int>(plan.profiles.size()); ++profile) {
    for (int setting = 0; setting < static_cast<int>(plan.settings.size()); ++setting) {
      for (int grip = 0; grip < static_cast<int>(plan.grips.size()); ++grip) {
        conditions.push_back({std::nullopt, profile, setting, grip});
        for (int p = 0; populations > 1 && p < populations; ++p) {
          conditions.push_back({p, profile, setting, grip});
        }
      }
    }
  }
  return conditions;
}

std::string title_of(const StudyPlan& plan, const StudyCondition& condition) {
  const auto title_of_population = [](const population::Population& one) {
    return one.title.empty() ? one.name : one.title;
  };
  std::string title;
  if (condition.population) {
    title = title_of_population(plan.populations[index(*condition.population)].population);
  } else if (plan.populations.size() == 1) {
    title = title_of_population(plan.populations.front().population);
  } else {
    title = "all populations";
  }
  if (plan.profiles.size() > 1) {
    std::string name = plan.profiles[index(condition.profile)].name;
    std::replace(name.begin(), name.end(), '_', ' ');
    title += name == "none" ? ", no restriction" : ", " + name;
  }
  if (plan.settings.size() > 1) title += ", " + plan.settings[index(condition.setting)].name;
  if (plan.grips.size() > 1) {
    const std::optional<grasp::Grip>& grip = plan.grips[index(condition.grip)];
    title += ", " + (grip ? std::string(name_of(*grip)) : std::string("power grip by shape"));
  }
  return title;
}

std::vector<int> hands_of(const StudyPlan& plan, const StudyCondition& condition) {
  std::vector<int> hands;
  for (int h = 0; h < static_cast<int>(plan.hands.size()); ++h) {
    if (!condition.population || plan.hands[index(h)].population == *condition.population) {
      hands.push_back(h);
    }
  }
  return hands;
}

const StudyRecord* record_of(const StudyResults& results, const StudyCondition& condition,
                             int product, int hand) {
  const std::int64_t number = number_of(
      results.plan, {hand, condition.profile, condition.setting, product, condition.grip});
  const auto found = std::lower_bound(
      results.records.begin(), results.records.end(), number,
      [](const StudyRecord& record, std::int64_t wanted) { return record.number < wanted; });
  return found != results.records.end() && found->number == number ? &*found : nullptr;
}

bool is_in_hand(const StudyRecord& record) {
  return (record.outcome == StudyOutcome::kHeld || record.outcome == StudyOutcome::kPartlyHeld) &&
         record.force > 0.0;
}

std::optional<double> size_of(const StudyHand& hand, hand::HandDimension dimension) {
  for (const hand::SizedDimension& one : hand.sample.dimensions) {
    if (one.dimension == dimension) return one.value;
  }
  return std::nullopt;
}

std::optional<double> size_of(const StudyPlan& plan, const StudyCondition& condition, int hand,
                              hand::HandDimension dimension) {
  const std::optional<double> size = size_of(plan.hands[index(hand)], dimension);
  if (!size) return size;
  return *size * plan.profiles[index(condition.profile)].size_factor;
}

bool is_drawn_by_chance(const StudyPlan& plan) {
  return std::all_of(plan.populations.begin(), plan.populations.end(), [](const auto& one) {
    return one.sampling.design == population::SamplingDesign::kRandom ||
           one.sampling.design == population::SamplingDesign::kLatinHypercube;
  });
}

int OutcomeCounts::hands() const { return std::accumulate(of.begin(), of.end(), not_run); }

int OutcomeCounts::in_hand() const {
  return of[index_of(StudyOutcome::kHeld)] + of[index_of(StudyOutcome::kPartlyHeld)];
}

OutcomeCounts outcomes_of(const StudyResults& results, const StudyCondition& condition,
                          int product) {
  OutcomeCounts counts;
  for (const int hand : hands_of(results.plan, condition)) {
    const StudyRecord* record = record_of(results, condition, product, hand);
    if (record == nullptr) {
      ++counts.not_run;
    } else {
      ++counts.of[index_of(record->outcome)];
    }
  }
  return counts;
}

const std::vector<StudyQuantity>& hand_quantities() {
  static const std::vector<StudyQuantity> quantities = {
      {"peak_pressure_cells_mpa", "peak pressure on sensor cells", "MPa", grasp::Better::kDown},
      {"peak_pressure_mpa", "peak pressure at one vertex", "MPa", grasp::Better::kDown},
      {"mean_pressure_mpa", "mean pressure", "MPa", grasp::Better::kDown},
      {"contact_area_mm2", "contact area", "mm²", grasp::Better::kNeither},
      {"force_n", "sum of normal forces", "N", grasp::Better::kNeither},
      {"grip_force_n", "grip force", "N", grasp::Better::kNeither},
      {"range_share_needed", "share of the range of motion that the posture needs", "",
       grasp::Better::kDown},
      {"grip_strength_needed_n", "grip strength that holds the task's force", "N",
       grasp::Better::kDown},
      {"nail_room_mm", "longest nail that touches nothing", "mm", grasp::Better::kUp}};
  return quantities;
}

std::vector<StudyQuantity> quantities_of(const StudyResults& results) {
  std::vector<StudyQuantity> found;
  for (const StudyQuantity& one : hand_quantities()) {
    const bool is_known =
        std::any_of(results.records.begin(), results.records.end(), [&](const StudyRecord& record) {
          return is_in_hand(record) && hand_value(record, one.key).value_or(0.0) != 0.0;
        });
    // How firmly comes first: everything else is to be read at that force.
    if (is_known) found.insert(one.key == "grip_force_n" ? found.begin() : found.end(), one);
  }
  std::vector<std::string> seen;
  for (const StudyQuantity& one : hand_quantities()) seen.push_back(one.key);
  for (const StudyRecord& record : results.records) {
    if (!is_in_hand(record)) continue;
    for (const IndexRecord& one : record.indices) {
      if (std::find(seen.begin(), seen.end(), one.key) != seen.end()) continue;
      seen.push_back(one.key);
      found.push_back(described(one.key));
    }
  }
  return found;
}

std::optional<double> quantity_of(const StudyRecord& record, const std::string& key) {
  if (!is_in_hand(record)) return std::nullopt;
  const std::vector<StudyQuantity>& own = hand_quantities();
  if (std::any_of(own.begin(), own.end(), [&](const auto& one) { return one.key == key; })) {
    return hand_value(record, key);
  }
  for (const IndexRecord& one : record.indices) {
    if (one.key == key) return one.value;
  }
  return std::nullopt;
}

StudyQuantity quantity_named(const StudyResults& results, const std::string& key) {
  const std::vector<StudyQuantity> known = quantities_of(results);
  for (const StudyQuantity& one : known) {
    if (one.key == key) return one;
  }
  for (const StudyQuantity& one : hand_quantities()) {
    if (one.key == key) return one;
  }
  std::vector<std::string> keys;
  for (const StudyQuantity& one : known) keys.push_back(one.key);
  const std::string nearest = nearest_name(key, keys);
  throw UsageError("quantity \"" + key + "\" is not in this study" +
                   (nearest.empty() ? "; it has, among others, peak_pressure_cells_mpa, force_n, "
                                      "contact_area_mm2"
                                    : "; did you mean " + nearest + "?"));
}

}  // namespace palmar::study
