// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/image/dicom_compressed.h"

#include <fmt/format.h>

#include <map>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"

namespace palmar {
namespace {

constexpr std::string_view kRle = "1.2.840.10008.1.2.5";

[[noreturn]] void fail(const std::string& path, const char* why) {
  throw InputError(path + ": " + why);
}

/// The fragments behind the table of offsets, joined.
std::string joined_fragments(const DicomSlice& slice, std::string_view file) {
  std::string joined;
  auto at = static_cast<std::size_t>(slice.pixel_offset);
  for (bool is_table = true;; is_table = false) {
    if (at > file.size() || file.size() - at < 8) break;
    if (read_value<std::uint32_t>(file, at) != 0xE000FFFE) return joined;  // the delimiter
    const auto length = read_value<std::uint32_t>(file, at + 4);
    at += 8;
    if (length > file.size() - at) break;
    if (!is_table) joined += file.substr(at, length);
    at += length;
  }
  fail(slice.path, "the compressed pixels are cut off or damaged");
}

/// One byte of every pixel.
std::string unpacked_run_lengths(std::string_view packed, std::size_t count,
                                 const std::string& path) {
  std::string bytes;
  bytes.reserve(count);
  std::size_t at = 0;
  while (bytes.size() < count) {
    if (at >= packed.size()) fail(path, "its run lengths end too early");
    const auto code = static_cast<signed char>(packed[at++]);
    if (code == -128) continue;
    const std::size_t length =
        code >= 0 ? static_cast<std::size_t>(code) + 1 : static_cast<std::size_t>(1 - code);
    const std::size_t taken = code >= 0 ? length : 1;
    if (packed.size() - at < taken) fail(path, "its run lengths end too early");
    if (length > count - bytes.size()) fail(path, "its run lengths give too many pixels");
    if (code >= 0) {
      bytes += packed.substr(at, length);
    } else {
      bytes.append(length, packed[at]);
    }
    at += taken;
  }
  return bytes;
}

/// Segments hold the pixels' bytes one after the other, the highest first.
std::string unpacked_rle(const DicomSlice& slice, std::string_view packed, std::size_t count) {
  const auto depth = static_cast<std::size_t>(slice.bits_allocated / 8);
  if (packed.size() < 64 || read_value<std::uint32_t>(packed, 0) != depth) {
    fail(slice.path, "its run lengths don't fit the pixels' size");
  }
  if (packed.size() * 64 < count * depth) fail(slice.path, "its run lengths end too early");
  std::string bytes(count * depth, '\0');
  for (std::size_t s = 0; s < depth; ++s) {
    const auto start = read_value<std::uint32_t>(packed, 4 + 4 * s);
    const auto end = s + 1 < depth ? read_value<std::uint32_t>(packed, 8 + 4 * s)
                                   : static_cast<std::uint32_t>(packed.size());
    if (start < 64 || end < start || end > packed.size()) {
      fail(slice.path, "its run lengths are damaged");
    }
    const std::string plane =
        unpacked_run_lengths(packed.substr(start, end - start), count, slice.path);
    for (std::size_t i = 0; i < count; ++i) bytes[i * depth + depth - 1 - s] = plane[i];
  }
  return bytes;
}

}  // namespace

std::string unread_compression(std::string_view transfer_syntax) {
  static const std::map<std::string_view, std::string> kNames = {
      {kRle, ""},
      {"1.2.840.10008.1.2.4.57", ""},
      {"1.2.840.10008.1.2.4.70", ""},
      {"1.2.840.10008.1.2.4.50", "lossy JPEG"},
      {"1.2.840.10008.1.2.4.51", "lossy JPEG"},
      {"1.2.840.10008.1.2.4.80", "JPEG-LS"},
      {"1.2.840.10008.1.2.4.81", "JPEG-LS"},
      {"1.2.840.10008.1.2.4.90", "JPEG 2000"},
      {"1.2.840.10008.1.2.4.91", "JPEG 2000"}};
  const auto found = kNames.find(transfer_syntax);
  return found != kNames.end() ? found->second : fmt::format("transfer syntax {}", transfer_syntax);
}

std::string decompressed_pixels(const DicomSlice& slice, std::string_view file) {
  const std::string unread = unread_compression(slice.transfer_syntax);
  if (!unread.empty()) {
    throw InputError(fmt::format("{}: is compressed ({}), which isn't read", slice.path, unread));
  }
  const std::string packed = joined_fragments(slice, file);
  const std::size_t count =
      static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns);
  if (slice.transfer_syntax == kRle) return unpacked_rle(slice, packed, count);
  const int bits = slice.bits_allocated;
  if (bits > 16) fail(slice.path, "is lossless JPEG of more than 16 bits");
  std::string bytes;
  bytes.reserve(2 * count);
  for (const std::uint16_t value : lossless_jpeg(packed, slice.columns, slice.rows, slice.path)) {
    if (bits == 8) {
      append_value(bytes, static_cast<std::uint8_t>(value & 0xFF));
    } else {
      append_value(bytes, value);
    }
  }
  return bytes;
}

}  // namespace palmar
