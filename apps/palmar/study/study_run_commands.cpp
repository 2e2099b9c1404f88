// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/workflow/study/study.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
std::string summary_text(const workflow::StudyRunOutcome& outcome) {
  std::string text = fmt::format("{}: {}", outcome.plan.name, study_size_text(outcome.plan));
  if (outcome.shard.n > 1) text += fmt::format(", shard {}", name_of(outcome.shard));
  std::string list;
  for (const auto& [how, count] : outcome.outcomes) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", count, name_of(how));
  }
  text += "\n" + list + "\n";
  for (const auto& [reason, count] : outcome.reasons) {
    text += fmt::format("  failed: {} ({})\n", reason, count);
  }
  return text + fmt::format("results {}\n{}\n", outcome.digest, outcome.store.string());
}

Json summary_object(const workflow::StudyRunOutcome& outcome) {
  Json counts = Json::object(), failed = Json::object();
  for (const auto& [how, count] : outcome.outcomes) counts[name_of(how)] = count;
  for (const auto& [reason, count] : outcome.reasons) failed[reason] = count;
  return {{"study", outcome.plan.name},      {"store", outcome.store.string()},
          {"shard", name_of(outcome.shard)}, {"grasps", outcome.grasps},
          {"run_now", outcome.run_now},      {"outcomes", std::move(counts)},
          {"failed", std::move(failed)},     {"seconds", outcome.seconds},
          {"results_sha256", outcome.digest}};
}

/// What came of a run, for people or programs.
int print_outcome(const workflow::StudyRunOutcome& outcome, const CommonOptions& common) {
  finish_progress();
  if (common.json) {
    print(summary_object(outcome).dump(2) + "\n");
    return 0;
  }
  print(summary_text(outcome));
  if (outcome.run_now > 0) {
    note(common, fmt::format("{} grasps in {}", outcome.run_now, duration_text(outcome.seconds)));
  }
  return 0;
}

workflow::NoteSink notes_of(const Context& context) {
  return [&context](const std::string& text) { note(context.common, text); };
}

struct RunArguments {
  StudyArguments study;
  std::string out, shard;
};

int run_run(const RunArguments& arguments, const Context& context) {
  workflow::StudyRunRequest request;
  request.shard = parse_shard(arguments.shard);
  request.study = arguments.study.request(context);
  request.out = arguments.out;
  request.note = notes_of(context);
  return print_outcome(run_study(request, make_progress(context.common)), context.common);
}

int run_resume(const std::string& path, const Context& context) {
  return print_outcome(
      workflow::resume_study(path, notes_of(context), make_progress(context.common)),
      context.common);
}

int run_plan(const StudyArguments& arguments, bool no_sample, const Context& context) {
  const workflow::StudyPlanRequest request{
      .study = arguments.request(context), .has_sample = !no_sample, .note = notes_of(context)};
  const workflow::StudyPlanOutcome outcome =
      workflow::plan_study(request, make_progress(context.common));
  finish_progress();
  const study::StudyPlan& plan = outcome.plan;
  const std::optional<workflow::StudyEstimate>& estimate = outcome.estimate;
  const int threads = outcome.threads;
  const auto hands = static_cast<std::int64_t>(plan.hands.size());
  if (context.common.json) {
    Json json = Json::parse(records::format_plan(plan));
    json["grasps"] = study::task_count(plan);
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
    const study::StudyPopulation& one = plan.populations[p];
    const auto count = std::count_if(plan.hands.begin(), plan.hands.end(), [&](const auto& hand) {
      return hand.population == static_cast<int>(p);
    });
    text += fmt::format("  population {:<24} {} hand{}\n", one.population.name, count,
                        count == 1 ? "" : "s");
  }
  for (const population::HandProfile& one : plan.profiles)
    text += fmt::format("  profile    {}\n", one.name);
  for (const study::StudyProduct& one : plan.products) {
    text += fmt::format("  product    {:<24} {}{}\n", one.name, one.file,
                        one.posture_of.empty() ? "" : " (posture of " + one.posture_of + ")");
  }
  for (const auto& one : plan.grips) {
    text += fmt::format("  grip       {}\n", one ? name_of(*one) : "auto");
  }
  for (const study::StudySetting& one : plan.settings) {
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
  CLI::App* plan = add_verb(noun, "plan", "Print what would run, how long and in how much memory",
                            "palmar study plan examples/three-handles/study.toml");
  plan_options->add_to(*plan);
  plan->add_flag("--no-sample", *no_sample, "Don't measure a few grasps for the estimate");
  plan->callback([&context, plan_options, no_sample] {
    context.run = [&context, plan_options, no_sample] {
      return run_plan(*plan_options, *no_sample, context);
    };
  });

  const auto run_options = std::make_shared<RunArguments>();
  CLI::App* run =
      add_verb(noun, "run", "Run a study, or continue it if its store exists",
               "palmar study run --product old.step --product new.step --population ansur2_women "
               "--hands 6 --out women.palmar");
  run_options->study.add_to(*run);
  run->add_option("--out", run_options->out,
                  "Store to write; an existing store of this study is continued");
  run->add_option("--shard", run_options->shard,
                  "k/n: only every n-th hand, from the k-th; `study merge` joins the shards");
  run->callback([&context, run_options] {
    context.run = [&context, run_options] { return run_run(*run_options, context); };
  });

  const auto path = std::make_shared<std::string>();
  CLI::App* resume = add_verb(noun, "resume", "Continue a study that was stopped",
                              "palmar study resume women.palmar");
  resume->add_option("STORE", *path, "Store of the study")->required();
  resume->callback(
      [&context, path] { context.run = [&context, path] { return run_resume(*path, context); }; });
}

}  // namespace palmar::cli
