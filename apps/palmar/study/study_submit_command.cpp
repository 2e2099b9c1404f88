// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/file.h"
#include "palmar/records/study/slurm_script.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

// What is asked for over what was measured: another machine, other hands, a busy disk.
constexpr double kTimeReserve = 3.0;
constexpr double kLeastTime = 300.0;  // s
constexpr double kMemoryReserve = 1.5;
constexpr double kLeastMemory = 300.0;  // MB

struct SubmitArguments {
  StudyArguments study;
  int shards = 0, cores = 1;
  std::string out, program;
  bool is_dry = false;
  std::optional<double> minutes, memory_mb;
  std::vector<std::string> options;
};

int run_submit(const SubmitArguments& arguments, const Context& context) {
  const LoadedStudy study = arguments.study.load(context);
  const StudyShard first{1, arguments.shards};
  tasks_of(study.plan, first);  // refuses more shards than hands
  SlurmArray array;
  array.name = study.plan.name;
  array.program =
      arguments.program.empty() ? fs::read_symlink("/proc/self/exe") : fs::path(arguments.program);
  array.file = fs::absolute(arguments.study.file);
  array.folder = fs::absolute(arguments.out);
  array.shards = arguments.shards;
  array.cores = arguments.cores;
  array.seed = context.common.seed;
  array.options = arguments.options;
  array.check();

  StudyEstimate estimate;
  if (!arguments.minutes || !arguments.memory_mb) {
    const Progress progress = make_progress(context.common);
    estimate = estimate_study(study, progress);
    finish_progress();
  }
  const auto hands = static_cast<std::int64_t>(study.plan.hands.size());
  const std::int64_t hands_per_shard = (hands + array.shards - 1) / array.shards;
  const double expected = estimate.seconds(hands_per_shard, array.cores);
  array.seconds =
      arguments.minutes ? 60.0 * *arguments.minutes : std::max(kLeastTime, kTimeReserve * expected);
  array.memory = arguments.memory_mb
                     ? *arguments.memory_mb
                     : std::max(kLeastMemory, kMemoryReserve * estimate.memory(array.cores));

  const std::string script = slurm_script(array);
  std::string job;
  const fs::path path = array.folder / "submit.sh";
  if (!arguments.is_dry) {
    create_folder(array.folder);
    write_file(path, script);
    job = submit_to_slurm(path);
  }
  if (context.common.json) {
    const nlohmann::ordered_json json = {{"job", job},
                                         {"script", script},
                                         {"shards", array.shards},
                                         {"seconds_expected_per_shard", expected},
                                         {"seconds_asked", array.seconds},
                                         {"memory_asked_mb", array.memory}};
    print(json.dump(2) + "\n");
  } else if (arguments.is_dry) {
    print(script);
  } else {
    print(
        fmt::format("{}\njob {}: {} shards in {}\n"
                    "palmar study status {}    tells how far they are\n"
                    "palmar study merge {} --out study.palmar    joins them\n",
                    study_size_text(study.plan), job, array.shards, array.folder.string(),
                    arguments.out, arguments.out));
  }
  return 0;
}

}  // namespace

void add_study_submit_command(CLI::App& noun, Context& context) {
  const auto options = std::make_shared<SubmitArguments>();
  CLI::App* verb = add_verb(noun, "submit", "Run a study's shards as a Slurm job array",
                            "palmar study submit handles.toml --shards 20 --out shards "
                            "--sbatch=--partition=long");
  verb->add_option("FILE", options->study.file, "Study file, in a folder that all nodes see")
      ->required();
  verb->add_option("--shards", options->shards, "Tasks of the job array")
      ->required()
      ->check(CLI::Range(1, 100'000));
  verb->add_option("--out", options->out, "Folder for the shards' stores, logs and the script")
      ->required();
  verb->add_flag("--dry-run", options->is_dry, "Print the script; write and submit nothing");
  verb->add_option("--cores", options->cores, "Cores per shard")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  verb->add_option("--minutes", options->minutes,
                   "Time to ask for per shard; else three times what a sample grasp suggests");
  verb->add_option("--memory-mb", options->memory_mb,
                   "Memory to ask for per shard; else one and a half times that of a sample");
  verb->add_option("--palmar", options->program, "The program as the nodes see it; else this one");
  verb->add_option(
          "--sbatch", options->options,
          "Further option of sbatch, as in --sbatch=--partition=long; may be given several "
          "times")
      ->allow_extra_args(false);
  verb->callback([&context, options] {
    context.run = [&context, options] { return run_submit(*options, context); };
  });
}

}  // namespace palmar::cli
