// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace palmar::server {

/// Files that a client sends one by one and that belong together (photographs, an MR series), in a
/// folder for each key of the client's until a job takes them. Thread-safe.
class UploadDrawer {
 public:
  explicit UploadDrawer(std::filesystem::path folder) : folder_(std::move(folder)) {}

  static constexpr std::size_t kMostFiles = 4000;                       ///< of one key
  static constexpr std::uint64_t kMostBytes = std::uint64_t{4} << 30U;  ///< of all
  static constexpr std::size_t kMostKeys = 16;

  /// `name` may have folders in it ("reference/p0_c1.jpg"): each part is made safe. Throws
  /// UsageError for a key that isn't plain, or too much; OutputError.
  void add(const std::string& key, std::string_view name, std::string_view bytes);
  /// Where they are. Throws UsageError if nothing was sent under that key.
  std::filesystem::path folder(const std::string& key) const;
  /// They are somebody else's now, or not wanted.
  void forget(const std::string& key);

 private:
  struct Kept {
    std::size_t files = 0;
    std::uint64_t bytes = 0;
  };

  std::filesystem::path folder_;
  mutable std::mutex mutex_;
  std::map<std::string, Kept> kept_;
};

/// "reference/p0_c1.jpg" with every part as safe_file_name() has it; at most five parts.
std::filesystem::path safe_relative_path(std::string_view name);

/// All regular files under a folder, as paths relative to it with '/', sorted; no links.
std::vector<std::string> files_under(const std::filesystem::path& folder);

}  // namespace palmar::server
