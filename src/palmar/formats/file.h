// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace palmar::formats {

/// Largest input that is read into memory; a binary STL of 50 million triangles has 2.5 GB.
inline constexpr std::uint64_t kMaxInputBytes = std::uint64_t{4} << 30;

/// The whole file as bytes. Throws InputError naming the path and what is wrong with it: missing, a
/// directory, a pipe or device, unreadable (with the system's words), empty, or more than
/// `max_bytes`.
std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes = kMaxInputBytes);

/// What a file begins and ends with, to determine what it is without reading it. Both at most
/// `size` bytes; they overlap in a short file. Throws InputError as read_file().
struct FileEnds {
  std::string head, tail;
  std::uint64_t bytes = 0;  ///< of the whole file
};
FileEnds read_ends(const std::filesystem::path& path, std::size_t size);

/// Writes a file so that at any moment the path holds either the old or the whole new content: a
/// temporary name in the same folder, fsync, rename. On failure nothing is left behind and an old
/// file stays as it was. Existing devices and pipes are written directly; symbolic links are
/// followed. Throws OutputError naming the path and the system's words (folder missing, no
/// permission, disk full).
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Makes a folder and its parents; content if it is there already. Throws OutputError.
void create_folder(const std::filesystem::path& path);

}  // namespace palmar::formats
