// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/candidate_study.h"

#include <algorithm>

#include "palmar/grasp/holds/carried_hold.h"
#include "palmar/records/study/study_store.h"
#include "palmar/study/study_task.h"

namespace palmar::workflow {

Progress silent(const Progress& progress) {
  Progress quiet;
  quiet.cancel = progress.cancel;
  return quiet;
}

records::LoadedStudy with_redesigns(const RedesignRequest& request, const HeldOriginal& original,
                                    const std::vector<RedesignedProduct>& redesigns) {
  records::LoadedStudy study = original.study;
  const study::StudyProduct before = study.plan.products.front();
  const std::optional<grasp::Hold> hold = request.keeps_posture() ? std::nullopt : original.hold();
  if (hold) study.inputs.parts = {original.shared_parts()};
  for (const RedesignedProduct& redesign : redesigns) {
    study::StudyProduct after = before;
    after.name = after.family = redesign.name;
    after.file = redesign.file;
    after.content_hash = records::content_hash(redesign.product.mesh);
    after.posture_of = request.keeps_posture() ? before.name : "";
    if (hold) {
      after.holding = {};
      study.inputs.parts.push_back(
          std::make_shared<const product::ProductParts>(product::find_parts(redesign.product)));
      after.holding.hold = grasp::carried_hold(*hold, original.parts(), *study.inputs.parts.back());
    }
    study.plan.products.push_back(std::move(after));
    study.inputs.products.push_back(redesign.product);
    study.inputs.products.back().name = redesign.name;
  }
  study.plan.check();
  return study;
}

std::vector<study::StudyRecord> renumbered(const HeldOriginal& original,
                                           const study::StudyPlan& plan) {
  std::vector<study::StudyRecord> records = original.records;
  for (study::StudyRecord& record : records) {
    record.number = study::number_of(plan, study::task_at(original.study.plan, record.number));
  }
  return records;
}

study::StudyResults assess_candidate(const RedesignRequest& request, const HeldOriginal& original,
                                     const product::Product& candidate, bool with_indices,
                                     const Progress& progress) {
  records::LoadedStudy study = with_redesigns(request, original, {{candidate, "candidate", ""}});
  for (study::StudySetting& setting : study.plan.settings) setting.indices = with_indices;
  study::StudyResults results{.plan = study.plan, .records = renumbered(original, study.plan)};
  study::StudyRunOptions options;
  for (const std::int64_t number : study::tasks_of(study.plan)) {
    if (study::task_at(study.plan, number).product == 1) options.tasks.push_back(number);
  }
  study::StudyBench bench(study.plan, study.inputs, study::StudyDetail::kFigures);
  study::run_study(
      bench, study.plan, options,
      [&](const study::StudyRecord& record) { results.records.push_back(record); }, progress);
  std::sort(
      results.records.begin(), results.records.end(),
      [](const study::StudyRecord& a, const study::StudyRecord& b) { return a.number < b.number; });
  return results;
}

}  // namespace palmar::workflow
