// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first and the last step of every redesign: hands hold the original; the same hands hold
// original and redesigns.
#include "palmar/workflow/redesign/held_original.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/holds/carried_hold.h"
#include "palmar/product/parts/part_place.h"
#include "palmar/records/study/people_range.h"
#include "palmar/records/study/study_store.h"
#include "palmar/report/study/study_report.h"
#include "palmar/statistics/summary.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;

/// Quantities that the comparison prints; the report has all.
const std::vector<std::string> kCompared = {"peak_pressure_cells_mpa", "mean_pressure_mpa",
                                            "contact_area_mm2", "grip_force_n"};

constexpr double kOtherTurn = 30.0 * kDegree;  // of a redesign against the original in the hand
constexpr double kOtherShift = 10.0;           // mm, the same; our choice

bool keeps_posture(const RedesignRequest& request) {
  return request.posture == RedesignPosture::kKept;
}

StudyRequest study_of(const RedesignRequest& asked) {
  StudyRequest request;
  request.hand = asked.hand;
  if (asked.seed != 0) request.seed = asked.seed;
  for (const std::string& name : asked.populations) {
    for (PopulationRequest& one : population_requests(name)) {
      if (one.table.empty()) one.sampling.hands = asked.hands;  // else given hands
      request.populations.push_back(std::move(one));
    }
  }
  request.grips = asked.grips;
  ProductRequest product;
  product.unit = asked.unit;
  if (is_made(asked.product)) {
    product.made = made_from(asked.product);
    request.name = product.made.kind;
  } else {
    product.file = asked.product;
    request.name = fs::path(asked.product).stem().string();
  }
  product.held.at = asked.at;
  product.held.axis = asked.axis;
  product.held.holding = asked.holding;
  request.products.push_back(std::move(product));
  StudySetting setting;
  if (asked.grip_force > 0.0) setting.grip_force = asked.grip_force;
  setting.limit_depths = keeps_posture(asked);
  request.settings = {setting};
  return request;
}

/// The hold of the original, if its place wasn't given by coordinates.
std::optional<Hold> hold_of(const HeldOriginal& original) {
  for (const StudyRecord& record : original.records) {
    if (is_in_hand(record) && record.hold) return record.hold->hold;
  }
  return std::nullopt;
}

/// Original and redesigns as one study.
LoadedStudy with_redesigns(const RedesignRequest& request, const HeldOriginal& original,
                           const std::vector<RedesignedProduct>& redesigns) {
  LoadedStudy study = original.study;
  const StudyProduct before = study.plan.products.front();
  const std::optional<Hold> hold = keeps_posture(request) ? std::nullopt : hold_of(original);
  std::optional<ProductParts> parts;
  if (hold) parts = find_parts(original.product());
  for (const RedesignedProduct& redesign : redesigns) {
    StudyProduct after = before;
    after.name = after.family = redesign.name;
    after.file = redesign.file;
    after.content_hash = content_hash(redesign.product.mesh);
    after.posture_of = keeps_posture(request) ? before.name : "";
    if (hold) {
      after.holding = {};
      after.holding.hold = carried_hold(*hold, *parts, find_parts(redesign.product));
    }
    study.plan.products.push_back(std::move(after));
    study.inputs.products.push_back(redesign.product);
    study.inputs.products.back().name = redesign.name;
  }
  study.plan.check();
  return study;
}

/// The original's grasps stand already: they depend on hand and product alone.
std::vector<StudyRecord> renumbered(const HeldOriginal& original, const StudyPlan& plan) {
  std::vector<StudyRecord> records = original.records;
  for (StudyRecord& record : records) {
    record.number = number_of(plan, task_at(original.study.plan, record.number));
  }
  return records;
}

/// The original in as many other hands of the same populations; nothing if there are none to draw.
std::optional<HeldOriginal> in_other_hands(const RedesignRequest& request,
                                           const HeldOriginal& original, const Progress& progress) {
  for (const std::string& name : request.populations) {
    for (const PopulationRequest& one : population_requests(name)) {
      if (!one.table.empty()) return std::nullopt;
    }
  }
  RedesignRequest other = request;
  other.seed = original.study.plan.seed + 1;
  other.on_note = nullptr;  // they were said
  return grasp_original(other, progress);
}

std::vector<HoldChange> hold_changes(const StudyResults& results, const Vec3& place) {
  std::vector<HoldChange> changes;
  const StudyCondition condition = conditions_of(results.plan).front();
  for (std::size_t p = 1; p < results.plan.products.size(); ++p) {
    HoldChange change{.redesign = results.plan.products[p].name};
    std::vector<double> turns, shifts;
    for (const int hand : hands_of(results.plan, condition)) {
      const StudyRecord* before = record_of(results, condition, 0, hand);
      const StudyRecord* after = record_of(results, condition, static_cast<int>(p), hand);
      if (before == nullptr || after == nullptr || !is_in_hand(*before) || !is_in_hand(*after)) {
        continue;
      }
      const Rigid3 &a = before->product_from_hand, &b = after->product_from_hand;
      turns.push_back(a.rotation.angularDistance(b.rotation));
      shifts.push_back((a.inverse() * place - b.inverse() * place).norm());
    }
    if (!turns.empty()) {
      change.hands = static_cast<int>(turns.size());
      std::sort(turns.begin(), turns.end());
      std::sort(shifts.begin(), shifts.end());
      change.turn = quantile(turns, 0.5);
      change.largest_turn = turns.back();
      change.shift = quantile(shifts, 0.5);
      change.largest_shift = shifts.back();
    }
    changes.push_back(std::move(change));
  }
  return changes;
}

/// Where hands hold the original, product frame, mm.
Vec3 held_place(const RedesignRequest& request, const HeldOriginal& original) {
  if (request.at) return *request.at;
  if (const std::optional<Hold> hold = hold_of(original)) {
    const ProductParts parts = find_parts(original.product());
    const ProductPart& part = parts.parts.at(static_cast<std::size_t>(hold->part - 1));
    return part_frame(part, hold->along, hold->turn).translation;
  }
  return bounding_box(original.product().mesh).center();
}

std::vector<std::string> notes_on(const RedesignComparison& comparison, std::size_t hands) {
  std::vector<std::string> notes;
  notes.push_back(comparison.is_in_other_hands
                      ? fmt::format("compared in {} other hands than those it was made for", hands)
                      : "compared in the hands that it was made for, as they were given");
  for (const HoldChange& change : comparison.changes) {
    if (change.hands == 0) continue;
    std::string text = fmt::format(
        "{} lies {:.0f} degrees and {:.1f} mm away from where the original lies in the hand "
        "(median of {} hands; at most {:.0f} degrees, {:.1f} mm)",
        change.redesign, change.turn / kDegree, change.shift, change.hands,
        change.largest_turn / kDegree, change.largest_shift);
    if (change.is_other_hold()) {
      text += ": it is held in another way, so that a difference may be the hold's";
    }
    notes.push_back(std::move(text));
  }
  return notes;
}

}  // namespace

bool HoldChange::is_other_hold() const { return turn > kOtherTurn || shift > kOtherShift; }

RecordSource HeldOriginal::source() const {
  return [this](const std::function<void(const StudyRecord&)>& visit) {
    for (const StudyRecord& record : records) visit(record);
  };
}

HeldOriginal grasp_original(const RedesignRequest& request, const Progress& progress) {
  request.check();
  progress.throw_if_cancelled();
  const StudyRequest asked = study_of(request);
  HeldOriginal original{.study = load_study(asked, load_hand(asked.hand)), .records = {}};
  StudyInputs& inputs = original.study.inputs;
  inputs.compliance = tissue_on_bone(*inputs.base, original.study.plan, request.on_note);
  if (request.on_note) {
    for (const std::string& text : original.study.notes) request.on_note(text);
  }
  const StudyPlan& plan = original.study.plan;
  run_study(
      plan, original.study.inputs, {.tasks = tasks_of(plan)},
      [&](const StudyRecord& record) { original.records.push_back(record); }, progress);
  std::sort(original.records.begin(), original.records.end(),
            [](const StudyRecord& a, const StudyRecord& b) { return a.number < b.number; });
  const bool is_held = std::any_of(original.records.begin(), original.records.end(), is_in_hand);
  if (!is_held) {
    const std::string& reason = original.records.front().reason;
    throw NumericalError(
        request.product + ": none of " + std::to_string(plan.hands.size()) + " hands holds it" +
        (reason.empty() ? "" : " (" + reason + ")") +
        "; a redesign starts from hands that do (setting \"at\", setting \"axis\" and setting "
        "\"grips\" say where and how it is held)");
  }
  return original;
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
  run_study(
      study.plan, study.inputs, options,
      [&](const StudyRecord& record) {
        results.records.push_back(record);
        results.records.back().skin_pressure = {};
        results.records.back().product_pressure = {};
      },
      progress);
  std::sort(results.records.begin(), results.records.end(),
            [](const StudyRecord& a, const StudyRecord& b) { return a.number < b.number; });
  return results;
}

RedesignComparison compare_redesigns(const RedesignRequest& request, const HeldOriginal& made_for,
                                     const std::vector<RedesignedProduct>& redesigns,
                                     const Progress& progress) {
  const std::optional<HeldOriginal> others = in_other_hands(request, made_for, progress);
  const HeldOriginal& original = others ? *others : made_for;
  const LoadedStudy study = with_redesigns(request, original, redesigns);
  const fs::path folder = request.out;
  create_folder(folder);
  // Beside the old one until it is finished: a redesign that is stopped leaves the old one whole.
  const fs::path store_path = folder / "redesign.palmar", fresh = folder / "redesign.new.palmar";
  fs::remove(fresh);
  StudyStore::create(fresh, study.plan, study.inputs);
  RedesignComparison comparison{.results = {.plan = study.plan, .records = {}},
                                .quantities = {},
                                .report = folder / "report" / "report.html",
                                .study = store_path,
                                .language = request.language,
                                .is_in_other_hands = others.has_value(),
                                .changes = {},
                                .notes = {}};
  StudyResults& results = comparison.results;
  std::string digest, program;
  {
    StudyStore store(fresh, StudyAccess::kWrite);
    for (const StudyRecord& record : renumbered(original, study.plan)) store.keep(record);
    run_study(
        study.plan, study.inputs, {.tasks = store.missing()},
        [&](const StudyRecord& record) { store.keep(record); }, progress);
    store.finish();
    digest = store.digest();
    program = store.program();
    store.for_each(false, [&](const StudyRecord& record) { results.records.push_back(record); });
  }
  fs::rename(fresh, store_path);
  const StudyStore store(store_path);
  StudyReportOptions report;
  report.language = request.language;
  report.command = request.command;
  write_study_report((folder / "report").string(),
                     {results, study.inputs,
                      [&store](const std::function<void(const StudyRecord&)>& visit) {
                        store.for_each(true, visit);
                      },
                      program, digest},
                     report, progress);
  comparison.changes = hold_changes(results, held_place(request, original));
  comparison.notes = notes_on(comparison, study.plan.hands.size());
  if (request.on_note) {
    for (const std::string& text : comparison.notes) request.on_note(text);
  }
  for (const std::string& key : kCompared) {
    comparison.quantities.push_back(quantity_named(results, key));
  }
  return comparison;
}

}  // namespace palmar
