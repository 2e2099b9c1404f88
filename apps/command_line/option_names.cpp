// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "option_names.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

namespace palmar::cli {
namespace {

struct Renamed {
  const char* old_name;
  const char* name;
  double factor = 0.0;  // on the number, where the unit changed; 0: the value stays as it is
};

/// From the release before to this one; docs/using/options.md has the same table for people.
constexpr std::array kRenamed = {
    Renamed{"--region", "--box"},
    Renamed{"--keep-box-mm", "--keep-box"},
    Renamed{"--box-mm", "--space-mm"},
    Renamed{"--regions", "--coupling"},
    Renamed{"--threshold-mpa", "--threshold-kpa", 1000.0},
    Renamed{"--share", "--hands-share"},
    Renamed{"--share", "--overlap-share"},
    Renamed{"--posture", "--hold-posture"},
    Renamed{"--postures", "--posture"},
    Renamed{"--depth-limit-mm", "--largest-depth-mm"},
    Renamed{"--keep-out", "--keep-face"},
    Renamed{"--level", "--confidence"},
    Renamed{"--model", "--start-hand"},
    Renamed{"--base", "--start-hand"},
};

/// The deepest verb that the words name.
const CLI::App* verb_of(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* verb = &app;
  for (const std::string& word : words) {
    const CLI::App* next = nullptr;
    for (const CLI::App* sub : verb->get_subcommands(nullptr)) {
      if (sub->get_name() == word) next = sub;
    }
    if (next != nullptr) verb = next;
  }
  return verb;
}

/// "0.05" times a factor, as it is typed; what isn't a number stays for the parser to refuse.
std::string scaled(const std::string& text, double factor) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return text;
  return fmt::format("{:.10g}", value * factor);
}

}  // namespace

std::vector<std::string> with_present_names(const CLI::App& app, std::vector<std::string> words,
                                            std::vector<std::string>& notes) {
  const CLI::App* verb = verb_of(app, words);
  const auto has = [&](const char* name) { return verb->get_option_no_throw(name) != nullptr; };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(0, equals);
    for (const Renamed& one : kRenamed) {
      if (name != one.old_name || has(one.old_name) || !has(one.name)) continue;
      const bool is_scaled = one.factor != 0.0;
      notes.push_back(fmt::format(
          "{} is now called {}{}; the old name goes with the next release", one.old_name, one.name,
          is_scaled ? fmt::format(" (its number times {:g})", one.factor) : std::string()));
      if (equals != std::string::npos) {
        const std::string value = words[i].substr(equals + 1);
        words[i] = one.name + ("=" + (is_scaled ? scaled(value, one.factor) : value));
      } else {
        words[i] = one.name;
        if (is_scaled && i + 1 < words.size()) words[i + 1] = scaled(words[i + 1], one.factor);
      }
      break;
    }
  }
  return words;
}

}  // namespace palmar::cli
