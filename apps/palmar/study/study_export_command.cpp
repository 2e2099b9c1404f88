// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/records/study/study_export.h"
#include "palmar/records/study/study_store.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

struct ExportArguments {
  std::string store, out;
  bool with_fields = false;
};

int run_export(const ExportArguments& arguments, const Context& context) {
  const Progress progress = make_progress(context.common);
  const StudyStore store(arguments.store);
  const auto files = export_study(store, arguments.out, arguments.with_fields, progress);
  finish_progress();
  const std::size_t rest = store.missing().size();
  if (rest > 0) {
    note(context.common, fmt::format("{}: {} grasps are missing; the tables hold what is finished",
                                     arguments.store, rest));
  }
  if (context.common.json) {
    nlohmann::ordered_json json = {{"files", nlohmann::ordered_json::array()},
                                   {"missing_grasps", rest},
                                   {"results_sha256", store.digest()}};
    for (const auto& file : files) json["files"].push_back(file.string());
    print(json.dump(2) + "\n");
  } else {
    for (const auto& file : files) print(file.string() + "\n");
  }
  return 0;
}

}  // namespace

void add_study_export_command(CLI::App& noun, Context& context) {
  const auto options = std::make_shared<ExportArguments>();
  CLI::App* verb = add_verb(noun, "export", "Every table of a study as CSV, units in the headers",
                            "palmar study export study.palmar --out tables");
  verb->add_option("STORE", options->store, "Store of the study")->required();
  verb->add_option("--out", options->out, "Folder to write to")->required();
  verb->add_flag("--fields", options->with_fields,
                 "Also pressures of every loaded vertex: large files");
  verb->callback([&context, options] {
    context.run = [&context, options] { return run_export(*options, context); };
  });
}

}  // namespace palmar::cli
