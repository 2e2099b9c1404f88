// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/core/program_folder.h"
#include "palmar/workflow/study/study_submit.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

struct SubmitArguments {
  workflow::StudySubmitRequest request;
  std::string out;
};

int run_submit(const SubmitArguments& arguments, const Context& context) {
  workflow::StudySubmitRequest request = arguments.request;
  request.folder = arguments.out;
  if (request.program.empty()) request.program = program_file();
  request.seed = context.common.seed;
  request.note = [&context](const std::string& text) { note(context.common, text); };
  const workflow::StudySubmitOutcome outcome =
      workflow::submit_study(request, make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    const nlohmann::ordered_json json = {{"job", outcome.job},
                                         {"script", outcome.script},
                                         {"shards", outcome.array.shards},
                                         {"seconds_expected_per_shard", outcome.seconds_expected},
                                         {"seconds_asked", outcome.array.seconds},
                                         {"memory_asked_mb", outcome.array.memory}};
    print(json.dump(2) + "\n");
  } else if (request.is_dry) {
    print(outcome.script);
  } else {
    print(
        fmt::format("{}\njob {}: {} shards in {}\npalmar study status {}    shows how far they "
                    "are\npalmar study merge {} --out study.palmar    joins them\n",
                    study_size_text(outcome.plan), outcome.job, outcome.array.shards,
                    outcome.array.folder.string(), arguments.out, arguments.out));
  }
  return 0;
}

}  // namespace

void add_study_submit_command(CLI::App& noun, Context& context) {
  const auto options = std::make_shared<SubmitArguments>();
  CLI::App* verb =
      add_verb(noun, "submit", "Run a study's shards as a Slurm job array",
               "palmar study submit examples/three-handles/study.toml --shards 20 --out shards "
               "--sbatch=--partition=long");
  verb->add_option("FILE", options->request.file,
                   "Study file, in a folder that is visible to all nodes")
      ->required();
  verb->add_option("--shards", options->request.shards, "Tasks of the job array")
      ->required()
      ->check(CLI::Range(1, 100'000));
  verb->add_option("--out", options->out, "Folder for the shards' stores, logs and the script")
      ->required();
  verb->add_flag("--dry-run", options->request.is_dry,
                 "Print the script; write and submit nothing");
  verb->add_option("--cores", options->request.cores, "Cores per shard")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  verb->add_option("--minutes", options->request.minutes,
                   "Time limit per shard; default: three times the estimate from sample grasps");
  verb->add_option(
      "--memory-mb", options->request.memory,
      "Memory limit per shard; default: one and a half times that of the sample grasps");
  verb->add_option("--palmar", options->request.program,
                   "Path of the program on the nodes; default: this one");
  verb->add_option(
          "--sbatch", options->request.options,
          "Further option of sbatch, as in --sbatch=--partition=long; may be given several "
          "times")
      ->allow_extra_args(false);
  verb->callback([&context, options] {
    context.run = [&context, options] { return run_submit(*options, context); };
  });
}

}  // namespace palmar::cli
