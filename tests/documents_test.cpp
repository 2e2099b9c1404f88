// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>
#include <string>
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
    if (read_text(entry.path().string()).find("\n    palmar ") == std::string::npos) continue;
    all.push_back(fs::relative(entry.path(), root).string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// Indented lines "    palmar ..." of a page.
std::vector<std::string> shown_commands(const std::string& page) {
  std::vector<std::string> commands;
  std::istringstream text(read_text((fs::path(PALMAR_SOURCE_DIR) / page).string()));
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("    palmar ", 0) != 0) continue;
    // What follows "  #" explains the command.
    commands.push_back(line.substr(11, line.find("  #") - 11));
  }
  return commands;
}

/// A folder with the products that the pages name; made once.
const std::string& stand_ins() {
  static const std::string folder = [] {
    const std::string made = temporary_folder();
    fs::copy(fs::path(PALMAR_SOURCE_DIR) / "examples", fs::path(made) / "examples");
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
    fs::copy(fs::path(made) / "handle.step", fs::path(made) / "handle.iges");  // read by content
    fs::copy(fs::path(made) / "handle.step", fs::path(made) / "prism.step");
    return made;
  }();
  return folder;
}

class Documents : public ::testing::TestWithParam<std::string> {};

TEST_P(Documents, ShowCommandsThatWork) {
  const std::string folder = temporary_folder();
  fs::copy(stand_ins(), folder, fs::copy_options::recursive);
  constexpr int kProgramMissing = 6;  // docs/using/exit-codes.md
  std::string missing;
  for (const std::string& command : shown_commands(GetParam())) {
    // Pictures take most of the time; assess_test draws them.
    std::string shortened = command;
    if (command.rfind("assess ", 0) == 0) shortened += " --no-pictures";
    // So do fine images. No test looks for bones in fine images; docs/method/mri.md has what was
    // found in them by hand.
    if (command.rfind("phantom mri ", 0) == 0) {
      shortened += " --pixel-mm 1.2 --slice-mm 1.4 --slices 90 --no-fixture";
    }
    if (command.rfind("hand from-", 0) == 0) shortened += " --no-report";
    // So do many hands and candidates; the tests of redesigns run small searches.
    if (command.rfind("redesign ", 0) == 0) {
      const std::string many = " --hands 30";
      const std::size_t at = shortened.find(many);
      if (at != shortened.npos) shortened.erase(at, many.size());
      shortened += " --hands 2";
      const bool searches = command.rfind("redesign f", 0) == 0;  // fillet, features
      if (searches) shortened += " --evaluations 3";
    }
    const ProgramRun run = run_palmar(shortened, folder);
    if (run.exit_code == kProgramMissing) {
      missing += "palmar " + command + "\n" + run.err;
      continue;
    }
    EXPECT_EQ(run.exit_code, 0) << GetParam() << ": palmar " << command << "\n" << run.err;
  }
  if (!missing.empty()) GTEST_SKIP() << missing;
}

INSTANTIATE_TEST_SUITE_P(Pages, Documents, ::testing::ValuesIn(pages()), [](const auto& page) {
  std::string name = page.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
});

}  // namespace
}  // namespace palmar::testing
