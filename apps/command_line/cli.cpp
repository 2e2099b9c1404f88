// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "cli.h"

#include "help_pages.h"
#include "slicer_module.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/setting_names.h"
#include "palmar/formats/text_scan.h"

namespace palmar::cli {
namespace {

std::atomic<bool> interrupted{false};
bool progress_line_open = false;
/// Options of the verb that runs, as typed ("--space-mm", "PRODUCT"): they outlive the parser.
std::vector<std::string> running_options;
SettingOptions running_setting_options;
/// Ends of options that say in which unit a number is.
constexpr std::array kUnitEnds = {"-mm", "-mm2", "-mm3", "-deg", "-px",    "-mb",   "-n",
                                  "-kg", "-kpa", "-mpa", "-s",   "-g-cm3", "-n-mm", "-g"};

/// Settings whose option has another word, which stands in the command that has it.
constexpr std::array<std::pair<const char*, const char*>, 6> kOtherWords = {{
    {"region", "--box"},
    {"box", "--space-mm"},
    {"share", "--overlap-share"},
    {"share", "--hands-share"},
    {"depth-limit", "--largest-depth-mm"},
    {"posture", "--hold-posture"},
}};

void on_interrupt(int) {
  if (interrupted.exchange(true)) _exit(130);  // second press: at once
}

/// The first Ctrl-C asks to stop, the second stops at once; so do kill and a terminal that is
/// closed, unless who started the program has it go on then (nohup).
void install_interrupt_handler() {
  struct sigaction action = {}, before = {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

/// The running verb's option of this name, perhaps with a unit behind it, or its argument; "" if it
/// has none.
std::string running_option(const std::string& name) {
  std::vector<std::string> candidates = {"--" + name};
  for (const char* const unit : kUnitEnds) candidates.push_back("--" + name + unit);
  candidates.push_back(name);
  for (char& c : candidates.back()) {
    c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  const auto found = std::find_first_of(candidates.begin(), candidates.end(),
                                        running_options.begin(), running_options.end());
  return found == candidates.end() ? "" : *found;
}

}  // namespace

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + " " + app.get_name();
}

CLI::App* add_verb(CLI::App& parent, const std::string& name, const std::string& description,
                   const std::string& example) {
  CLI::App* verb = parent.add_subcommand(name, description);
  verb->footer(example_text(example));
  verb->fallthrough();
  return verb;
}

std::optional<geometry::LengthUnit> parse_unit(const std::string& text) {
  if (text.empty()) return std::nullopt;
  if (const auto unit = geometry::length_unit_named(text)) return unit;
  throw UsageError("--unit: \"" + text + "\" is not known; mm, cm, m or inch is allowed");
}

void name_settings_by(const CLI::App& verb, const SettingOptions& others) {
  running_options.clear();
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_lnames()) running_options.push_back("--" + name);
    if (option->get_positional()) running_options.push_back(option->get_name(true));
  }
  running_setting_options = others;
}

std::string option_named(const std::string& setting) {
  const auto other = running_setting_options.find(setting);
  if (other != running_setting_options.end()) return other->second;
  std::string name = setting;
  std::replace(name.begin(), name.end(), ' ', '-');
  std::string option = running_option(name);
  // A list's option is given once per value: it is not plural.
  if (option.empty() && name.ends_with('s')) {
    option = running_option(name.substr(0, name.size() - 1));
  }
  for (const auto& [word, other_name] : kOtherWords) {
    const bool is_here = std::find(running_options.begin(), running_options.end(), other_name) !=
                         running_options.end();
    if (option.empty() && name == word && is_here) option = other_name;
  }
  return option.empty() ? "setting \"" + setting + "\"" : option;  // a study's, say
}

namespace {

/// A program that started this one and wants to know where it stands (palmar serve):
/// PALMAR_PROGRESS is "lines".
bool has_watcher() {
  const char* const wanted = std::getenv("PALMAR_PROGRESS");
  return wanted != nullptr && std::string_view(wanted) == "lines";
}

/// What `write` is told never goes back, and comes at most ten times a second.
std::function<void(double, const std::string&)> throttled(
    std::function<void(double, const std::string&)> write) {
  const auto last = std::make_shared<std::chrono::steady_clock::time_point>();
  const auto most = std::make_shared<double>(0.0);
  return [last, most, write = std::move(write)](double share, const std::string& activity) {
    *most = std::clamp(share, *most, 1.0);
    const auto now = std::chrono::steady_clock::now();
    if (now - *last < std::chrono::milliseconds(100)) return;
    *last = now;
    write(*most, activity);
    std::fflush(stdout);
  };
}

void print_progress_line(double share, const std::string& activity) {
  std::printf("progress %.4f %s\n", share, activity.c_str());
}

}  // namespace

Progress make_progress(const CommonOptions& common) {
  install_interrupt_handler();
  Progress progress;
  progress.cancel = &interrupted;
  if (is_module()) {
    progress.report = throttled(print_panel_progress);
    return progress;
  }
  if (has_watcher()) {
    progress.report = throttled(print_progress_line);
    return progress;
  }
  if (common.quiet || common.json || isatty(STDERR_FILENO) == 0) return progress;
  const auto start = std::chrono::steady_clock::now();
  // A part that doesn't know where it stands in the whole must not turn the line back.
  const auto most = std::make_shared<double>(0.0);
  progress.report = [start, most](double share, const std::string& activity) {
    *most = std::max(*most, share);
    const double spent =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    char left[48] = "";
    if (*most > 0.1 && *most < 1.0 && spent > 1.0) {
      const double seconds = std::ceil(spent * (1 / *most - 1));
      if (seconds > 90.0) {
        std::snprintf(left, sizeof left, ", about %.0f min left", std::round(seconds / 60.0));
      } else {
        std::snprintf(left, sizeof left, ", about %.0f s left", seconds);
      }
    }
    std::fprintf(stderr, "\r\033[K%3.0f %%  %s%s", 100 * *most, activity.c_str(), left);
    std::fflush(stderr);
    progress_line_open = true;
  };
  return progress;
}

void finish_progress() {
  if (progress_line_open) std::fprintf(stderr, "\r\033[K");
  progress_line_open = false;
}

void note(const CommonOptions& common, const std::string& text) {
  if (common.quiet) return;
  finish_progress();
  std::fprintf(stderr, "palmar: %s\n", with_setting_names(text, option_named).c_str());
}

void print(const std::string& given) {
  const std::string text = is_module() ? formats::xml_escaped(given) : given;
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw OutputError("standard output can't be written to (disk full or pipe closed)");
  }
}

}  // namespace palmar::cli
