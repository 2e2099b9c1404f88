// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/upload_drawer.h"

#include <algorithm>
#include <iterator>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/text_scan.h"
#include "palmar/server/access.h"

namespace palmar::server {

std::filesystem::path safe_relative_path(std::string_view name) {
  constexpr std::ptrdiff_t kMostParts = 5;
  std::filesystem::path path;
  while (!name.empty()) {
    const std::size_t end = std::min(name.find_first_of("/\\"), name.size());
    if (end > 0) path /= safe_file_name(name.substr(0, end));
    name.remove_prefix(std::min(end + 1, name.size()));
  }
  const std::ptrdiff_t parts = std::distance(path.begin(), path.end());
  if (parts == 0 || parts > kMostParts) {
    throw UsageError("a file has 1 to 5 names from its folder on, not " + std::to_string(parts));
  }
  return path;
}

std::vector<std::string> files_under(const std::filesystem::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::recursive_directory_iterator at(folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->is_regular_file(error) && !at->is_symlink(error)) {
      files.push_back(at->path().lexically_relative(folder).generic_string());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void UploadDrawer::add(const std::string& key, std::string_view name, std::string_view bytes) {
  if (!is_plain_name(key)) {
    throw UsageError("upload " + formats::in_quotes(key) +
                     ": letters, digits, - and _ are allowed");
  }
  const std::filesystem::path inside = safe_relative_path(name);
  const std::filesystem::path path = folder_ / key / inside;
  std::filesystem::path above = folder_ / key;
  for (const auto& part : inside.parent_path()) {
    above /= part;
    if (std::filesystem::is_regular_file(above)) {
      throw UsageError("upload: " + formats::in_quotes(part.string()) + " is a file and a folder");
    }
  }
  if (std::filesystem::is_directory(path)) {
    throw UsageError("upload: " + formats::in_quotes(inside.string()) + " is a folder and a file");
  }
  {
    const std::scoped_lock lock(mutex_);
    std::uint64_t all = bytes.size();
    for (const auto& [other, kept] : kept_) all += kept.bytes;
    if (all > kMostBytes) {
      throw UsageError("more than 4 GB were sent and are not used; send less, or start anew");
    }
    if (!kept_.contains(key) && kept_.size() >= kMostKeys) {
      throw UsageError("too many uploads wait to be used; start palmar serve again");
    }
    if (kept_[key].files >= kMostFiles) {
      throw UsageError("more than " + std::to_string(kMostFiles) + " files were sent");
    }
    ++kept_[key].files;
    kept_[key].bytes += bytes.size();
  }
  formats::create_folder(path.parent_path());
  formats::write_file(path, bytes);
}

std::filesystem::path UploadDrawer::folder(const std::string& key) const {
  const std::scoped_lock lock(mutex_);
  if (!kept_.contains(key))
    throw UsageError("upload " + formats::in_quotes(key) + " is not there (any more)");
  return folder_ / key;
}

void UploadDrawer::forget(const std::string& key) {
  const std::scoped_lock lock(mutex_);
  if (kept_.erase(key) == 0) return;
  std::error_code ignored;
  std::filesystem::remove_all(folder_ / key, ignored);
}

}  // namespace palmar::server
