// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The last step of every redesign: the judging hands hold original and redesigns.
#include "palmar/workflow/redesign/redesign_comparison.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/formats/file.h"
#include "palmar/records/study/study_store.h"
#include "palmar/report/study/study_report.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;

/// Quantities that the comparison prints, besides the goal's; the report has all.
const std::vector<std::string> kCompared = {"peak_pressure_cells_mpa", "mean_pressure_mpa",
                                            "contact_area_mm2", "grip_force_n"};

/// What is still under a temporary name when a comparison ends, finished or stopped.
struct RemovedInTheEnd {
  fs::path path;
  ~RemovedInTheEnd() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

std::vector<std::string> notes_on(const RedesignComparison& comparison, std::size_t hands) {
  std::vector<std::string> notes;
  notes.push_back(comparison.is_in_other_hands
                      ? fmt::format("compared in {} other hands than those it was made for", hands)
                      : "compared in the hands that it was made for, as they were given");
  for (const HoldChange& change : comparison.changes) {
    if (change.hands > 0) notes.push_back(words_of(change));
  }
  return notes;
}

}  // namespace

RedesignComparison compare_redesigns(const RedesignRequest& request, const JudgingHands& judges,
                                     const std::vector<RedesignedProduct>& redesigns,
                                     const std::vector<report::StudyFigure>& figures,
                                     const Progress& progress) {
  const HeldOriginal& original = judges.original;
  const records::LoadedStudy study = with_redesigns(request, original, redesigns);
  const fs::path folder = request.out;
  formats::create_folder(folder);
  // Beside the old one until it is finished: a redesign that is stopped leaves the old one whole.
  const fs::path store_path = folder / "redesign.palmar", fresh = folder / "redesign.new.palmar";
  fs::remove(fresh);
  const RemovedInTheEnd rest{fresh};
  records::StudyStore::create(fresh, study.plan, study.inputs);
  RedesignComparison comparison{.results = {.plan = study.plan, .records = {}},
                                .quantities = {},
                                .report = folder / "report" / "report.html",
                                .study = store_path,
                                .language = request.language,
                                .is_in_other_hands = judges.are_others,
                                .changes = {},
                                .notes = {}};
  study::StudyResults& results = comparison.results;
  std::string digest, program;
  {
    records::StudyStore store(fresh, records::StudyAccess::kWrite);
    for (const study::StudyRecord& record : renumbered(original, study.plan)) store.keep(record);
    study::run_study(
        study.plan, study.inputs, {.tasks = store.missing()},
        [&](const study::StudyRecord& record) { store.keep(record); }, progress);
    store.finish();
    digest = store.digest();
    program = store.program();
    store.for_each(false,
                   [&](const study::StudyRecord& record) { results.records.push_back(record); });
  }
  fs::rename(fresh, store_path);
  const records::StudyStore store(store_path);
  report::StudyReportOptions report;
  report.language = request.language;
  report.command = request.command;
  report.figures = figures;
  report::write_study_report(
      (folder / "report").string(),
      {results, study.inputs,
       [&store](const std::function<void(const study::StudyRecord&)>& visit) {
         store.for_each(true, visit);
       },
       program, digest},
      report, progress);
  comparison.changes = hold_changes(results, held_place(request, original));
  comparison.notes = notes_on(comparison, study.plan.hands.size());
  if (request.on_note) {
    for (const std::string& text : comparison.notes) request.on_note(text);
  }
  std::vector<std::string> keys = kCompared;
  if (!request.goal_key.empty() &&
      std::find(keys.begin(), keys.end(), request.goal_key) == keys.end()) {
    keys.insert(keys.begin(), request.goal_key);
  }
  for (const std::string& key : keys)
    comparison.quantities.push_back(study::quantity_named(results, key));
  return comparison;
}

}  // namespace palmar::workflow
