// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first and the last step of every redesign: hands hold the original; the same hands hold
// original and redesigns.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/study/study_store.h"
#include "palmar/report/study/study_report.h"
#include "redesign/redesign_arguments.h"
#include "study/study_arguments.h"
#include "study/study_comparison_text.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

/// Quantities that the comparison prints; the report has all.
const std::vector<std::string> kCompared = {"peak_pressure_cells_mpa", "mean_pressure_mpa",
                                            "contact_area_mm2", "grip_force_n"};

bool keeps_posture(const RedesignArguments& arguments) { return arguments.posture == "kept"; }

void check(const RedesignArguments& arguments) {
  if (arguments.posture != "kept" && arguments.posture != "new") {
    throw UsageError("--posture is \"" + arguments.posture + "\"; kept or new is allowed");
  }
  constexpr double kMost = 500.0;  // N; about the strongest grip measured
  if (!(arguments.grip_force >= 0.0 && arguments.grip_force <= kMost)) {
    throw UsageError(fmt::format("--grip-force-n is {:g} N; 0 (as closed) to {:g} N are allowed",
                                 arguments.grip_force, kMost));
  }
  if (arguments.grip_force > 0.0 && keeps_posture(arguments)) {
    throw UsageError(
        "--grip-force-n: in a kept posture the shape decides the force; --posture new goes with "
        "it");
  }
}

StudyRequest request_of(const RedesignArguments& arguments, const Context& context) {
  StudyArguments typed;
  typed.populations = arguments.populations;
  typed.grips = arguments.grips;
  typed.hands = arguments.hands;
  typed.hand = arguments.hand;
  typed.unit = arguments.unit;
  typed.products = {arguments.product};
  for (const std::string& name : typed.populations) {
    if (fs::path(name).extension() == ".csv") typed.hands = 0;  // given hands
  }
  StudyRequest request = typed.request(context);
  ProductRequest& product = request.products.front();
  if (is_made(arguments.product)) {
    product.made = made_from(arguments.product);
    product.file.clear();
    request.name = product.made.kind;
  }
  if (!arguments.at.empty()) product.held.at = parse_vector("--at", arguments.at);
  if (!arguments.axis.empty()) product.held.axis = parse_vector("--axis", arguments.axis);
  StudySetting setting;
  if (arguments.grip_force > 0.0) setting.grip_force = arguments.grip_force;
  request.settings = {setting};
  return request;
}

/// Original and redesigns as one study.
LoadedStudy with_redesigns(const RedesignArguments& arguments, const HeldOriginal& original,
                           const std::vector<RedesignedProduct>& redesigns) {
  LoadedStudy study = original.study;
  const StudyProduct before = study.plan.products.front();
  for (const RedesignedProduct& redesign : redesigns) {
    StudyProduct after = before;
    after.name = after.family = redesign.name;
    after.file = redesign.file;
    after.content_hash = content_hash(redesign.product.mesh);
    after.posture_of = keeps_posture(arguments) ? before.name : "";
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

}  // namespace

void RedesignArguments::add_to(CLI::App& verb) {
  verb.add_option("PRODUCT", product,
                  "STEP, IGES or mesh file, or \"made: prism width_mm=35 fillet_mm=3\"")
      ->required();
  verb.add_option("--out", out, "Folder for what is made: new or empty, or of an earlier redesign")
      ->required();
  verb.add_option("--unit", unit, "Unit of a file that carries none: mm, cm, m, inch");
  verb.add_option("--population", populations,
                  "Whose hands hold it: a built-in population (`palmar population list`), a "
                  "population file (.toml) or a table of given hands (.csv)")
      ->allow_extra_args(false)
      ->capture_default_str();
  verb.add_option("--hands", hands, "Hands to draw from each population")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  verb.add_option("--hand", hand, "Hand that is scaled: template or a *.hand.glb file");
  verb.add_option("--grip", grips, "auto, medium_wrap, tripod ...")->expected(1);
  verb.add_option("--at", at, "Where it is held, product frame: x,y,z mm");
  verb.add_option("--axis", axis, "Direction of the handle there: x,y,z");
  verb.add_option("--posture", posture,
                  "kept: redesigns are held in the posture in which the same hand holds the "
                  "original; new: grasped by themselves")
      ->capture_default_str();
  verb.add_option("--grip-force-n", grip_force,
                  "Grip force with which all are held, N; 0: as closed. With --posture new")
      ->capture_default_str();
}

RecordSource HeldOriginal::source() const {
  return [this](const std::function<void(const StudyRecord&)>& visit) {
    for (const StudyRecord& record : records) visit(record);
  };
}

HeldOriginal grasp_original(const RedesignArguments& arguments, const Context& context,
                            const Progress& progress) {
  check(arguments);
  const StudyRequest request = request_of(arguments, context);
  HeldOriginal original{.study = load_study(request, load_hand(request.hand)), .records = {}};
  for (const std::string& text : original.study.notes) note(context.common, text);
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
        arguments.product + ": none of " + std::to_string(plan.hands.size()) + " hands holds it" +
        (reason.empty() ? "" : " (" + reason + ")") +
        "; a redesign starts from hands that do (--at, --axis and --grip say where "
        "and how it is held)");
  }
  return original;
}

StudyResults assess_candidate(const RedesignArguments& arguments, const HeldOriginal& original,
                              const Product& candidate, bool with_indices,
                              const Progress& progress) {
  LoadedStudy study = with_redesigns(arguments, original, {{candidate, "candidate", ""}});
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

std::string compare_redesigns(const RedesignArguments& arguments, const HeldOriginal& original,
                              const std::vector<RedesignedProduct>& redesigns,
                              const Context& context, const Progress& progress) {
  const LoadedStudy study = with_redesigns(arguments, original, redesigns);
  const fs::path folder = arguments.out;
  create_folder(folder);
  // Beside the old one until it is finished: a redesign that is stopped leaves the old one whole.
  const fs::path store_path = folder / "redesign.palmar", fresh = folder / "redesign.new.palmar";
  fs::remove(fresh);
  StudyStore::create(fresh, study.plan, study.inputs);
  StudyResults results{.plan = study.plan, .records = {}};
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
  write_study_report((folder / "report").string(),
                     {results, study.inputs,
                      [&store](const std::function<void(const StudyRecord&)>& visit) {
                        store.for_each(true, visit);
                      },
                      program, digest},
                     {}, progress);
  finish_progress();
  std::vector<StudyQuantity> quantities;
  for (const std::string& key : kCompared) quantities.push_back(quantity_named(results, key));
  if (context.common.json) return comparison_object(results, quantities, {}).dump(2);
  print(comparison_text(results, quantities, {}));
  note(context.common, "report: " + (folder / "report" / "report.html").string() +
                           "; study: " + store_path.string());
  return "";
}

}  // namespace palmar::cli
