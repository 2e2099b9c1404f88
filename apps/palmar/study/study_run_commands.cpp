// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/study/study_progress.h"
#include "palmar/records/study/study_store.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

constexpr double kNoteInterval = 2.0;  // s between two notes of how far a study is

/// Keeps finished grasps and tells from time to time how far the study is.
class Keeper {
 public:
  Keeper(StudyStore& store, std::size_t rest) : store_(store) {
    note_.shard = store.shard();
    note_.total = static_cast<std::int64_t>(tasks_of(store.plan(), store.shard()).size());
    note_.done = note_.done_before = note_.total - static_cast<std::int64_t>(rest);
    write_study_progress(store.path(), note_);
  }
  void keep(const StudyRecord& record) {
    store_.keep(record);
    ++note_.done;
    ++note_.outcomes[name_of(record.outcome)];
    if (record.outcome == StudyOutcome::kFailed) ++note_.reasons[record.reason];
    note_.seconds = seconds();
    const bool is_first = note_.done == note_.done_before + 1;
    if (!is_first && note_.seconds - last_ < kNoteInterval) return;
    last_ = note_.seconds;
    write_study_progress(store_.path(), note_);
  }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  const StudyProgressNote& note() const { return note_; }

 private:
  StudyStore& store_;
  StudyProgressNote note_;
  Clock::time_point start_ = Clock::now();
  double last_ = 0.0;
};

std::string summary_text(const StudyStore& store,
                         const std::map<StudyOutcome, std::int64_t>& outcomes,
                         const std::map<std::string, std::int64_t>& reasons) {
  const StudyShard shard = store.shard();
  std::string text = fmt::format("{}: {}", store.plan().name, study_size_text(store.plan()));
  if (shard.n > 1) text += fmt::format(", shard {}", name_of(shard));
  std::string list;
  for (const auto& [outcome, count] : outcomes) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, name_of(outcome));
  }
  text += "\n" + list + "\n";
  for (const auto& [reason, count] : reasons) {
    text += fmt::format("  failed: {} ({})\n", reason, count);
  }
  return text + fmt::format("results {}\n{}\n", store.digest(), store.path().string());
}

/// Runs what is missing, finishes the store and says what came of it.
int run_rest(StudyStore& store, const StudyInputs& inputs, const Context& context) {
  const Progress progress = make_progress(context.common);
  const std::vector<std::int64_t> rest = store.missing();
  if (store.is_finished() && !rest.empty()) {
    throw InputError(store.path().string() + ": is damaged: " + missing_text(rest) +
                     "; delete it and run the study anew");
  }
  Keeper keeper(store, rest.size());
  try {
    run_study(
        store.plan(), inputs, {.tasks = rest},
        [&](const StudyRecord& record) { keeper.keep(record); }, progress);
  } catch (const Cancelled&) {
    remove_study_progress(store.path());
    finish_progress();
    throw Cancelled(
        fmt::format("cancelled; {} of {} grasps are kept; `palmar study resume {}` "
                    "goes on",
                    keeper.note().done, keeper.note().total, store.path().string()));
  } catch (...) {
    remove_study_progress(store.path());
    throw;
  }
  const double spent = keeper.seconds();
  if (progress.report) progress.report(1.0, "closing the study");
  store.finish();
  remove_study_progress(store.path());
  finish_progress();

  std::map<StudyOutcome, std::int64_t> outcomes;
  std::map<std::string, std::int64_t> reasons;
  store.for_each(false, [&](const StudyRecord& record) {
    ++outcomes[record.outcome];
    if (record.outcome == StudyOutcome::kFailed) ++reasons[record.reason];
  });
  if (context.common.json) {
    Json counts = Json::object(), failed = Json::object();
    for (const auto& [outcome, count] : outcomes) counts[name_of(outcome)] = count;
    for (const auto& [reason, count] : reasons) failed[reason] = count;
    const Json json = {
        {"study", store.plan().name},      {"store", store.path().string()},
        {"shard", name_of(store.shard())}, {"grasps", tasks_of(store.plan(), store.shard()).size()},
        {"run_now", rest.size()},          {"outcomes", std::move(counts)},
        {"failed", std::move(failed)},     {"seconds", spent},
        {"results_sha256", store.digest()}};
    print(json.dump(2) + "\n");
  } else {
    print(summary_text(store, outcomes, reasons));
    if (!rest.empty()) {
      note(context.common, fmt::format("{} grasps in {}", rest.size(), duration_text(spent)));
    }
  }
  return 0;
}

std::string default_store(const StudyPlan& plan, StudyShard shard) {
  std::string name = plan.name;
  std::replace(name.begin(), name.end(), '/', '_');
  if (shard.n > 1) name += fmt::format("-{}-of-{}", shard.k, shard.n);
  return name + ".palmar";
}

/// Refuses to go on with a store that is of something else.
void check_same(const StudyStore& store, const StudyPlan& plan, StudyShard shard) {
  const std::string name = store.path().string();
  if (store.shard() != shard) {
    throw UsageError(
        fmt::format("{}: holds shard {}, not {}", name, name_of(store.shard()), name_of(shard)));
  }
  const std::vector<std::string> differences = plan_differences(store.plan(), plan);
  if (differences.empty()) return;
  std::string text = name + ": holds another study than the one asked for:";
  for (const std::string& one : differences) text += "\n  " + one;
  throw UsageError(text + "\nGive another --out, or delete the file to begin anew.");
}

void check_program(const StudyStore& store) {
  if (store.program() == version()) return;
  throw UsageError(fmt::format("{}: was begun by Palmar {}; this is {}, whose results may differ",
                               store.path().string(), store.program(), version()));
}

struct RunArguments {
  StudyArguments study;
  std::string out, shard;
};

int run_run(const RunArguments& arguments, const Context& context) {
  const StudyShard shard = parse_shard(arguments.shard);
  const LoadedStudy study = arguments.study.load(context);
  tasks_of(study.plan, shard);  // more shards than hands are refused before anything is written
  const fs::path path = arguments.out.empty() ? default_store(study.plan, shard) : arguments.out;
  if (path.has_parent_path()) create_folder(path.parent_path());
  if (!fs::exists(path)) StudyStore::create(path, study.plan, study.inputs, shard);
  StudyStore store(path, StudyAccess::kWrite);
  check_same(store, study.plan, shard);
  if (!store.is_finished()) check_program(store);
  const std::size_t done = store.done().size();
  if (done > 0 && !store.is_finished()) {
    note(context.common, fmt::format("{}: goes on after {} grasps", path.string(), done));
  }
  return run_rest(store, study.inputs, context);
}

int run_resume(const std::string& path, const Context& context) {
  StudyStore store(path, StudyAccess::kWrite);
  if (store.is_finished()) {
    note(context.common, path + ": is finished; nothing to do");
    return run_rest(store, {}, context);
  }
  check_program(store);
  check_products(store.plan(), fs::path(path).parent_path());
  return run_rest(store, store.inputs(), context);
}

int run_plan(const StudyArguments& arguments, bool no_sample, const Context& context) {
  const LoadedStudy study = arguments.load(context);
  const StudyPlan& plan = study.plan;
  std::optional<StudyEstimate> estimate;
  const int threads = std::min<int>(thread_count(), static_cast<int>(plan.hands.size()));
  if (!no_sample) {
    const Progress progress = make_progress(context.common);
    estimate = estimate_study(study, progress);
    finish_progress();
  }
  const auto hands = static_cast<std::int64_t>(plan.hands.size());
  if (context.common.json) {
    Json json = Json::parse(format_plan(plan));
    json["grasps"] = task_count(plan);
    if (estimate) {
      json["threads"] = threads;
      json["estimated_seconds"] = estimate->seconds(hands, threads);
      json["estimated_memory_mb"] = estimate->memory(threads);
    }
    print(json.dump(2) + "\n");
    return 0;
  }
  std::string text = fmt::format("{}: {}\n", plan.name, study_size_text(plan));
  for (std::size_t p = 0; p < plan.populations.size(); ++p) {
    const StudyPopulation& one = plan.populations[p];
    const auto count = std::count_if(plan.hands.begin(), plan.hands.end(), [&](const auto& hand) {
      return hand.population == static_cast<int>(p);
    });
    text += fmt::format("  population {:<24} {} hand{}\n", one.population.name, count,
                        count == 1 ? "" : "s");
  }
  for (const HandProfile& one : plan.profiles) text += fmt::format("  profile    {}\n", one.name);
  for (const StudyProduct& one : plan.products) {
    text += fmt::format("  product    {:<24} {}{}\n", one.name, one.file,
                        one.posture_of.empty() ? "" : " (posture of " + one.posture_of + ")");
  }
  for (const auto& one : plan.grips) {
    text += fmt::format("  grip       {}\n", one ? name_of(*one) : "auto");
  }
  for (const StudySetting& one : plan.settings) {
    text += fmt::format("  setting    {:<24} {}{}\n", one.name, name_of(one.model),
                        one.indices ? "" : ", no indices");
  }
  if (estimate) {
    text += fmt::format(
        "about {} on {} thread{}, {:.0f} MB (measured on {} grasp{}, {} on one thread)\n",
        duration_text(estimate->seconds(hands, threads)), threads, threads == 1 ? "" : "s",
        estimate->memory(threads), estimate->sample, estimate->sample == 1 ? "" : "s",
        duration_text(estimate->seconds(hands, 1)));
  }
  print(text);
  return 0;
}

}  // namespace

void add_study_run_commands(CLI::App& noun, Context& context) {
  const auto plan_options = std::make_shared<StudyArguments>();
  const auto no_sample = std::make_shared<bool>(false);
  CLI::App* plan = add_verb(noun, "plan", "Say what would run, how long and in how much memory",
                            "palmar study plan handles.toml");
  plan_options->add_to(*plan);
  plan->add_flag("--no-sample", *no_sample, "Don't measure a few grasps for the estimate");
  plan->callback([&context, plan_options, no_sample] {
    context.run = [&context, plan_options, no_sample] {
      return run_plan(*plan_options, *no_sample, context);
    };
  });

  const auto run_options = std::make_shared<RunArguments>();
  CLI::App* run = add_verb(
      noun, "run", "Run a study, or go on with it where its store is there",
      "palmar study run --product a.stl --product b.stl --unit mm --population ansur2_women "
      "--hands 30 --out study.palmar");
  run_options->study.add_to(*run);
  run->add_option("--out", run_options->out,
                  "Store to write; if it is there and of this study, what is missing is run");
  run->add_option("--shard", run_options->shard,
                  "k/n: only every n-th hand, from the k-th; `study merge` joins the shards");
  run->callback([&context, run_options] {
    context.run = [&context, run_options] { return run_run(*run_options, context); };
  });

  const auto path = std::make_shared<std::string>();
  CLI::App* resume = add_verb(noun, "resume", "Go on with a study that was stopped",
                              "palmar study resume study.palmar");
  resume->add_option("STORE", *path, "Store of the study")->required();
  resume->callback(
      [&context, path] { context.run = [&context, path] { return run_resume(*path, context); }; });
}

}  // namespace palmar::cli
