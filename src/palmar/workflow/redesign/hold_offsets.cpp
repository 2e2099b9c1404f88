// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/hold_offsets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/grasp/holds/carried_hold.h"
#include "palmar/records/study/study_store.h"
#include "palmar/statistics/distributions.h"
#include "palmar/study/study_run.h"

namespace palmar::workflow {

std::vector<HoldOffset> spread_offsets(int count, double along_deviation, double turn_deviation) {
  const auto n = static_cast<std::size_t>(std::max(count, 2));
  std::vector<HoldOffset> offsets(n);
  const auto middle = [&](std::size_t i) {
    return statistics::normal_quantile((static_cast<double>(i) + 0.5) / static_cast<double>(n));
  };
  // Turns in the order (i step + first) modulo n, which visits all of them if step and n share no
  // divisor: the order in which turns have least to do with places along.
  std::size_t best_step = 1, best_first = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t step = 1; step < n; ++step) {
    if (std::gcd(step, n) != 1) continue;
    for (std::size_t first = 0; first < n; ++first) {
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) sum += middle(i) * middle((i * step + first) % n);
      if (std::abs(sum) > least - 1e-9) continue;
      least = std::abs(sum);
      best_step = step;
      best_first = first;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    offsets[i] = {along_deviation * middle(i),
                  turn_deviation * middle((i * best_step + best_first) % n)};
  }
  return offsets;
}

grasp::Hold moved_hold(const grasp::Hold& hold, const product::ProductPart& part,
                       const HoldOffset& offset) {
  grasp::Hold moved = hold;
  if (part.length > 0.0) moved.along += hold.toward * offset.along / part.length;
  moved.turn += hold.toward * offset.turn;
  return moved;
}

study::StudyPlan plan_of_two(const HeldOriginal& original) {
  study::StudyPlan plan = original.study.plan;
  plan.products.push_back(plan.products.front());
  plan.products.back().name = plan.products.back().family = "candidate";
  return plan;
}

OffsetGrasps::OffsetGrasps(const Asked& asked)
    : study_(asked.original.study),
      two_(plan_of_two(asked.original)),
      offsets_(asked.offsets.size()) {
  const std::optional<grasp::Hold> hold = asked.original.hold();
  if (!hold) {
    throw UsageError(asked.original.product().name +
                     ": held at given coordinates; offsets are those of a hold");
  }
  const product::ProductParts& before = asked.original.parts();
  const product::ProductPart& part = before.parts.at(static_cast<std::size_t>(hold->part - 1));
  study::StudyPlan& plan = study_.plan;
  const study::StudyProduct kept = plan.products.front();
  plan.products.clear();
  study_.inputs.products.clear();
  study_.inputs.parts.clear();
  for (const Shape& shape : asked.shapes) {
    const auto after =
        shape.as == 0
            ? asked.original.shared_parts()
            : std::make_shared<const product::ProductParts>(product::find_parts(shape.product));
    for (const HoldOffset& offset : asked.offsets) {
      study::StudyProduct product = kept;
      product.name = product.family = fmt::format("offset {}", plan.products.size());
      product.content_hash = records::content_hash(shape.product.mesh);
      product.holding = {};
      product.holding.hold = grasp::carried_hold(moved_hold(*hold, part, offset), before, *after);
      plan.products.push_back(std::move(product));
      study_.inputs.products.push_back(shape.product);
      study_.inputs.parts.push_back(after);
    }
    as_.push_back(shape.as);
  }
  for (study::StudySetting& setting : plan.settings) setting.indices = asked.with_indices;
  bench_ = std::make_unique<study::StudyBench>(plan, study_.inputs, study::StudyDetail::kFigures);
}

std::vector<std::vector<study::StudyRecord>> OffsetGrasps::of(const Wanted& is_wanted,
                                                              const Progress& progress) {
  const study::StudyPlan& plan = study_.plan;
  study::StudyRunOptions options;
  for (const std::int64_t number : study::tasks_of(plan)) {
    const study::StudyTask task = study::task_at(plan, number);
    if (is_wanted(task.hand, static_cast<std::size_t>(task.product) % offsets_)) {
      options.tasks.push_back(number);
    }
  }
  std::vector<std::vector<study::StudyRecord>> records(offsets_);
  study::run_study(
      *bench_, plan, options,
      [&](const study::StudyRecord& record) {
        study::StudyTask task = study::task_at(plan, record.number);
        const auto product = static_cast<std::size_t>(task.product);
        auto& those = records[product % offsets_];
        task.product = as_[product / offsets_];
        those.push_back(record);
        those.back().number = study::number_of(two_, task);
      },
      progress);
  for (auto& those : records) {
    std::sort(those.begin(), those.end(),
              [](const study::StudyRecord& a, const study::StudyRecord& b) {
                return a.number < b.number;
              });
  }
  return records;
}

}  // namespace palmar::workflow
