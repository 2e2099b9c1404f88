// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "palmar/core/progress.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/workflow/assess.h"

namespace palmar::workflow {

/// A project file of the workbench (.palmar-project), taken as the bench takes it.
struct BenchAssessRequest {
  std::filesystem::path file;
  std::optional<double> grip_force;  ///< N, over the file's; not of a pose that is taken as placed
  grasp::FrictionSettings friction;  ///< mass and friction, which the file doesn't say
  /// Of the report alone: language, out, pictures, pdf, extras, seed, command_line, note.
  AssessRequest report;
};

/// The figures that the workbench shows for that project, to the last digit: the hold as it is
/// found, the pose as it was placed, or what came of it when the hand closed or came to rest.
/// Throws InputError naming the file and what is wrong with it, UsageError for a grip force of a
/// pose that is taken as placed, OutputError, Cancelled.
AssessOutcome assess_bench_project(const BenchAssessRequest& request,
                                   const Progress& progress = {});

/// Whether the path has the ending of such a file.
bool is_bench_project(const std::filesystem::path& file);

}  // namespace palmar::workflow
