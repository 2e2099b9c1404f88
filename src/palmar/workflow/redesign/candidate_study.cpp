// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/candidate_study.h"

#include <algorithm>

#include "palmar/grasp/holds/carried_hold.h"
#include "palmar/records/study/study_store.h"
#include "palmar/study/study_task.h"

namespace palmar {

Progress silent(const Progress& progress) {
  Progress quiet;
  quiet.cancel = progress.cancel;
  return quiet;
}

LoadedStudy with_redesigns(const RedesignRequest& request, const HeldOriginal& original,
                           const std::vector<RedesignedProduct>& redesigns) {
  LoadedStudy study = original.study;
  const StudyProduct before = study.plan.products.front();
  const std::optional<Hold> hold = request.keeps_posture() ? std::nullopt : original.hold();
  if (hold) study.inputs.parts = {original.shared_parts()};
  for (const RedesignedProduct& redesign : redesigns) {
    StudyProduct after = before;
    after.name = after.family = redesign.name;
    after.file = redesign.file;
    after.content_hash = content_hash(redesign.product.mesh);
    after.posture_of = request.keeps_posture() ? before.name : "";
    if (hold) {
      after.holding = {};
      study.inputs.parts.push_back(
          std::make_shared<const ProductParts>(find_parts(redesign.product)));
      after.holding.hold = carried_hold(*hold, original.parts(), *study.inputs.parts.back());
    }
    study.plan.products.push_back(std::move(after));
    study.inputs.products.push_back(redesign.product);
    study.inputs.products.back().name = redesign.name;
  }
  study.plan.check();
  return study;
}

std::vector<StudyRecord> renumbered(const HeldOriginal& original, const StudyPlan& plan) {
  std::vector<StudyRecord> records = original.records;
  for (StudyRecord& record : records) {
    record.number = number_of(plan, task_at(original.study.plan, record.number));
  }
  return records;
}

StudyResults assess_candidate(const RedesignRequest& request, const HeldOriginal& original,
                              const Product& candidate, bool with_indices,
                              const Progress& progress) {
  LoadedStudy study = with_redesigns(request, original, {{candidate, "candidate", ""}});
  for (StudySetting& setting : study.plan.settings) setting.indices = with_indices;
  StudyResults results{.plan = study.plan, .records = renumbered(original, study.plan)};
  StudyRunOptions options;
  for (const std::int64_t number : tasks_of(study.plan)) {
    if (task_at(study.plan, number).product == 1) options.tasks.push_back(number);
  }
  StudyBench bench(study.plan, study.inputs, StudyDetail::kFigures);
  run_study(
      bench, study.plan, options,
      [&](const StudyRecord& record) { results.records.push_back(record); }, progress);
  std::sort(results.records.begin(), results.records.end(),
            [](const StudyRecord& a, const StudyRecord& b) { return a.number < b.number; });
  return results;
}

}  // namespace palmar
