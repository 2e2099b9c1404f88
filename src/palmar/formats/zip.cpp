// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/zip.h"

#include <zlib.h>

#include <algorithm>
#include <cctype>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/formats/bytes.h"

namespace palmar::formats {
namespace {

constexpr std::uint64_t kLargestMember = std::uint64_t{1} << 30;
constexpr std::uint32_t kNotHere32 = 0xffffffff;  // "see the ZIP64 field"
constexpr std::uint16_t kNotHere16 = 0xffff;

std::string plain_name(std::string_view name) {
  while (!name.empty() && name.front() == '/') name.remove_prefix(1);
  return lower_case(name);
}

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  // The end record lies within the last 22 + 65535 bytes, behind it only a comment.
  constexpr std::size_t kEndBytes = 22;
  const std::size_t tail = std::min<std::size_t>(bytes_.size(), kEndBytes + 65535);
  const std::size_t end = bytes_.rfind(std::string_view("PK\x05\x06", 4), bytes_.size());
  if (end == bytes_.npos || end + kEndBytes > bytes_.size() || end < bytes_.size() - tail) {
    throw InputError(name_ + ": is truncated: the ZIP directory at its end is missing (" +
                     std::to_string(bytes_.size()) + " bytes)");
  }
  std::uint64_t count = read_value<std::uint16_t>(bytes_, end + 10);
  std::uint64_t start = read_value<std::uint32_t>(bytes_, end + 16);
  const bool is_zip64 = count == kNotHere16 || start == kNotHere32;
  if (is_zip64 && end >= 20 && bytes_.substr(end - 20, 4) == std::string_view("PK\x06\x07", 4)) {
    const auto record = read_value<std::uint64_t>(bytes_, end - 12);
    const std::string_view zip64 = slice(record, 56, "ZIP64 end record");
    count = read_value<std::uint64_t>(zip64, 32);
    start = read_value<std::uint64_t>(zip64, 48);
  }
  read_directory(start, count);
}

std::string_view ZipArchive::slice(std::uint64_t offset, std::uint64_t length,
                                   const char* what) const {
  if (offset > bytes_.size() || length > bytes_.size() - offset) {
    throw InputError(name_ + ": is damaged or truncated: its " + what + " reaches to byte " +
                     std::to_string(offset) + " + " + std::to_string(length) + " of " +
                     std::to_string(bytes_.size()));
  }
  return bytes_.substr(offset, length);
}

void ZipArchive::read_directory(std::uint64_t start, std::uint64_t count) {
  constexpr std::uint64_t kEntryBytes = 46;
  for (std::uint64_t i = 0, at = start; i < count; ++i) {
    const std::string_view entry = slice(at, kEntryBytes, "ZIP directory");
    if (entry.substr(0, 4) != std::string_view("PK\x01\x02", 4)) {
      throw InputError(name_ + ": is damaged: entry " + std::to_string(i + 1) +
                       " of the ZIP directory has no signature");
    }
    Member member;
    member.flags = read_value<std::uint16_t>(entry, 8);
    member.method = read_value<std::uint16_t>(entry, 10);
    member.checksum = read_value<std::uint32_t>(entry, 16);
    member.packed_size = read_value<std::uint32_t>(entry, 20);
    member.size = read_value<std::uint32_t>(entry, 24);
    member.offset = read_value<std::uint32_t>(entry, 42);
    const std::uint64_t name_length = read_value<std::uint16_t>(entry, 28);
    const std::uint64_t extra_length = read_value<std::uint16_t>(entry, 30);
    const std::uint64_t comment_length = read_value<std::uint16_t>(entry, 32);
    member.name = plain_name(slice(at + kEntryBytes, name_length, "ZIP directory"));

    // ZIP64: the values that don't fit stand in an extra field, in this order.
    std::string_view extra = slice(at + kEntryBytes + name_length, extra_length, "ZIP directory");
    while (extra.size() >= 4) {
      const auto id = read_value<std::uint16_t>(extra, 0);
      const std::size_t length =
          std::min<std::size_t>(read_value<std::uint16_t>(extra, 2), extra.size() - 4);
      if (id == 1) {
        std::string_view values = extra.substr(4, length);
        for (std::uint64_t* value : {&member.size, &member.packed_size, &member.offset}) {
          if (*value != kNotHere32 || values.size() < 8) continue;
          *value = read_value<std::uint64_t>(values, 0);
          values.remove_prefix(8);
        }
      }
      extra.remove_prefix(4 + length);
    }
    members_.push_back(std::move(member));
    at += kEntryBytes + name_length + extra_length + comment_length;
  }
}

std::optional<std::string> ZipArchive::read(std::string_view wanted) const {
  const std::string plain = plain_name(wanted);
  const auto found = std::find_if(members_.begin(), members_.end(),
                                  [&](const Member& member) { return member.name == plain; });
  if (found == members_.end()) return std::nullopt;
  const Member& member = *found;
  const std::string what = name_ + ": member \"" + member.name + "\"";
  if ((member.flags & 1) != 0) throw InputError(what + " is encrypted");
  if (member.size > kLargestMember) {
    throw InputError(what + " unpacks to " + std::to_string(member.size) + " bytes; up to " +
                     std::to_string(kLargestMember) + " are read");
  }
  const std::string_view local = slice(member.offset, 30, "ZIP member");
  if (local.substr(0, 4) != std::string_view("PK\x03\x04", 4)) {
    throw InputError(what + " is damaged: no signature at byte " + std::to_string(member.offset));
  }
  const std::uint64_t data_start = member.offset + 30 + read_value<std::uint16_t>(local, 26) +
                                   read_value<std::uint16_t>(local, 28);
  const std::string_view packed = slice(data_start, member.packed_size, "ZIP member");

  std::string content;
  if (member.method == 0) {
    content = std::string(packed);
  } else if (member.method == 8) {
    // Deflate packs 1032 to 1 at best; a size beyond that is a lie that would cost memory.
    if (member.size / 1032 > packed.size()) {
      throw InputError(what + " is damaged: " + std::to_string(packed.size()) +
                       " bytes can't unpack to " + std::to_string(member.size));
    }
    content.resize(member.size);
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw InputError(what + ": zlib failed");
    // zlib never writes to next_in; its interface predates const. Sizes fit: at most 1 GiB, and
    // packed data longer than 4 GiB can't unpack to that.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(std::min<std::uint64_t>(packed.size(), kNotHere32));
    stream.next_out = reinterpret_cast<Bytef*>(content.data());
    stream.avail_out = static_cast<uInt>(content.size());
    const int status = inflate(&stream, Z_FINISH);
    const bool is_whole = status == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    if (!is_whole) throw InputError(what + " is damaged: it can't be unpacked");
  } else {
    throw InputError(what + " is packed by method " + std::to_string(member.method) +
                     "; 0 (stored) and 8 (deflated) are read");
  }
  const uLong checksum =
      crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
  if (content.size() != member.size || checksum != member.checksum) {
    throw InputError(what + " is damaged: length or checksum differ");
  }
  return content;
}

}  // namespace palmar::formats
