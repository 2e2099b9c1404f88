// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "palmar/server/job_shelf.h"

namespace palmar::server {

inline constexpr const char* kJobJson = "job.json";

/// Writes a job's state into its folder, under a temporary name that is renamed. Throws
/// OutputError.
void write_job(const std::filesystem::path& folder, const Job& job);
/// Without key; products at their places in the folder. Nothing if there is none of ours.
std::optional<Job> read_job(const std::filesystem::path& folder);

/// What a program that is watched says about where it stands: a line "progress SHARE DOING".
struct SaidProgress {
  double share = 0.0;
  std::string doing;
};
std::optional<SaidProgress> progress_in(const std::string& line);

/// What `palmar study plan --json` says, line by line: lines of a child process may be cut off.
struct StudyEstimateWords {
  std::optional<double> seconds;
  std::int64_t grasps = 0;
};
StudyEstimateWords study_estimate_in(std::string_view lines);

/// As the API gives it: {"key", "kind", "title", "state", ...}.
/// `files` and `made` as JobShelf says.
std::string job_answer(const Job& job, const std::vector<std::string>& files,
                       const std::vector<std::string>& made);

}  // namespace palmar::server
