// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/validation_json.h"
#include "palmar/validation/validation.h"

namespace palmar::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> cases;
  std::string out;
  bool is_quick = false, is_markdown = false, is_list = false;
};

std::string list_text() {
  std::string text;
  for (const ValidationCaseName& name : validation_cases()) {
    text += name.id + std::string(11 - std::min<std::size_t>(10, name.id.size()), ' ') +
            name.title + (name.is_slow ? " (not with --quick)" : "") + "\n";
  }
  return text;
}

void check_out(const std::string& path) {
  const bool is_markdown = path.size() > 3 && path.compare(path.size() - 3, 3, ".md") == 0;
  const bool is_json = path.size() > 5 && path.compare(path.size() - 5, 5, ".json") == 0;
  if (path.empty() || is_markdown || is_json) return;
  throw UsageError("--out: \"" + path + "\" ends with none of .md, .json");
}

int run_validate(const ValidateArguments& arguments, const CommonOptions& common) {
  if (arguments.is_list) {
    print(list_text());
    return 0;
  }
  check_out(arguments.out);
  if (common.json && arguments.is_markdown) {
    throw UsageError("--json and --markdown exclude each other");
  }
  ValidationOptions options;
  options.cases = arguments.cases;
  options.quick = arguments.is_quick;
  options.check();
  const ValidationReport report = validate(load_hand("template"), options, make_progress(common));
  finish_progress();
  if (!arguments.out.empty()) {
    const bool is_markdown = arguments.out.back() == 'd';
    write_file(arguments.out,
               is_markdown ? validation_markdown(report) : validation_json(report) + "\n");
  }
  if (common.json) {
    print(validation_json(report) + "\n");
  } else {
    print(arguments.is_markdown ? validation_markdown(report) : validation_text(report));
  }
  const int missed = report.count(Verdict::kMissed);
  if (missed == 0) return 0;
  throw CheckFailed(std::to_string(missed) + (missed == 1 ? " row is" : " rows are") +
                    " missed; docs/method/limits.md says what that means");
}

}  // namespace

void add_validate_command(CLI::App& app, Context& context) {
  const auto o = std::make_shared<ValidateArguments>();
  CLI::App* verb =
      add_verb(app, "validate",
               "Hold the simulator against closed forms and measurements; exit code 5 on a miss",
               "palmar validate --case G1,G2");
  verb->add_option("--case", o->cases, "Cases to run, as G1,layer; all by default")->delimiter(',');
  verb->add_flag("--quick", o->is_quick, "Leave out the cases that take longer than some seconds");
  verb->add_flag("--list", o->is_list, "Say what the cases are, run nothing");
  verb->add_flag("--markdown", o->is_markdown, "The table as in docs/method/validation.md");
  verb->add_option("--out", o->out, "File to write besides: .md or .json");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_validate(*o, context.common); }; });
}

}  // namespace palmar::cli
