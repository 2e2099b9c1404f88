// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/zip_write.h"

#include <zlib.h>

#include <cstdint>

#include "palmar/core/error.h"

namespace palmar::formats {
namespace {

constexpr std::uint64_t kLargest32 = 0xffffffff;
constexpr std::size_t kLargest16 = 0xffff;
constexpr std::uint16_t kVersion = 20;       // 2.0: folders and deflate
constexpr std::uint16_t kUtf8Names = 0x800;  // general purpose bit 11
constexpr std::uint16_t kDeflated = 8;
constexpr std::uint16_t kNoTime = 0;
constexpr std::uint16_t kFirstDay = (1 << 5) | 1;  // 1 January 1980

void put_number(std::string& out, std::uint64_t value, int bytes) {
  for (int k = 0; k < bytes; ++k) out += static_cast<char>((value >> (8 * k)) & 0xff);
}

/// Raw deflate (RFC 1951), as archives have it.
std::string deflated(const std::string& text, const std::string& name) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) !=
      Z_OK) {
    throw Error("zip: " + name + " can't be packed: zlib has no memory");
  }
  std::string packed(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  const int end = deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  if (end != Z_STREAM_END) throw Error("zip: " + name + " can't be packed");
  return packed;
}

/// What local header and directory entry share, 26 bytes.
std::string shared_fields(const ZipMember& member, const std::string& packed) {
  const auto* bytes = reinterpret_cast<const Bytef*>(member.content.data());
  const uLong checksum = crc32(0, bytes, static_cast<uInt>(member.content.size()));
  std::string out;
  put_number(out, kVersion, 2);
  put_number(out, kUtf8Names, 2);
  put_number(out, kDeflated, 2);
  put_number(out, kNoTime, 2);
  put_number(out, kFirstDay, 2);
  put_number(out, checksum, 4);
  put_number(out, packed.size(), 4);
  put_number(out, member.content.size(), 4);
  put_number(out, member.name.size(), 2);
  put_number(out, 0, 2);  // no extra field
  return out;
}

}  // namespace

std::string format_zip(const std::vector<ZipMember>& members) {
  if (members.size() > kLargest16) {
    throw UsageError("zip: " + std::to_string(members.size()) + " members; 65535 are allowed");
  }
  std::string out, directory;
  for (const ZipMember& member : members) {
    if (member.name.empty() || member.name.size() > kLargest16) {
      throw UsageError("zip: a name of " + std::to_string(member.name.size()) +
                       " bytes; 1 to 65535 are allowed");
    }
    if (member.content.size() > kLargest32 || out.size() + member.content.size() > kLargest32) {
      throw UsageError("zip: " + member.name + " makes the archive larger than 4 GiB");
    }
    const std::string packed = deflated(member.content, member.name);
    const std::string shared = shared_fields(member, packed);
    const std::size_t place = out.size();
    out += std::string("PK\x03\x04", 4) + shared + member.name + packed;
    directory += std::string("PK\x01\x02", 4);
    put_number(directory, kVersion, 2);  // made by
    directory += shared;
    put_number(directory, 0, 2);  // no comment
    put_number(directory, 0, 2);  // on this disk
    put_number(directory, 0, 2);  // no attributes
    put_number(directory, 0, 4);
    put_number(directory, place, 4);
    directory += member.name;
  }
  const std::size_t start = out.size();
  out += directory + std::string("PK\x05\x06", 4);
  put_number(out, 0, 2);  // one disk
  put_number(out, 0, 2);
  put_number(out, members.size(), 2);
  put_number(out, members.size(), 2);
  put_number(out, directory.size(), 4);
  put_number(out, start, 4);
  put_number(out, 0, 2);  // no comment
  return out;
}

}  // namespace palmar::formats
