// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_plan.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <string>

#include "palmar/core/error.h"

namespace palmar::study {
namespace {

constexpr double kSmallestSize = 0.05, kLargestSize = 20.0;  // factors on a product's lengths
constexpr double kHeaviest = 100.0;                          // kg
constexpr double kLargestGripForce = 5000.0;                 // N
constexpr double kDeepest = 15.0;                            // mm; skin deeper carries no force

std::int64_t size_of(const auto& list) { return static_cast<std::int64_t>(list.size()); }

void check_between(const std::string& what, const std::string& field, double value, double lowest,
                   double highest, const std::string& unit = "") {
  if (value >= lowest && value <= highest) return;
  const std::string blank = unit.empty() ? "" : " ";
  throw UsageError(fmt::format("{}: {} is {:g}{}{}; {:g} to {:g}{}{} is allowed", what, field,
                               value, blank, unit, lowest, highest, blank, unit));
}

template <typename List>
void check_some(const List& list, const std::string& what) {
  if (list.empty()) throw UsageError("study: has no " + what + "; at least one is required");
}

/// Names that people recognise things by must not be given twice.
template <typename List>
void check_names(const List& list, const std::string& what) {
  std::set<std::string> seen;
  for (const auto& one : list) {
    if (one.name.empty()) throw UsageError("study: a " + what + " has no name");
    if (!seen.insert(one.name).second) {
      throw UsageError("study: two " + what + "s are called \"" + one.name +
                       "\"; every name is allowed once");
    }
  }
}

void check_setting(const StudySetting& setting) {
  const std::string what = "setting \"" + setting.name + "\"";
  check_between(what, "palm limit depth", setting.palm_limit_depth, 0.1, kDeepest, "mm");
  check_between(what, "finger limit depth", setting.finger_limit_depth, 0.1, kDeepest, "mm");
  check_between(what, "friction", setting.friction, 0.0, 3.0);
  if ((setting.task == grasp::HandTask::kTurn) != setting.turn.has_value()) {
    throw UsageError(what + (setting.turn ? ": a torque is given; its task has to be turn"
                                          : ": its task is turn; a torque is required with it"));
  }
  if (setting.turn) {
    const double most = 1e-3 * grasp::kMostTurn;
    if (*setting.turn == 0.0) throw UsageError(what + ": its torque is 0 N m; another is required");
    check_between(what, "torque", *setting.turn, -most, most, "N m");
  }
  if (grasp::says_how_firmly(setting.task) && (setting.grip_force || setting.strength_share ||
                                               setting.limit_depths || !setting.is_balanced)) {
    throw UsageError(what + ": its task, " + std::string(name_of(setting.task)) +
                     ", says how firmly to grip; " +
                     (setting.grip_force       ? "grip force"
                      : setting.strength_share ? "strength share"
                      : setting.limit_depths   ? "limit depths"
                                               : "no balance") +
                     " isn't allowed with it");
  }
  if (setting.grip_force && setting.strength_share) {
    throw UsageError(what + ": grip force and strength share are both given; one is allowed");
  }
  if (setting.limit_depths && (setting.grip_force || setting.strength_share)) {
    throw UsageError(what + ": limit depths and " +
                     (setting.grip_force ? "grip force" : "strength share") +
                     " both say how firmly to grip; one is allowed");
  }
  if (setting.strength && !setting.strength_share) {
    throw UsageError(what + ": strength is given without the share of it to grip with");
  }
  if (setting.strength) {
    check_between(what, "strength", *setting.strength, 1.0, kLargestGripForce, "N");
  }
  check_between(what, "least grip force", setting.least_grip_force, 0.0, kLargestGripForce, "N");
  if (setting.grip_force) {
    check_between(what, "grip force", *setting.grip_force, 0.1, kLargestGripForce, "N");
  }
  if (setting.strength_share) {
    check_between(what, "strength share", *setting.strength_share, 0.001, 1.0);
  }
}

}  // namespace

grasp::ShareOfStrength share_of_strength(const StudySetting& setting, double own) {
  grasp::ShareOfStrength result;
  result.share = setting.strength_share.value_or(grasp::kUsualStrengthShare);
  result.strength = setting.strength.value_or(own);
  if (setting.strength && std::abs(*setting.strength - grasp::usual_grip_strength()) < 1e-9) {
    result.whose = grasp::usual_people();
  }
  result.least = setting.least_grip_force;
  result.why_least = "the heaviest product by friction";
  return result;
}

void check_product(const StudyPlan& plan, std::size_t number) {
  const StudyProduct& product = plan.products.at(number);
  for (std::size_t i = 0; i < number; ++i) {
    if (plan.products[i].name != product.name) continue;
    throw UsageError("two products are called \"" + product.name +
                     "\"; every name is allowed once");
  }
  const std::string what = "product \"" + product.name + "\"";
  check_between(what, "size", product.size, kSmallestSize, kLargestSize);
  check_between(what, "mass", product.mass, 0.0, kHeaviest, "kg");
  if (product.axis && !(product.axis->norm() > 0.0)) {
    throw UsageError(what + ": its axis is 0, 0, 0; a direction is required");
  }
  if (product.posture_of.empty()) return;
  for (const StudyProduct& other : plan.products) {
    if (other.name != product.posture_of) continue;
    if (&other == &product) throw UsageError(what + ": keeps the posture of itself");
    if (!other.posture_of.empty()) {
      throw UsageError(what + ": keeps the posture of \"" + other.name +
                       "\", which keeps that of \"" + other.posture_of +
                       "\"; only a product that is grasped itself is allowed");
    }
    return;
  }
  throw UsageError(what + ": keeps the posture of \"" + product.posture_of +
                   "\", which is no product of the study");
}

void StudyPlan::check() const {
  check_some(populations, "population");
  check_some(profiles, "profile");
  check_some(hands, "hand");
  check_some(products, "product");
  check_some(grips, "grip");
  check_some(settings, "setting");
  check_names(profiles, "profile");
  check_names(products, "product");
  check_names(settings, "setting");
  for (const population::HandProfile& profile : profiles) profile.check();
  for (std::size_t i = 0; i < products.size(); ++i) check_product(*this, i);
  for (const StudySetting& setting : settings) check_setting(setting);
  for (const StudyHand& hand : hands) {
    if (hand.population < 0 || hand.population >= size_of(populations)) {
      throw UsageError(fmt::format("study: hand \"{}\" is of population {}; there are {}",
                                   hand.sample.label, hand.population, populations.size()));
    }
  }
  for (const StudyLimit& limit : limits) {
    if (limit.quantity.empty()) throw UsageError("study: a limit names no quantity");
    if (!limit.lowest && !limit.highest) {
      throw UsageError("limit of \"" + limit.quantity +
                       "\": has neither lowest nor highest; at least one is required");
    }
    if (limit.lowest && limit.highest && *limit.lowest > *limit.highest) {
      throw UsageError(
          fmt::format("limit of \"{}\": lowest is {:g}, highest {:g}; lowest must "
                      "not be above highest",
                      limit.quantity, *limit.lowest, *limit.highest));
    }
  }
}

std::int64_t task_count(const StudyPlan& plan) {
  return size_of(plan.hands) * size_of(plan.profiles) * size_of(plan.settings) *
         size_of(plan.products) * size_of(plan.grips);
}

StudyTask task_at(const StudyPlan& plan, std::int64_t number) {
  if (number < 0 || number >= task_count(plan)) {
    throw UsageError("task " + std::to_string(number) + " of a study of " +
                     std::to_string(task_count(plan)) + " tasks");
  }
  StudyTask task;
  const auto take = [&](const auto& list) {
    const auto index = static_cast<int>(number % size_of(list));
    number /= size_of(list);
    return index;
  };
  task.grip = take(plan.grips);
  task.product = take(plan.products);
  task.setting = take(plan.settings);
  task.profile = take(plan.profiles);
  task.hand = take(plan.hands);
  return task;
}

std::int64_t number_of(const StudyPlan& plan, const StudyTask& task) {
  std::int64_t number = task.hand;
  number = number * size_of(plan.profiles) + task.profile;
  number = number * size_of(plan.settings) + task.setting;
  number = number * size_of(plan.products) + task.product;
  return number * size_of(plan.grips) + task.grip;
}

void StudyShard::check() const {
  if (n >= 1 && k >= 1 && k <= n) return;
  throw UsageError(fmt::format("shard is {}/{}; k/n with 1 <= k <= n is required", k, n));
}

std::string name_of(StudyShard shard) { return fmt::format("{}/{}", shard.k, shard.n); }

std::vector<std::int64_t> tasks_of(const StudyPlan& plan, StudyShard shard) {
  shard.check();
  const std::int64_t hands = size_of(plan.hands);
  if (shard.n > hands) {
    throw UsageError(fmt::format("the study has {} hand{}; {} shards would leave some without one",
                                 hands, hands == 1 ? "" : "s", shard.n));
  }
  const std::int64_t per_hand = task_count(plan) / hands;
  std::vector<std::int64_t> tasks;
  for (std::int64_t hand = shard.k - 1; hand < hands; hand += shard.n) {
    for (std::int64_t i = 0; i < per_hand; ++i) tasks.push_back(hand * per_hand + i);
  }
  return tasks;
}

}  // namespace palmar::study
