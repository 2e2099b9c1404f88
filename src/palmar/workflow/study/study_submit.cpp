// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study_submit.h"

#include <algorithm>

#include "palmar/formats/file.h"
#include "palmar/records/study/study_file.h"
#include "palmar/workflow/study/study.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;

// What is asked for over what was measured: another machine, other hands, a busy disk.
constexpr double kTimeReserve = 3.0;
constexpr double kLeastTime = 300.0;  // s
constexpr double kMemoryReserve = 1.5;
constexpr double kLeastMemory = 300.0;  // MB

}  // namespace

StudySubmitOutcome submit_study(const StudySubmitRequest& request, const Progress& progress) {
  records::StudyRequest asked = records::read_study_file(request.file.string());
  if (request.seed != 0) asked.seed = request.seed;
  const records::LoadedStudy study = load_study(asked, request.note);
  study::tasks_of(study.plan, {1, request.shards});  // refuses more shards than hands
  progress.throw_if_cancelled();
  StudySubmitOutcome outcome;
  outcome.plan = study.plan;
  records::SlurmArray& array = outcome.array;
  array.name = study.plan.name;
  array.program = request.program;
  array.file = fs::absolute(request.file);
  array.folder = fs::absolute(request.folder);
  array.shards = request.shards;
  array.cores = request.cores;
  array.seed = request.seed;
  array.options = request.options;
  array.check();

  StudyEstimate estimate;
  if (!request.minutes || !request.memory) estimate = estimate_study(study, progress);
  const auto hands = static_cast<std::int64_t>(study.plan.hands.size());
  const std::int64_t hands_per_shard = (hands + array.shards - 1) / array.shards;
  outcome.seconds_expected = estimate.seconds(hands_per_shard, array.cores);
  array.seconds = request.minutes ? 60.0 * *request.minutes
                                  : std::max(kLeastTime, kTimeReserve * outcome.seconds_expected);
  array.memory = request.memory
                     ? *request.memory
                     : std::max(kLeastMemory, kMemoryReserve * estimate.memory(array.cores));
  outcome.script = records::slurm_script(array);
  if (request.is_dry) return outcome;
  const fs::path path = array.folder / "submit.sh";
  formats::create_folder(array.folder);
  formats::write_file(path, outcome.script);
  outcome.job = records::submit_to_slurm(path);
  return outcome;
}

}  // namespace palmar::workflow
