// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palmar::formats {

/// The members of a ZIP archive in memory (stored or deflated, ZIP64 included, no encryption).
/// Nothing is unpacked before it is asked for, and never more than 1 GiB, so that a small hostile
/// file can't fill the memory.
///
/// Source: PKWARE, APPNOTE.TXT - .ZIP File Format Specification, 6.3.
class ZipArchive {
 public:
  /// Reads the central directory. Keeps a view of `bytes`. Throws InputError "`name`: ..." if it is
  /// damaged or cut off.
  ZipArchive(std::string_view bytes, std::string name);

  /// Content of a member, compared without regard to case or a leading slash; nothing if there is
  /// no such member. Throws InputError if it is damaged (lengths, checksum) or unpacks to too much.
  std::optional<std::string> read(std::string_view member) const;

 private:
  struct Member {
    std::string name;  ///< lower case, no leading slash
    std::uint64_t packed_size = 0;
    std::uint64_t size = 0;
    std::uint64_t offset = 0;
    std::uint32_t checksum = 0;
    std::uint16_t method = 0;
    std::uint16_t flags = 0;
  };
  void read_directory(std::uint64_t start, std::uint64_t count);
  std::string_view slice(std::uint64_t offset, std::uint64_t length, const char* what) const;

  std::string_view bytes_;
  std::string name_;
  std::vector<Member> members_;
};

}  // namespace palmar::formats
