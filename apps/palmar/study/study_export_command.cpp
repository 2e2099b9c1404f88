// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/workflow/study/study_export.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

int run_export(const workflow::StudyExportRequest& request, const Context& context) {
  const workflow::StudyExportOutcome outcome =
      workflow::export_study(request, make_progress(context.common));
  finish_progress();
  if (outcome.missing > 0) {
    note(context.common, fmt::format("{}: {} grasps are missing; the tables hold what is finished",
                                     request.store.string(), outcome.missing));
  }
  if (context.common.json) {
    nlohmann::ordered_json json = {{"files", nlohmann::ordered_json::array()},
                                   {"missing_grasps", outcome.missing},
                                   {"results_sha256", outcome.digest}};
    for (const auto& file : outcome.files) json["files"].push_back(file.string());
    print(json.dump(2) + "\n");
  } else {
    for (const auto& file : outcome.files) print(file.string() + "\n");
  }
  return 0;
}

}  // namespace

void add_study_export_command(CLI::App& noun, Context& context) {
  const auto options = std::make_shared<workflow::StudyExportRequest>();
  CLI::App* verb = add_verb(noun, "export", "Every table of a study as CSV, units in the headers",
                            "palmar study export women.palmar --out tables");
  verb->add_option("STORE", options->store, "Store of the study")->required();
  verb->add_option("--out", options->folder, "Folder to write to")->required();
  verb->add_flag("--fields", options->with_fields,
                 "Also pressures of every loaded vertex: large files");
  verb->callback([&context, options] {
    context.run = [&context, options] { return run_export(*options, context); };
  });
}

}  // namespace palmar::cli
