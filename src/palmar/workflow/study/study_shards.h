// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/study/study_plan.h"

namespace palmar::workflow {

struct StudyMergeOutcome {
  study::StudyPlan plan;
  std::size_t shards = 0;
  std::string digest;  ///< of all results
};

/// Joins finished shards, given as files or as folders that hold them, to the store that one
/// process would have written: merge_studies(), which says what it throws.
StudyMergeOutcome merge_shards(const std::vector<std::filesystem::path>& shards,
                               const std::filesystem::path& out, const Progress& progress = {});

/// How far one store is.
struct StudyStoreState {
  std::filesystem::path path;
  std::string state;   ///< "finished", "running", "stopped", "damaged", "unreadable"
  std::string detail;  ///< who runs it, or what is wrong with it; may be empty
  study::StudyShard shard;
  std::int64_t done = 0, total = 0;
  std::map<std::string, std::int64_t> outcomes;  ///< by name
  std::map<std::string, std::int64_t> reasons;   ///< of failed grasps
  std::optional<double> seconds_left;            ///< of a running one
};

struct StudyStatus {
  std::vector<StudyStoreState> stores;
  std::vector<std::string> absent_shards;  ///< that others speak of but that have no store: "2/4"
  std::int64_t done = 0, total = 0, failed = 0;  ///< grasps of all stores
  bool is_sound() const;                         ///< no store is damaged or unreadable
};

/// How far a study is, over stores and folders that hold some. What is wrong with a store is
/// reported in its state. Throws InputError if there is none.
StudyStatus study_status(const std::vector<std::filesystem::path>& stores);

}  // namespace palmar::workflow
