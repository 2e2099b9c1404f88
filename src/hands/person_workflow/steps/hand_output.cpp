// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/hand_output.h"

#include <string_view>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::person_workflow {
namespace {

constexpr std::string_view kHandEnding = ".hand.glb";

}  // namespace

void check_hand_output(const std::string& out) {
  if (out.size() <= kHandEnding.size() || !out.ends_with(kHandEnding)) {
    throw UsageError("setting \"out\": \"" + out + "\" must end in .hand.glb");
  }
}

void refuse_overwriting(const std::string& input, const std::string& out, const std::string& what) {
  std::error_code ignored;
  if (input == out || std::filesystem::equivalent(input, out, ignored)) {
    throw UsageError("setting \"out\" " + out + ": is the " + what +
                     " itself; the original stays as it is, name another file");
  }
}

std::string beside_hand(const std::string& out, const std::string& ending) {
  return out.substr(0, out.size() - kHandEnding.size()) + ending;
}

std::filesystem::path folder_of(const std::string& out) {
  const std::filesystem::path folder = std::filesystem::path(out).parent_path();
  return folder.empty() ? std::filesystem::path(".") : folder;
}

void require_writable(const std::filesystem::path& folder) {
  const std::filesystem::path trial = folder / ".palmar-trial";
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) {
    throw OutputError(folder.string() + ": there is no such folder to write to");
  }
  try {
    formats::write_file(trial, "");
  } catch (const OutputError& error) {
    const std::string_view what = error.what();  // "FILE: can't be written: REASON"
    const std::size_t reason = what.rfind(": ");
    throw OutputError(folder.string() + ": nothing can be written into this folder" +
                      std::string(reason == std::string_view::npos ? "" : what.substr(reason)));
  }
  std::filesystem::remove(trial, ignored);
}

WorkFolder::WorkFolder(const std::filesystem::path& path) : path_(path) {
  std::error_code ignored;
  is_new_ = !std::filesystem::exists(path, ignored);
  formats::create_folder(path);
  require_writable(path);
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  if (is_new_) std::filesystem::remove(path_, ignored);  // only if it is empty
}

std::string hand_name_of(const std::string& out) {
  return std::filesystem::path(beside_hand(out, "")).filename().string();
}

}  // namespace palmar::person_workflow
