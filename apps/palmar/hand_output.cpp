// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand_output.h"

#include <string_view>

#include "palmar/core/error.h"
#include "palmar/io/file.h"

namespace palmar::cli {
namespace {

constexpr std::string_view kHandEnding = ".hand.glb";

}  // namespace

void check_hand_output(const std::string& out) {
  if (out.size() <= kHandEnding.size() || !out.ends_with(kHandEnding)) {
    throw UsageError("--out: \"" + out + "\" must end in .hand.glb");
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
  write_file(trial, "");
  std::error_code ignored;
  std::filesystem::remove(trial, ignored);
}

std::string hand_name_of(const std::string& out) {
  return std::filesystem::path(beside_hand(out, "")).filename().string();
}

}  // namespace palmar::cli
