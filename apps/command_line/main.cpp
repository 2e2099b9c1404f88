// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <signal.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "cli.h"
#include "help_pages.h"
#include "option_names.h"
#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/parallel.h"
#include "palmar/core/setting_names.h"
#include "palmar/core/text.h"
#include "palmar/core/version.h"
#include "palmar/workflow/hand/load_hand.h"
#include "slicer_module.h"
#include "text.h"

namespace palmar::cli {
namespace {

int fail(const std::string& message, int code) {
  finish_progress();
  finish_panel();
  std::fprintf(stderr, "palmar: %s\n", with_setting_names(message, option_named).c_str());
  return code;
}

/// The deepest subcommand that was named on the command line.
const CLI::App* deepest_parsed(const CLI::App* app) {
  for (const CLI::App* sub : app->get_subcommands()) return deepest_parsed(sub);
  return app;
}

/// "pram is no kind of product; did you mean prism? There are cylinder, ..."
std::string explain_verb(const CLI::App& where, const std::string& wrong) {
  std::vector<std::string> names;
  for (const CLI::App* verb : where.get_subcommands(nullptr)) names.push_back(verb->get_name());
  std::string nearest = nearest_name(wrong, names);
  for (std::size_t i = 0; i < names.size() && nearest.empty(); ++i) {
    if (wrong.size() > 2 && names[i].starts_with(wrong.substr(0, 2))) nearest = names[i];
  }
  const char* const what =
      full_name(where) == "palmar product make" ? "kind of product" : "command";
  return wrong + " is no " + what +
         (nearest.empty() ? "; there are " : "; did you mean " + nearest + "? There are ") +
         palmar::joined(names, ", ") + "\nTry: " + full_name(where) + " --help";
}

/// What was wrong with the command line, and the nearest thing that would have been right.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* where = deepest_parsed(&app);
  std::string text = error.what();
  const std::vector<std::string> extras = app.remaining(true);
  if (!extras.empty()) {
    const std::string& wrong = extras.front();
    std::vector<std::string> known;
    for (const CLI::App* level = where; level != nullptr; level = level->get_parent()) {
      for (const CLI::Option* option : level->get_options()) {
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      }
    }
    for (const CLI::App* sub : where->get_subcommands(nullptr)) known.push_back(sub->get_name());
    text = (wrong.rfind('-', 0) == 0 ? "unknown option " : "unexpected argument ") + wrong;
    const std::vector<const CLI::App*> verbs = where->get_subcommands(nullptr);
    if (!verbs.empty() && wrong.rfind('-', 0) != 0) return explain_verb(*where, wrong);
    const std::string nearest = nearest_name(wrong, known);
    if (!nearest.empty()) text += "; did you mean " + nearest + "?";
  }
  return text + "\nTry: " + full_name(*where) + " --help";
}

/// Version and build, with commit and libraries if the build's file is there
/// (cmake/write_build.cmake).
std::string version_text() {
  std::string text = build_description();
  std::ifstream file(workflow::share_folder() + "/build.txt");
  for (std::string line; std::getline(file, line);) text += "\n" + line;
  return text;
}

int run(int argc, char** argv) {
  Context context;
  context.arguments = argv;
  for (int i = 0; i < argc; ++i) {
    context.command_line += i == 0 ? "palmar" : " " + shell_word(argv[i]);
  }

  CLI::App app("Palmar shows how a handheld product will feel in people's hands before it exists.",
               "palmar");
  app.set_version_flag("--version", version_text);
  app.set_help_flag("-h,--help", "Show this help and a worked example");
  app.require_subcommand(1);
  app.fallthrough();
  app.add_flag("--json", context.common.json, "One JSON object on stdout, keys with units");
  app.add_flag("--quiet", context.common.quiet, "No progress and no notes on stderr");
  app.add_option("--threads", context.common.threads, "Most threads to use; 0 = all cores")
      ->check(CLI::Range(0, 1024));
  app.add_option("--seed", context.common.seed, "Seed of random numbers, kept in the results");
  app.footer(
      "Example: palmar product make prism --fillet-mm 3 --out handle.step\n"
      "         palmar assess handle.step --out report\n"
      "Exit codes: 0 done, 1 unexpected or output not writable, 2 wrong usage, 3 unreadable\n"
      "input or unit unknown, 4 numerical failure, 5 a stated check failed,\n"
      "6 an optional program is missing, 130 cancelled.");
  add_commands(app, context);
  arrange_help(app);
  add_descriptions(app);

  std::vector<std::string> notes;
  std::vector<std::string> words(argv + 1, argv + argc);
  const std::string noun = implied_noun(words.empty() ? "" : words.front());
  if (!noun.empty()) words.insert(words.begin(), noun);
  if (is_module()) words = module_words(words);
  words = with_present_names(app, std::move(words), notes);
  try {
    std::reverse(words.begin(), words.end());  // as the parser takes them
    app.parse(words);
  } catch (const CLI::Success& success) {
    return app.exit(success);  // --help, --version
  } catch (const CLI::ParseError& error) {
    return fail(explain(app, error), 2);
  }
  signal(SIGPIPE, SIG_IGN);  // a closed pipe is an error of print(), not a silent death
  set_thread_count(context.common.threads);
  name_settings_by(*deepest_parsed(&app), context.setting_options);
  for (const std::string& one : notes) note(context.common, one);
  const int code = context.run();
  finish_progress();
  finish_panel();
  return code;
}

}  // namespace
}  // namespace palmar::cli

int main(int argc, char** argv) {
  using palmar::cli::fail;
  try {
    return palmar::cli::run(argc, argv);
  } catch (const palmar::Error& error) {
    return fail(error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    return fail("out of memory", 1);
  } catch (const std::exception& error) {
    return fail(std::string("unexpected: ") + error.what(), 1);
  }
}
