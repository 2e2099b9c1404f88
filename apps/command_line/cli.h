// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"
#include "palmar/product/product.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/words/number_words.h"

namespace palmar::cli {

/// Options that every command takes.
struct CommonOptions {
  bool json = false;       ///< one JSON object on stdout instead of text
  bool quiet = false;      ///< no progress, no notes on stderr
  int threads = 0;         ///< 0: all cores
  std::uint64_t seed = 0;  ///< written into results
};

/// Settings whose words aren't those of their option: "product from hand" -> "--placement".
using SettingOptions = std::map<std::string, std::string>;

/// What the parsed command line asks for: the chosen verb sets `run`, which returns the exit code.
struct Context {
  CommonOptions common;
  std::string command_line;
  char** arguments = nullptr;      ///< of main(), for a command that another program takes over
  SettingOptions setting_options;  ///< of the chosen verb, for messages of the library
  std::function<int()> run;
};

// Each program (palmar, palmar-hands, palmar-redesign, palmar-serve) defines these two:
/// Adds its commands.
void add_commands(CLI::App& app, Context& context);
/// The noun that its first word leaves out: "hand" for `palmar-hands from-scan`; "" for none.
std::string implied_noun(const std::string& first_word);

// One function per noun adds it with its verbs.
void add_assess_command(CLI::App& app, Context& context);
void add_contact_commands(CLI::App& app, Context& context);
void add_doctor_command(CLI::App& app, Context& context);
void add_effort_commands(CLI::App& app, Context& context);
void add_grasp_commands(CLI::App& app, Context& context);
void add_hand_commands(CLI::App& app, Context& context);
/// Verbs of `palmar hand` that make a hand from measurements of a person.
void add_hand_capture_commands(CLI::App& app, Context& context);
void add_population_commands(CLI::App& app, Context& context);
void add_product_commands(CLI::App& app, Context& context);
void add_redesign_commands(CLI::App& app, Context& context);
void add_serve_command(CLI::App& app, Context& context);
void add_study_commands(CLI::App& app, Context& context);
void add_validate_command(CLI::App& app, Context& context);

/// "palmar hand scale".
std::string full_name(const CLI::App& app);

/// Adds a verb with its worked example under the help text.
CLI::App* add_verb(CLI::App& parent, const std::string& name, const std::string& description,
                   const std::string& example);

/// "mm", "cm", "m", "inch"; empty = not given. Throws UsageError naming --unit.
std::optional<geometry::LengthUnit> parse_unit(const std::string& text);

/// Messages of the library name settings in words; from now on they get the names of this verb's
/// options: those in `others`, else the ones that have the same words.
void name_settings_by(const CLI::App& verb, const SettingOptions& others);
/// The option of a setting of the running verb: "accept odd slices" -> "--accept-odd-slices", "cut"
/// -> "--cut-mm", "populations" -> "--population", "product" -> "PRODUCT" if it is an argument.
/// What is no option of it stays: a study's setting "default".
std::string option_named(const std::string& setting);

/// Progress for this command: a line on a terminal's stderr (none with --quiet, --json or a pipe),
/// cancelled by the first Ctrl-C; the second ends the program at once. Commands that never ask for
/// a Progress have nothing to keep: Ctrl-C simply ends them.
Progress make_progress(const CommonOptions& common);
/// Ends the progress line, so that other messages start on a line of their own.
void finish_progress();
/// A note for the user on stderr, silent with --quiet.
void note(const CommonOptions& common, const std::string& text);
/// Text on stdout; throws OutputError if it can't be written (a full disk, say).
void print(const std::string& text);

}  // namespace palmar::cli
