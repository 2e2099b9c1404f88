// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "run_program.h"

// The commands that the documents show are run as they stand, on stand-ins for the files they name.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;

/// README.md and the pages below docs/ that show commands.
std::vector<std::string> pages() {
  std::vector<std::string> all = {"README.md"};
  const fs::path root(PALMAR_SOURCE_DIR);
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() != ".md") continue;
    if (read_text(entry.path().string()).find("\n    palmar ") == std::string::npos &&
        read_text(entry.path().string()).find("\npalmar ") == std::string::npos) {
      continue;
    }
    all.push_back(fs::relative(entry.path(), root).string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Commands that a page shows: lines "palmar ..." (README: "build/release/bin/palmar ...") with
/// what a backslash continues. Indented ones run on the stand-ins below; those in fences, between
/// ```, read files of people that the repository doesn't have.
struct ShownCommand {
  std::string text;  ///< without "palmar "
  bool is_fenced = false;
};

std::vector<ShownCommand> shown_commands(const std::string& page) {
  std::vector<ShownCommand> commands;
  std::istringstream text(read_text((fs::path(PALMAR_SOURCE_DIR) / page).string()));
  bool is_fenced = false;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("```")) is_fenced = !is_fenced;
    while (line.ends_with("\\")) {
      std::string next;
      std::getline(text, next);
      line = line.substr(0, line.size() - 1) + next;
    }
    if (!is_fenced && !line.starts_with("    ")) continue;
    line.erase(0, std::min(line.size(), line.find_first_not_of(' ')));
    if (line.starts_with("build/release/bin/")) line.erase(0, 18);
    if (!line.starts_with("palmar ")) continue;
    if (line.starts_with("palmar serve")) continue;  // runs until it is stopped: bench_browser
    // What follows "  #" explains the command.
    commands.push_back({line.substr(7, line.find("  #") - 7), is_fenced});
  }
  return commands;
}

/// The same command on fewer hands, coarser images and without pictures, which take most of the
/// time and are drawn by other tests.
std::string shortened(std::string command) {
  const auto at_most = [&](const std::string& option, const std::string& value) {
    const std::size_t at = command.find(option + " ");
    if (at == command.npos) return;
    const std::size_t from = at + option.size() + 1;
    command.replace(from, command.find(' ', from) - from, value);
  };
  if (command.starts_with("assess ")) command += " --no-pictures";
  if (command.starts_with("study run --product")) at_most("--hands", "2");
  if (command.starts_with("assess ") && command.find("--population") != command.npos) {
    at_most("--hands", "2");
  }
  // No test looks for bones in fine images; docs/method/mri.md has what was found in them by hand.
  if (command.starts_with("phantom mri ")) {
    command += " --pixel-mm 1.2 --slice-mm 1.4 --slices 90 --no-fixture";
  }
  if (command.starts_with("hand from-")) command += " --no-report";
  if (command.starts_with("redesign ")) {
    const std::string many = command.find(" --hands ") == command.npos ? " --hands 2" : "";
    at_most("--hands", "2");
    command += many;
    // fillet, features: hands close on every candidate anew, but for a posture that is kept
    if (command.starts_with("redesign f")) command += " --evaluations 3 --hold-posture kept";
    if (command.starts_with("redesign shape ")) command += " --evaluations 3";
    // Their own tests compare.
    if (!command.starts_with("redesign press ")) command += " --no-compare";
  }
  return command;
}

/// A folder with the products that the pages name; made once.
const std::string& stand_ins() {
  static const std::string folder = [] {
    const std::string made = temporary_folder();
    fs::copy(fs::path(PALMAR_SOURCE_DIR) / "examples", fs::path(made) / "examples",
             fs::copy_options::recursive);
    const ProgramRun prism = run_palmar(
        "product make prism --width-mm 35 --depth-mm 35 --length-mm 130 --fillet-mm 3 "
        "--out handle.step --out scan.stl",
        made);
    EXPECT_EQ(prism.exit_code, 0) << prism.err;
    const ProgramRun cylinder =
        run_palmar("product make cylinder --diameter-mm 40 --out handle.stl", made);
    EXPECT_EQ(cylinder.exit_code, 0) << cylinder.err;
    for (const char* name :
         {"old-handle.stl", "new-handle.stl", "drill.stl", "old.stl", "new.stl"}) {
      fs::copy(fs::path(made) / "handle.stl", fs::path(made) / name);
    }
    // How two people held two objects: wrist and fingertips.
    std::string people = "object";
    for (const char* point : {"wrist", "thumb", "index", "middle", "ring", "little"}) {
      for (const char axis : {'x', 'y', 'z'}) {
        people += std::string(",") + point + "_" + axis + "_mm";
      }
    }
    people += ",up_x,up_y,up_z";
    fs::create_directory(fs::path(made) / "objects");
    for (const char* name : {"bar", "can"}) {
      fs::copy(fs::path(made) / "handle.stl",
               fs::path(made) / "objects" / (std::string(name) + ".stl"));
      people += std::string("\n") + name +
                ",-20,-130,0,20,0,10,-22,15,30,-22,15,10,-22,15,-10,-22,10,-30,0,0,1";
    }
    write_text(made + "/people.csv", people + "\n");
    fs::copy(fs::path(made) / "handle.step", fs::path(made) / "handle.iges");  // read by content
    fs::copy(fs::path(made) / "handle.step", fs::path(made) / "prism.step");
    return made;
  }();
  return folder;
}

class Documents : public ::testing::TestWithParam<std::string> {};

constexpr int kProgramMissing = 6;  // docs/using/exit-codes.md

TEST_P(Documents, ShowCommandsThatWork) {
  const std::string folder = temporary_folder();
  fs::copy(stand_ins(), folder, fs::copy_options::recursive);
  std::string missing;
  for (const ShownCommand& command : shown_commands(GetParam())) {
    if (command.is_fenced) continue;
    // A quarter of a minute; `redesign_region` runs it before a release.
    if (GetParam() == "README.md" && command.text.starts_with("redesign region ")) continue;
    const ProgramRun run = run_palmar(shortened(command.text), folder);
    if (run.exit_code == kProgramMissing) {
      missing += "palmar " + command.text + "\n" + run.err;
      continue;
    }
    EXPECT_EQ(run.exit_code, 0) << GetParam() << ": palmar " << command.text << "\n" << run.err;
    EXPECT_EQ(run.err.find("is now called"), run.err.npos) << command.text << "\n" << run.err;
  }
  if (!missing.empty()) GTEST_SKIP() << missing;
}

TEST_P(Documents, ShowCommandsInFencesThatAreUnderstood) {
  constexpr int kUnreadable = 3;
  const std::string folder = temporary_folder();
  for (const ShownCommand& command : shown_commands(GetParam())) {
    if (!command.is_fenced || command.text.starts_with("phantom ")) continue;
    // Its files aren't there: it must say so, and not that it doesn't know an option.
    const ProgramRun run = run_palmar(command.text, folder);
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == kUnreadable ||
                run.exit_code == kProgramMissing)
        << GetParam() << ": palmar " << command.text << " ends with " << run.exit_code << "\n"
        << run.err;
    EXPECT_EQ(run.err.find("is now called"), run.err.npos) << command.text << "\n" << run.err;
  }
}

/// Whether the commands of a page take minutes: many hands, searches for a better shape, a person's
/// hand from images.
bool is_long(const std::string& page) {
  static const std::set<std::string> long_pages = {
      "docs/method/effort.md", "docs/using/sensors.md", "docs/method/redesign.md",
      "docs/method/mri.md",    "docs/method/scan.md",   "docs/using/assess.md",
      "docs/using/desk.md",    "docs/using/mri.md",     "docs/using/quick.md",
      "docs/using/scan.md",    "docs/using/redesign.md"};
  return long_pages.contains(page);
}

std::vector<std::string> pages_that_are_long(bool are_long) {
  std::vector<std::string> some = pages();
  std::erase_if(some, [&](const std::string& page) { return is_long(page) != are_long; });
  return some;
}

std::string test_name(const ::testing::TestParamInfo<std::string>& page) {
  std::string name = page.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Pages, Documents, ::testing::ValuesIn(pages_that_are_long(false)),
                         test_name);
INSTANTIATE_TEST_SUITE_P(LongPages, Documents, ::testing::ValuesIn(pages_that_are_long(true)),
                         test_name);

/// Verbs as "study run", with the lines of their examples.
std::vector<std::pair<std::string, std::vector<std::string>>> examples_of_help() {
  std::vector<std::pair<std::string, std::vector<std::string>>> all;
  std::vector<std::string> verbs = {""};
  for (std::size_t i = 0; i < verbs.size(); ++i) {
    const std::string verb = verbs[i];
    std::istringstream help(run_palmar(verb + " --help").out);
    std::vector<std::string> lines;
    bool are_verbs = false;
    for (std::string line; std::getline(help, line);) {
      if (line.starts_with("Example: ") || line.starts_with("         palmar ")) {
        lines.push_back(line.substr(9 + 7));
      }
      if (!line.starts_with("  ")) are_verbs = line == "Subcommands:";
      if (!are_verbs || !line.starts_with("  ") || line.starts_with("   ")) continue;
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      if (verb != "product make") verbs.push_back(verb.empty() ? name : verb + " " + name);
    }
    all.emplace_back(verb, lines);
  }
  return all;
}

TEST(HelpExamples, WorkFromTheRepositoryLineByLine) {
  // Minutes each, of images and photographs, on a cluster, or of people's holds, which no command
  // makes: other tests run them.
  const std::vector<std::string> long_ones = {
      "hand from-", "mri",           "phantom", "photos calibrate", "photos mesh", "study submit",
      "validate",   "hand template", "serve",   "grasp fit-holds"};
  const std::string folder = temporary_folder();
  fs::copy(fs::path(PALMAR_SOURCE_DIR) / "examples", fs::path(folder) / "examples",
           fs::copy_options::recursive);
  std::set<std::string> ran;  // what several examples begin with is made once
  for (const auto& [verb, lines] : examples_of_help()) {
    EXPECT_FALSE(lines.empty()) << "palmar " << verb << " --help has no example";
    const bool is_long = verb == "photos" || std::any_of(long_ones.begin(), long_ones.end(),
                                                         [&verb = verb](const auto& one) {
                                                           return verb.starts_with(one);
                                                         });
    if (is_long) continue;
    for (const std::string& line : lines) {
      if (!ran.insert(line).second) continue;
      const ProgramRun run = run_palmar(shortened(line.substr(0, line.find("   ("))), folder);
      if (run.exit_code == kProgramMissing) break;
      EXPECT_EQ(run.exit_code, 0) << verb << ": palmar " << line << "\n" << run.err;
      EXPECT_EQ(run.err.find("is now called"), run.err.npos) << line;
    }
  }
  EXPECT_GT(ran.size(), 30U);
}

}  // namespace
}  // namespace palmar::testing
