// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/population/hand_profile.h"
#include "palmar/records/study/people_range.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/study/study_progress.h"
#include "palmar/records/study/study_store.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/hand/tissue_on_bone.h"
#include "palmar/workflow/study/missing_grasps.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr double kNoteInterval = 2.0;  // s between two notes of how far a study is

/// Keeps finished grasps and writes from time to time how far the study is.
class Keeper {
 public:
  Keeper(records::StudyStore& store, std::size_t rest) : store_(store) {
    note_.shard = store.shard();
    note_.total = static_cast<std::int64_t>(study::tasks_of(store.plan(), store.shard()).size());
    note_.done = note_.done_before = note_.total - static_cast<std::int64_t>(rest);
    records::write_study_progress(store.path(), note_);
  }
  void keep(const study::StudyRecord& record) {
    store_.keep(record);
    ++note_.done;
    ++note_.outcomes[name_of(record.outcome)];
    if (record.outcome == study::StudyOutcome::kFailed) ++note_.reasons[record.reason];
    note_.seconds = seconds();
    const bool is_first = note_.done == note_.done_before + 1;
    if (!is_first && note_.seconds - last_ < kNoteInterval) return;
    last_ = note_.seconds;
    records::write_study_progress(store_.path(), note_);
  }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  const records::StudyProgressNote& note() const { return note_; }

 private:
  records::StudyStore& store_;
  records::StudyProgressNote note_;
  Clock::time_point start_ = Clock::now();
  double last_ = 0.0;
};

/// Runs what is missing, finishes the store and says what came of it.
StudyRunOutcome run_rest(records::StudyStore& store, study::StudyInputs inputs,
                         const NoteSink& note, const Progress& progress) {
  if (inputs.base != nullptr) inputs.compliance = tissue_on_bone(*inputs.base, store.plan(), note);
  const std::vector<std::int64_t> rest = store.missing();
  if (store.is_finished() && !rest.empty()) {
    throw InputError(store.path().string() + ": is damaged: " + missing_grasps(rest) +
                     "; delete it and run the study again");
  }
  Keeper keeper(store, rest.size());
  try {
    run_study(
        store.plan(), inputs, {.tasks = rest},
        [&](const study::StudyRecord& record) { keeper.keep(record); }, progress);
  } catch (const Cancelled&) {
    records::remove_study_progress(store.path());
    throw Cancelled(
        fmt::format("cancelled; {} of {} grasps are kept; `palmar study resume {}` continues",
                    keeper.note().done, keeper.note().total, store.path().string()));
  } catch (...) {
    records::remove_study_progress(store.path());
    throw;
  }
  StudyRunOutcome outcome;
  outcome.seconds = keeper.seconds();
  if (progress.report) progress.report(1.0, "closing the study");
  store.finish();
  records::remove_study_progress(store.path());

  outcome.plan = store.plan();
  outcome.store = store.path();
  outcome.shard = store.shard();
  outcome.grasps = keeper.note().total;
  outcome.run_now = static_cast<std::int64_t>(rest.size());
  outcome.digest = store.digest();
  store.for_each(false, [&](const study::StudyRecord& record) {
    ++outcome.outcomes[record.outcome];
    if (record.outcome == study::StudyOutcome::kFailed) ++outcome.reasons[record.reason];
  });
  return outcome;
}

std::string default_store(const study::StudyPlan& plan, study::StudyShard shard) {
  std::string name = plan.name;
  std::replace(name.begin(), name.end(), '/', '_');
  if (shard.n > 1) name += fmt::format("-{}-of-{}", shard.k, shard.n);
  return name + ".palmar";
}

/// Refuses to go on with a store that is of something else.
void check_same(const records::StudyStore& store, const study::StudyPlan& plan,
                study::StudyShard shard) {
  const std::string name = store.path().string();
  if (store.shard() != shard) {
    throw UsageError(
        fmt::format("{}: holds shard {}, not {}", name, name_of(store.shard()), name_of(shard)));
  }
  const std::vector<std::string> differences = records::plan_differences(store.plan(), plan);
  if (differences.empty()) return;
  std::string text = name + ": holds another study than the requested one:";
  for (const std::string& one : differences) text += "\n  " + one;
  throw UsageError(text + "\nGive another setting \"out\", or delete the file to start again.");
}

void check_program(const records::StudyStore& store) {
  if (store.program() == version()) return;
  throw UsageError(fmt::format("{}: was begun by Palmar {}; this is {}, whose results may differ",
                               store.path().string(), store.program(), version()));
}

}  // namespace

void QuickStudy::check() const {
  if (products.empty()) {
    throw UsageError("setting \"products\": none is given; at least one is required");
  }
  if (!(hands >= 0 && hands <= kMostHands)) {
    throw UsageError(
        fmt::format("setting \"hands\" is {}; 1 to {} is allowed, 0 for the population's own",
                    hands, kMostHands));
  }
  if (!(mass >= 0.0 && mass <= 100.0)) {
    throw UsageError(fmt::format("setting \"mass\" is {:g}; 0 to 100 kg is allowed", mass));
  }
  if (int(grip_force.has_value()) + int(strength_share.has_value()) + int(limit_depths) > 1) {
    throw UsageError(
        "more than one of setting \"grip force\", setting \"strength share\" and setting \"limit "
        "depths\" is given; one is allowed");
  }
  if (grip_force && !(*grip_force >= 0.1 && *grip_force <= 5000.0)) {
    throw UsageError(
        fmt::format("setting \"grip force\" is {:g}; 0.1 to 5000 N is allowed", *grip_force));
  }
  if (strength_share && !(*strength_share >= 0.001 && *strength_share <= 1.0)) {
    throw UsageError(
        fmt::format("setting \"strength share\" is {:g}; 0.001 to 1 is allowed", *strength_share));
  }
}

records::StudyRequest study_of(const QuickStudy& quick) {
  quick.check();
  records::StudyRequest request;
  request.name = fs::path(quick.products.front()).stem().string();
  for (const std::string& name : quick.products) {
    records::ProductRequest product;
    product.file = name;
    product.unit = quick.unit;
    product.held.holding = quick.holding;
    product.held.mass = quick.mass;
    request.products.push_back(std::move(product));
  }
  for (const std::string& name : quick.populations) {
    if (quick.hands > 0 && records::is_people_range(name)) {
      throw UsageError("setting \"hands\" has no meaning with the given people \"" + name + "\"");
    }
    for (records::PopulationRequest& one : records::population_requests(name)) {
      request.populations.push_back(std::move(one));
    }
  }
  for (records::PopulationRequest& one : request.populations) {
    if (quick.hands > 0 && !one.table.empty()) {
      throw UsageError("setting \"hands\" has no meaning with the given hands of " + one.table);
    }
    if (quick.hands > 0) one.sampling.hands = quick.hands;
  }
  for (const std::string& name : quick.profiles)
    request.profiles.push_back(population::profile_named(name));
  for (const std::string& name : quick.grips)
    request.grips.push_back(records::asked_grip_named(name));
  if (!quick.hand.empty()) request.hand = quick.hand;
  const bool is_usual = quick.task == grasp::HandTask::kUsual && !quick.turn;
  if (quick.grip_force || quick.strength_share || quick.limit_depths || !is_usual) {
    study::StudySetting setting;
    setting.task = quick.task;
    setting.turn = quick.turn;
    setting.grip_force = quick.grip_force;
    setting.strength_share = quick.strength_share;
    setting.limit_depths = quick.limit_depths;
    request.settings.push_back(std::move(setting));
  }
  return request;
}

records::LoadedStudy load_study(const records::StudyRequest& request, const NoteSink& note) {
  records::LoadedStudy study = load_study(request, load_hand(request.hand));
  for (const std::string& text : study.notes) note_to(note, text);
  return study;
}

StudyPlanOutcome plan_study(const StudyPlanRequest& request, const Progress& progress) {
  const records::LoadedStudy study = load_study(request.study, request.note);
  progress.throw_if_cancelled();
  StudyPlanOutcome outcome;
  outcome.plan = study.plan;
  outcome.threads = std::min<int>(thread_count(), static_cast<int>(study.plan.hands.size()));
  if (request.has_sample) outcome.estimate = estimate_study(study, progress);
  return outcome;
}

void StudyRunRequest::check() const { shard.check(); }

StudyRunOutcome run_study(const StudyRunRequest& request, const Progress& progress) {
  request.check();
  const study::StudyShard shard = request.shard;
  const records::LoadedStudy study = load_study(request.study, request.note);
  study::tasks_of(study.plan,
                  shard);  // more shards than hands are refused before anything is written
  progress.throw_if_cancelled();
  const fs::path path =
      request.out.empty() ? fs::path(default_store(study.plan, shard)) : request.out;
  if (path.has_parent_path()) formats::create_folder(path.parent_path());
  if (!fs::exists(path)) records::StudyStore::create(path, study.plan, study.inputs, shard);
  records::StudyStore store(path, records::StudyAccess::kWrite);
  check_same(store, study.plan, shard);
  if (!store.is_finished()) check_program(store);
  const std::size_t done = store.done().size();
  if (done > 0 && !store.is_finished()) {
    note_to(request.note, fmt::format("{}: continues after {} grasps", path.string(), done));
  }
  return run_rest(store, study.inputs, request.note, progress);
}

StudyRunOutcome resume_study(const fs::path& path, const NoteSink& note, const Progress& progress) {
  records::StudyStore store(path, records::StudyAccess::kWrite);
  if (store.is_finished()) {
    note_to(note, path.string() + ": is finished; nothing to do");
    return run_rest(store, {}, note, progress);
  }
  check_program(store);
  records::check_products(store.plan(), path.parent_path());
  return run_rest(store, store.inputs(), note, progress);
}

}  // namespace palmar::workflow
