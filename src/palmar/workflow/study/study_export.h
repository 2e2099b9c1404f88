// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "palmar/core/progress.h"

namespace palmar::workflow {

struct StudyExportRequest {
  std::filesystem::path store;
  std::filesystem::path folder;  ///< to write to
  bool with_fields = false;      ///< also pressures of every loaded vertex: large files
};
struct StudyExportOutcome {
  std::vector<std::filesystem::path> files;
  std::size_t missing = 0;  ///< grasps that aren't run yet: the tables hold what is finished
  std::string digest;       ///< of all results; "" if any is missing
};
/// Every table of a study as CSV. Throws InputError, OutputError, Cancelled.
StudyExportOutcome export_study(const StudyExportRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
