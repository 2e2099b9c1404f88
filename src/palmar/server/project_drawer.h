// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/server/product_shelf.h"

namespace palmar::server {

/// What stood on a bench, kept by itself.
struct KeptProject {
  std::string key;           ///< a plain name (is_plain_name())
  std::string file_name;     ///< of the product
  std::int64_t changed = 0;  ///< ms since 1970
  std::string picture;       ///< a small one, as a data URL; may be empty
};

/// Recent projects, in a folder of the user's: FOLDER/KEY/ with `project.json` (state and picture),
/// `history.json` (the steps) and the product's file. Every file is written under a temporary name
/// and renamed, project.json last: a project is there as it was before or as it is now. Several
/// servers may share the folder. Thread-safe.
class ProjectDrawer {
 public:
  /// Nothing is made before something is kept. No folder: nothing can be kept.
  explicit ProjectDrawer(std::optional<std::filesystem::path> folder);

  /// At most this many; the one that wasn't changed for longest goes.
  static constexpr std::size_t kMost = 24;

  const std::optional<std::filesystem::path>& folder() const { return folder_; }
  /// The newest first; what can't be read is left out.
  std::vector<KeptProject> list() const;
  /// `content`: {"state": {...}, "picture": "data:...", "history": ...}; the product's file is
  /// copied the first time. Throws UsageError: a name that is none, content that is no such object;
  /// OutputError: no folder, disk full.
  void keep(const std::string& key, const ShelvedProduct& product, std::string_view content);

  struct Opened {
    ShelvedProduct product;      ///< without key and not read
    std::string state, history;  ///< JSON as it was given; history "null" if there is none
  };
  /// Throws UsageError if there is none of that name, InputError if it is damaged.
  Opened open(const std::string& key) const;
  void remove(const std::string& key);  ///< throws UsageError as above

 private:
  std::filesystem::path place(const std::string& key) const;
  void remove_oldest();

  mutable std::mutex mutex_;
  std::optional<std::filesystem::path> folder_;
};

}  // namespace palmar::server
