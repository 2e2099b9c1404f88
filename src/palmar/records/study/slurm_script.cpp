// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/slurm_script.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <system_error>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/records/fe/tetgen.h"

namespace palmar::records {
namespace {

// Named by array and shard: the job number of an array's last task is that of the whole array.
constexpr int kMostRestarts = 5;  // of a task that was killed

/// One word for bash, whatever is in it.
std::string single_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c;
    }
  }
  return result + "'";
}

/// Letters, digits, '-', '_' and '.' only: for the job's name.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    result += is_plain ? c : '_';
  }
  return result;
}

}  // namespace

void SlurmArray::check() const {
  const auto range = [](const std::string& what, double value, double lowest, double highest) {
    if (value >= lowest && value <= highest) return;
    throw UsageError(
        fmt::format("submit: {} is {:g}; {:g} to {:g} is allowed", what, value, lowest, highest));
  };
  range("number of shards", shards, 1, 100'000);
  range("cores per shard", cores, 1, 1024);
  range("time per shard (s)", seconds, 1, 3e7);
  range("memory per shard (MB)", memory, 1, 1e7);
  for (const std::string& option : options) {
    if (option.rfind('-', 0) != 0 || option.find('\n') != option.npos) {
      throw UsageError("submit: \"" + option + "\" is no option of sbatch, as --partition=long is");
    }
  }
  for (const auto* path : {&program, &file, &folder}) {
    if (path->string().find('\n') != std::string::npos) {
      throw UsageError("submit: a path with a line break can't be in a batch script");
    }
  }
}

std::string slurm_script(const SlurmArray& array) {
  array.check();
  const auto minutes = static_cast<long long>(std::ceil(array.seconds / 60.0));
  const std::string folder = array.folder.string();
  std::string text = "#!/bin/bash\n";
  const auto directive = [&](const std::string& option) { text += "#SBATCH " + option + "\n"; };
  directive("--job-name=palmar-" + plain(array.name));
  directive(fmt::format("--array=1-{}", array.shards));
  directive("--ntasks=1");
  directive(fmt::format("--cpus-per-task={}", array.cores));
  directive(fmt::format("--time={:02}:{:02}:00", minutes / 60, minutes % 60));
  directive(fmt::format("--mem={}M", static_cast<long long>(std::ceil(array.memory))));
  directive("--requeue");
  directive("--open-mode=append");
  directive("--output=\"" + folder + "/shard-%a.log\"");
  for (const std::string& option : array.options) directive(option);
  text += fmt::format(
      "\n# One task per shard. All done: palmar study merge {0} --out study.palmar\nset "
      "-u\nfolder={0}\nshard=$SLURM_ARRAY_TASK_ID\ncode=0\n{1} study run {2} --quiet{3} \\\n  "
      "--shard \"$shard/{4}\" --threads \"${{SLURM_CPUS_PER_TASK:-1}}\" \\\n  --out "
      "\"$folder/shard-$shard-of-{4}.palmar\" || code=$?\n# Killed (out of memory, say): into the "
      "queue once more, to continue where the store stopped.\nif [ \"$code\" = 137 ] && [ "
      "\"${{SLURM_RESTART_COUNT:-0}}\" -lt {5} ]; then\n  scontrol requeue "
      "\"${{SLURM_ARRAY_JOB_ID}}_$shard\" && sleep 60\nfi\nexit \"$code\"\n",
      single_quoted(folder), single_quoted(array.program.string()),
      single_quoted(array.file.string()),
      array.seed == 0 ? "" : fmt::format(" --seed {}", array.seed), array.shards, kMostRestarts);
  return text;
}

std::string submit_to_slurm(const std::filesystem::path& script) {
  const auto sbatch = formats::find_program("sbatch");
  if (!sbatch) {
    throw formats::ProgramMissing(
        "sbatch is not on PATH: Slurm is not installed here. Any other batch system runs the same "
        "shards: palmar study run FILE --shard k/n --out shard-k-of-n.palmar");
  }
  const std::filesystem::path folder = script.parent_path();
  const std::string log = "sbatch.log";
  const int code = formats::run_program(*sbatch, {"--parsable", script.string()}, folder, log);
  std::string said;
  try {
    said = formats::read_file(folder / log);
  } catch (const InputError&) {
    said.clear();  // sbatch said nothing
  }
  while (!said.empty() && (said.back() == '\n' || said.back() == ' ')) said.pop_back();
  if (code != 0) {
    throw OutputError(
        fmt::format("sbatch refuses {} (exit code {}): {}", script.string(), code, said));
  }
  std::error_code ignored;
  std::filesystem::remove(folder / log, ignored);
  return said.substr(0, said.find(';'));
}

}  // namespace palmar::records
