// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <vector>

#include "run_program.h"

// The commands that the documents show are run as they stand, on stand-ins for the files they name.

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;

/// Indented lines "    palmar ..." of the README and of everything below docs/.
std::vector<std::pair<std::string, std::string>> shown_commands() {
  std::vector<fs::path> pages = {fs::path(PALMAR_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(PALMAR_SOURCE_DIR) / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }
  std::sort(pages.begin(), pages.end());
  std::vector<std::pair<std::string, std::string>> commands;
  for (const fs::path& page : pages) {
    std::istringstream text(read_text(page.string()));
    for (std::string line; std::getline(text, line);) {
      if (line.rfind("    palmar ", 0) != 0) continue;
      // What follows "  #" explains the command.
      commands.emplace_back(page.filename().string(), line.substr(11, line.find("  #") - 11));
    }
  }
  return commands;
}

TEST(Documents, EveryShownCommandWorks) {
  const auto commands = shown_commands();
  ASSERT_GE(commands.size(), 8U);
  const std::string folder = temporary_folder();
  fs::copy(fs::path(PALMAR_SOURCE_DIR) / "examples", fs::path(folder) / "examples");
  for (const std::string name : {"handle", "old-handle", "new-handle", "drill", "old", "new"}) {
    ASSERT_EQ(run_palmar("product make cylinder --diameter-mm 40 --out " + name + ".stl", folder)
                  .exit_code,
              0);
  }
  ASSERT_EQ(run_palmar("product make prism --width-mm 35 --depth-mm 35 --length-mm 130 "
                       "--fillet-mm 3 --out handle.step --out scan.stl",
                       folder)
                .exit_code,
            0);
  fs::copy(fs::path(folder) / "handle.step", fs::path(folder) / "handle.iges");  // read by content
  fs::copy(fs::path(folder) / "handle.step", fs::path(folder) / "prism.step");
  for (const auto& [page, command] : commands) {
    // Pictures take the time and are tested with the main job.
    std::string shortened = command;
    if (command.rfind("assess ", 0) == 0) shortened += " --no-pictures";
    // So do fine images; what is found in them is tested with the phantom.
    if (command.rfind("phantom mri ", 0) == 0) {
      shortened += " --pixel-mm 1.2 --slice-mm 1.4 --slices 90 --no-fixture";
    }
    if (command.rfind("hand from-", 0) == 0) shortened += " --no-report";
    // So do many hands and candidates; what comes of them is tested with the redesigns.
    if (command.rfind("redesign ", 0) == 0) {
      const std::string many = " --hands 30";
      const std::size_t at = shortened.find(many);
      if (at != shortened.npos) shortened.erase(at, many.size());
      shortened += " --hands 2";
      const bool searches = command.rfind("redesign f", 0) == 0;  // fillet, features
      if (searches) shortened += " --evaluations 3";
    }
    const ProgramRun run = run_palmar(shortened, folder);
    EXPECT_EQ(run.exit_code, 0) << page << ": palmar " << command << "\n" << run.err;
  }
}

}  // namespace
}  // namespace palmar::testing
