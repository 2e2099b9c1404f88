// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_plan.h"

#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

std::int64_t size_of(const auto& list) { return static_cast<std::int64_t>(list.size()); }

}  // namespace

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

}  // namespace palmar
