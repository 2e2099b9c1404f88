// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "help_pages.h"

#include <algorithm>
#include <array>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace palmar::cli {
namespace {

constexpr std::size_t kFew = 14;  // options that are read at a glance: choice

struct Group {
  const char* title;
  std::vector<std::string> options;
};

/// In the order of the page. One word means one thing in every command, so the groups are the same
/// for all.
const std::vector<Group>& groups() {
  static const std::vector<Group> all = {
      {"Start here",
       {"--product", "--specimen", "--indenter", "--depth-mm", "--force-n", "--button", "--unit",
        "--out", "--person", "--population", "--hands", "--grip", "--hold", "--grip-force-n",
        "--mass-kg"}},
      {"What is changed, and how far",
       {"--goal", "--edges", "--radius-mm", "--vary", "--propose", "--overlap-share", "--features",
        "--both-hands", "--hands-share", "--threshold-kpa", "--keep-face", "--keep-box",
        "--keep-ends-mm", "--largest-offset-mm", "--largest-change-mm", "--largest-depth-mm",
        "--wall-mm"}},
      {"For whom",
       {"--hand", "--left", "--side", "--profile", "--strength-n", "--natural-postures",
        "--tissue"}},
      {"How it is held",
       {"--part", "--along", "--toward", "--up", "--purpose", "--at", "--axis", "--box",
        "--turn-deg", "--fingertip", "--fingertip-depth-mm", "--place-per-hand", "--hold-posture",
        "--grasp"}},
      {"How firmly, and what it must withstand",
       {"--strength-share", "--limit-depths", "--palm-limit-depth-mm", "--finger-limit-depth-mm",
        "--no-balance", "--friction", "--weight-n", "--density-g-cm3", "--acceleration-g",
        "--gravity", "--mass-at", "--load-n", "--torque-n-mm", "--load-at"}},
      {"Skin and contact",
       {"--preset", "--coupling", "--tissue-model", "--kernel", "--no-swelling",
        "--shear-modulus-kpa", "--error-band", "--no-error-band", "--coating", "--skin-on-skin"}},
      {"Beside the answer", {"--sensors", "--measured", "--error-budget"}},
      {"Report",
       {"--language", "--units", "--project", "--pdf", "--paper", "--slides", "--excel",
        "--rounded-csv", "--no-pictures", "--details", "--no-compare"}},
  };
  return all;
}

/// Where an option stands in its group's list; those that aren't in it after the others.
std::size_t rank_in(const std::string& title, const CLI::Option& option) {
  for (const Group& group : groups()) {
    if (title != group.title) continue;
    const auto found =
        std::find(group.options.begin(), group.options.end(), option.get_name(false, false));
    return static_cast<std::size_t>(found - group.options.begin());
  }
  return 0;
}

std::string grouped(const CLI::App& app, const CLI::Formatter& format) {
  std::string text;
  for (const std::string& title : option_groups(app)) {
    text += format.make_group(title, false, options_in_group(app, title));
  }
  return text;
}

class Page : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return make_expanded(app);
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) +
           grouped(*app, *this) + make_subcommands(app, mode) + "\n" + make_footer(app);
  }
};

/// What makes a file that examples name.
struct Recipe {
  const char* file;
  const char* command;
};

constexpr std::array kRecipes = {
    Recipe{"handle.step", "palmar product make prism --fillet-mm 3 --out handle.step"},
    Recipe{"handle.stl", "palmar product make cylinder --diameter-mm 35 --out handle.stl"},
    Recipe{"old.step", "palmar product make prism --fillet-mm 3 --out old.step"},
    Recipe{"new.step", "palmar product make prism --fillet-mm 10 --out new.step"},
    Recipe{"grasp.json", "palmar grasp close handle.step --out grasp.json"},
    Recipe{"hands.csv", "palmar population sample ansur2 --hands 30 --out hands.csv"},
    Recipe{"women.palmar",
           "palmar study run --product old.step --product new.step --population ansur2_women "
           "--hands 6 --out women.palmar"},
    Recipe{"shards",
           "palmar study run examples/three-handles/study.toml --shard 1/1 --out "
           "shards/1.palmar"},
    Recipe{"subject3/mri", "palmar phantom mri --seed 3 --out subject3"},
    Recipe{"subject3/scan/reference.ply", "palmar phantom scan --seed 3 --out subject3"},
    Recipe{"reference", "palmar mri surfaces subject3/mri --description reference --out reference"},
    Recipe{"thumb_flexion",
           "palmar mri surfaces subject3/mri --description thumb_flexion --out thumb_flexion"},
};

/// Commands that make the files which a command reads, in order, none twice.
void add_makers(const std::string& command, std::vector<std::string>& before) {
  std::istringstream text(command);
  std::string last;
  for (std::string word; text >> word; last = word) {
    const bool is_made_here = last == "--out" || last == "--png" || last == "--description";
    const auto recipe = std::find_if(kRecipes.begin(), kRecipes.end(),
                                     [&](const Recipe& one) { return word == one.file; });
    if (is_made_here || recipe == kRecipes.end()) continue;
    if (std::find(before.begin(), before.end(), recipe->command) != before.end()) continue;
    add_makers(recipe->command, before);
    before.emplace_back(recipe->command);
  }
}

struct Example {
  const char* noun;
  const char* command;
};

constexpr std::array kExamples = {
    Example{"hand",
            "palmar hand scale --hand-length-mm 168 --circumference-mm 178 --out small.hand.glb"},
    Example{"product", "palmar product make prism --width-mm 35 --out narrow.step"},
    Example{"grasp", "palmar grasp holds handle.step --png holds.png"},
    Example{
        "contact",
        "palmar contact press --specimen template:middle_distal --indenter plane --depth-mm 1,2"},
    Example{"effort", "palmar effort capacity handle.step"},
    Example{"study",
            "palmar study run --product handle.step --population ansur2_women --hands 6 --out "
            "handle.palmar"},
    Example{"redesign", "palmar redesign press handle.step --hands 6 --out pressed"},
};

void arrange(CLI::App& verb) {
  const auto options = verb.get_options(nullptr);
  if (options.size() > kFew) {
    for (const Group& one : groups()) {
      for (const std::string& name : one.options) {
        if (CLI::Option* option = verb.get_option_no_throw(name)) option->group(one.title);
      }
    }
    // What is left is for experts and stands last.
    for (CLI::Option* option : options) {
      if (option->get_group() == "Options" && option != verb.get_help_ptr()) {
        option->group("More options");
      }
    }
  }
  for (CLI::App* sub : verb.get_subcommands(nullptr)) arrange(*sub);
}

}  // namespace

std::vector<std::string> option_groups(const CLI::App& app) {
  std::vector<std::string> titles;
  for (const Group& one : groups()) titles.emplace_back(one.title);
  for (const std::string& title : app.get_groups()) {
    if (std::find(titles.begin(), titles.end(), title) == titles.end()) titles.push_back(title);
  }
  std::erase_if(titles, [&](const std::string& title) {
    return title.empty() || options_in_group(app, title).empty();
  });
  return titles;
}

std::vector<const CLI::Option*> options_in_group(const CLI::App& app, const std::string& title) {
  auto options = app.get_options([&](const CLI::Option* option) {
    return option->get_group() == title && option->nonpositional();
  });
  std::stable_sort(options.begin(), options.end(), [&](const auto* one, const auto* other) {
    return rank_in(title, *one) < rank_in(title, *other);
  });
  return options;
}

std::string example_text(const std::string& example) {
  std::vector<std::string> lines;
  add_makers(example, lines);
  lines.push_back(example);
  std::string text;
  for (const std::string& line : lines) {
    text += (text.empty() ? "Example: " : "\n         ") + line;
  }
  return text;
}

void arrange_help(CLI::App& app) {
  const auto page = std::make_shared<Page>();
  page->column_width(30);
  arrange(app);
  for (CLI::App* noun : app.get_subcommands(nullptr)) {
    for (const Example& one : kExamples) {
      if (noun->get_name() == one.noun) noun->footer(example_text(one.command));
    }
  }
  const auto format = [&](auto&& self, CLI::App& verb) -> void {
    verb.formatter(page);
    for (CLI::App* sub : verb.get_subcommands(nullptr)) self(self, *sub);
  };
  format(format, app);
}

}  // namespace palmar::cli
