// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace palmar::testing {
namespace {

namespace fs = std::filesystem;

/// Removes the folders of temporary_folder() when the program ends.
struct Folders {
  std::vector<std::string> paths;
  ~Folders() {
    std::error_code ignored;
    for (const std::string& path : paths) fs::remove_all(path, ignored);
  }
};

Folders& folders() {
  static Folders all;
  return all;
}

}  // namespace

bool has_program(const std::string& name) {
  return fs::exists(fs::path(PALMAR_EXECUTABLE).parent_path() / name);
}

std::string temporary_folder() {
  std::string pattern = (fs::temp_directory_path() / "palmar-test-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
  folders().paths.push_back(pattern);
  return pattern;
}

std::string write_text(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("can't write " + path);
  return path;
}

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

ProgramRun run_palmar(const std::string& arguments, const std::string& folder) {
  const std::string scratch = temporary_folder();
  const std::string command = "cd '" + folder + "' && { '" PALMAR_EXECUTABLE "' " + arguments +
                              "; } >'" + scratch + "/out' 2>'" + scratch + "/err' </dev/null";
  const int status = std::system(command.c_str());
  ProgramRun run;
  if (WIFEXITED(status) && WEXITSTATUS(status) != 139 && WEXITSTATUS(status) != 134) {
    run.exit_code = WEXITSTATUS(status);
  }
  run.out = read_text(scratch + "/out");
  run.err = read_text(scratch + "/err");
  return run;
}

}  // namespace palmar::testing
