// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/records/validation_json.h"
#include "palmar/workflow/validate.h"

namespace palmar::cli {
namespace {

struct ValidateArguments {
  workflow::ValidateRequest request;
  bool is_markdown = false, is_list = false;
};

std::string list_text() {
  std::string text;
  for (const validation::ValidationCaseName& name : validation::validation_cases()) {
    text += name.id + std::string(11 - std::min<std::size_t>(10, name.id.size()), ' ') +
            name.title + (name.is_slow ? " (not with --quick)" : "") + "\n";
  }
  return text;
}

int run_validate(const ValidateArguments& arguments, const CommonOptions& common) {
  if (arguments.is_list) {
    print(list_text());
    return 0;
  }
  if (common.json && arguments.is_markdown) {
    throw UsageError("--json and --markdown exclude each other");
  }
  workflow::ValidateRequest request = arguments.request;
  request.note = [&common](const std::string& text) { note(common, text); };
  request.check();
  const validation::ValidationReport report =
      workflow::run_validation(request, make_progress(common));
  finish_progress();
  if (common.json) {
    print(records::validation_json(report) + "\n");
  } else {
    print(arguments.is_markdown ? validation::validation_markdown(report)
                                : validation::validation_text(report));
  }
  const int missed = report.count(validation::Verdict::kMissed);
  if (missed == 0) return 0;
  throw CheckFailed(std::to_string(missed) + (missed == 1 ? " row is" : " rows are") +
                    " missed; docs/method/limits.md says what that means");
}

}  // namespace

void add_validate_command(CLI::App& app, Context& context) {
  const auto o = std::make_shared<ValidateArguments>();
  CLI::App* verb =
      add_verb(app, "validate",
               "Compare the simulator with closed forms and measurements; exit code 5 on a miss",
               "palmar validate --case G1,G2");
  verb->add_option("--case", o->request.options.cases, "Cases to run, as G1,layer; all by default")
      ->delimiter(',');
  verb->add_flag("--quick", o->request.options.quick,
                 "Leave out the cases that take longer than some seconds");
  verb->add_flag("--list", o->is_list, "List the cases, run nothing");
  verb->add_flag("--markdown", o->is_markdown, "The table as in docs/method/validation.md");
  verb->add_option("--out", o->request.out, "File to write besides: .md or .json");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_validate(*o, context.common); }; });
}

}  // namespace palmar::cli
