// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/records/study/slurm_script.h"
#include "palmar/study/study_plan.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// A study's shards as a Slurm job array.
struct StudySubmitRequest {
  std::filesystem::path file;     ///< study file, in a folder that all nodes see
  std::filesystem::path folder;   ///< for the shards' stores, logs and the script
  std::filesystem::path program;  ///< palmar, as the nodes see it
  int shards = 1;                 ///< tasks of the array
  int cores = 1;                  ///< per shard
  std::uint64_t seed = 0;         ///< 0: as in the file
  // To ask for per shard; unset: several times what a few grasps took here, since nodes, hands and
  // disks differ: three times as long, one and a half times the memory.
  std::optional<double> minutes;
  std::optional<double> memory;      ///< MB
  std::vector<std::string> options;  ///< further ones of sbatch: "--partition=long"
  bool is_dry = false;               ///< nothing is written or submitted
  NoteSink note = {};                ///< proposed units, cautions of populations
};

struct StudySubmitOutcome {
  study::StudyPlan plan;
  records::SlurmArray array;      ///< with the time and memory asked for
  double seconds_expected = 0.0;  ///< of one shard; 0 if nothing was measured
  std::string script;
  std::string job;  ///< its number; "" of a dry run
};

/// Throws UsageError (more shards than hands, options that can't be), InputError, OutputError.
StudySubmitOutcome submit_study(const StudySubmitRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
