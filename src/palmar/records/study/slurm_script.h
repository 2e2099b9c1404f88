// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace palmar::records {

/// A study as a Slurm job array: one task per shard.
struct SlurmArray {
  std::string name;               ///< of the study
  std::filesystem::path program;  ///< palmar, as the nodes see it
  std::filesystem::path file;     ///< study file; absolute
  std::filesystem::path folder;   ///< for stores and logs; absolute, seen by all nodes
  int shards = 1;
  int cores = 1;                     ///< per task
  double seconds = 600.0;            ///< asked for, per task
  double memory = 1000.0;            ///< MB, asked for, per task
  std::uint64_t seed = 0;            ///< 0: as in the file
  std::vector<std::string> options;  ///< further ones of sbatch: "--partition=long"
  void check() const;                ///< throws UsageError
};

/// The batch script: each task is `palmar study run --shard k/n`, which goes on where its store
/// stopped, and is put into the queue again when its node fails.
std::string slurm_script(const SlurmArray& array);

/// Hands the script to sbatch and gives back the job's number. Throws OutputError: sbatch refuses,
/// with its words; ProgramMissing if there is no sbatch on PATH.
std::string submit_to_slurm(const std::filesystem::path& script);

}  // namespace palmar::records
