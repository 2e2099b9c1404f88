// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "palmar/study/study_plan.h"

namespace palmar::records {

/// How far a running study is: a small file STORE-progress beside the store, which is locked
/// meanwhile. Gone once the run ends in order; after a kill it stays and counts for nothing.
struct StudyProgressNote {
  study::StudyShard shard;
  std::int64_t done = 0, total = 0;              ///< grasps, those of earlier runs included
  std::int64_t done_before = 0;                  ///< by earlier runs
  std::map<std::string, std::int64_t> outcomes;  ///< of this run, by name
  std::map<std::string, std::int64_t> reasons;   ///< of failed grasps of this run
  double seconds = 0.0;                          ///< since this run began
  std::int64_t updated = 0;                      ///< s since 1970
  std::string host;
  std::int64_t process = 0;
};

std::filesystem::path progress_path(const std::filesystem::path& store);
/// Fills in time, host and process. Never throws: not being able to determine is no reason to stop.
void write_study_progress(const std::filesystem::path& store, StudyProgressNote note);
/// Nothing if there is none or it can't be read.
std::optional<StudyProgressNote> read_study_progress(const std::filesystem::path& store);
void remove_study_progress(const std::filesystem::path& store);

}  // namespace palmar::records
