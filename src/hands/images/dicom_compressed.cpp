// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_compressed.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/program_missing.h"
#include "palmar/formats/process/worker.h"

namespace palmar::images {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kRle = "1.2.840.10008.1.2.5";

bool is_jpeg_ls(std::string_view transfer_syntax) {
  return transfer_syntax == "1.2.840.10008.1.2.4.80" || transfer_syntax == "1.2.840.10008.1.2.4.81";
}

// JPEG-LS and JPEG 2000 say "all the same" in a few bytes, whatever the size: without this a file
// of some hundred bytes would take minutes and gigabytes. MR images, noisy as they are, have a few
// pixels for a byte; images with loss up to about a hundred.
constexpr double kMostPixelsPerByte = 1000.0;
constexpr double kAlwaysUnpacked = 16e6;  // pixels; small enough to be unpacked whatever they are

/// The fragments of a file: a table of offsets, then those of all frames.
struct Fragments {
  std::string_view table;
  std::vector<std::string_view> piece;
  std::vector<std::uint64_t> start;  ///< of each piece, as the table counts

  Fragments() = default;
  Fragments(const DicomSlice& slice, std::string_view file) {
    auto at = static_cast<std::size_t>(slice.pixel_offset);
    const std::size_t first = at;
    std::size_t behind_table = first;
    while (at <= file.size() && file.size() - at >= 8) {
      if (formats::read_value<std::uint32_t>(file, at) != 0xE000FFFE) return;  // the delimiter
      const auto length = formats::read_value<std::uint32_t>(file, at + 4);
      if (length > file.size() - at - 8) break;
      if (at == first) {
        table = file.substr(at + 8, length);
        behind_table = at + 8 + length;
      } else {
        piece.push_back(file.substr(at + 8, length));
        start.push_back(at - behind_table);
      }
      at += 8 + length;
    }
    throw InputError(slice.path + ": the compressed pixels are cut off or damaged");
  }
};

/// The fragments of one frame, joined: all of a file with one frame, else one each, or by the table
/// of offsets.
std::string packed_frame(const DicomSlice& slice, const Fragments& fragments) {
  const std::size_t count = fragments.piece.size();
  const auto frames = static_cast<std::size_t>(slice.frames);
  const auto frame = static_cast<std::size_t>(slice.frame);
  std::size_t from = 0, to = count;
  if (frames > 1 && count == frames) {
    from = frame;
    to = frame + 1;
  } else if (frames > 1 && fragments.table.size() == 4 * frames) {
    const auto piece_at = [&](std::size_t f) {
      const auto offset = formats::read_value<std::uint32_t>(fragments.table, 4 * f);
      const auto found =
          std::lower_bound(fragments.start.begin(), fragments.start.end(), std::uint64_t{offset});
      if (found == fragments.start.end() || *found != offset) {
        throw InputError(
            fmt::format("{}: its table of offsets says that frame {} begins at byte {} of the "
                        "compressed pixels; no piece begins there",
                        slice.path, f + 1, offset));
      }
      return static_cast<std::size_t>(found - fragments.start.begin());
    };
    from = piece_at(frame);
    if (frame + 1 < frames) to = piece_at(frame + 1);
  } else if (frames > 1) {
    throw InputError(
        fmt::format("{}: {} compressed pieces of {} frames, without a table of where each begins",
                    slice.path, count, frames));
  }
  std::string joined;
  for (std::size_t f = from; f < to; ++f) joined += fragments.piece[f];
  if (joined.empty()) throw InputError(slice.name() + ": has no compressed pixels");
  return joined;
}

/// What a compressed stream says of its samples.
struct StreamSize {
  std::uint32_t columns = 0, rows = 0;
  int components = 0, bits = 0;
};

/// From the frame header of JPEG or JPEG-LS (ITU-T T.81, B.2.2; T.87, C.2.2) or the SIZ segment of
/// JPEG 2000 (T.800, A.5.1); nothing if the stream has none.
std::optional<StreamSize> stream_size(std::string_view stream) {
  const auto number = [&](std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      value = value << 8 | static_cast<std::uint8_t>(stream[at + i]);
    }
    return value;
  };
  if (stream.size() >= 43 && number(0, 4) == 0xFF4FFF51) {
    const std::uint32_t right = number(8, 4), bottom = number(12, 4);
    const std::uint32_t left = number(16, 4), top = number(20, 4);
    if (left >= right || top >= bottom) return std::nullopt;
    return StreamSize{right - left, bottom - top, static_cast<int>(number(40, 2)),
                      static_cast<int>(number(42, 1) & 0x7F) + 1};
  }
  if (stream.size() < 4 || number(0, 2) != 0xFFD8) return std::nullopt;
  std::size_t at = 2;
  while (stream.size() - at >= 10 && number(at, 1) == 0xFF) {
    const std::uint32_t marker = number(at + 1, 1);
    if (marker == 0xFF) {  // filling
      ++at;
      continue;
    }
    const bool is_frame = marker == 0xF7 || (marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 &&
                                             marker != 0xC8 && marker != 0xCC);
    if (is_frame) {
      return StreamSize{number(at + 7, 2), number(at + 5, 2), static_cast<int>(number(at + 9, 1)),
                        static_cast<int>(number(at + 4, 1))};
    }
    const std::size_t length = number(at + 2, 2);
    if (length < 2 || length + 2 > stream.size() - at) return std::nullopt;
    at += 2 + length;
  }
  return std::nullopt;
}

/// Whether a stream of JPEG-LS ends with the marker of an image's end (ITU-T T.87, C.1), behind
/// which DICOM may have put filling.
bool is_complete(std::string_view stream) {
  const std::size_t last = stream.find_last_not_of('\0');
  return last != std::string_view::npos && stream.substr(0, last + 1).ends_with("\xFF\xD9");
}

/// GDCM trusts that a stream has the size that the file says, and half of the JPEG-LS streams that
/// are cut off keep its decoder busy for ever.
void check_stream(const DicomSlice& slice, std::string_view stream) {
  const auto size = stream_size(stream);
  if (!size) {
    throw InputError(slice.name() +
                     ": its compressed image doesn't begin as JPEG, JPEG-LS or "
                     "JPEG 2000 do");
  }
  if (size->columns != static_cast<std::uint32_t>(slice.columns) ||
      size->rows != static_cast<std::uint32_t>(slice.rows)) {
    throw InputError(
        fmt::format("{}: its compressed image has {} x {} pixels; the file says {} x {}",
                    slice.name(), size->columns, size->rows, slice.columns, slice.rows));
  }
  if (is_jpeg_ls(slice.transfer_syntax) && !is_complete(stream)) {
    throw InputError(slice.name() + ": its compressed image is cut off: the end marker is missing");
  }
  const int allocated = size->bits <= 8 ? 8 : size->bits <= 16 ? 16 : 32;
  if (size->components != 1 || allocated != slice.bits_allocated) {
    throw InputError(
        fmt::format("{}: its compressed image has {} component{} of {} bits; the file says 1 of up "
                    "to {}",
                    slice.name(), size->components, size->components == 1 ? "" : "s", size->bits,
                    slice.bits_allocated));
  }
}

[[noreturn]] void fail(const std::string& path, const char* why) {
  throw InputError(path + ": " + why);
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
std::string unpacked_rle(const DicomSlice& slice, std::string_view packed) {
  const std::size_t count =
      static_cast<std::size_t>(slice.rows) * static_cast<std::size_t>(slice.columns);
  const auto depth = static_cast<std::size_t>(slice.bits_allocated / 8);
  if (packed.size() < 64 || formats::read_value<std::uint32_t>(packed, 0) != depth) {
    fail(slice.name(), "its run lengths don't fit the pixels' size");
  }
  if (packed.size() * 64 < count * depth) fail(slice.name(), "its run lengths end too early");
  std::string bytes(count * depth, '\0');
  for (std::size_t s = 0; s < depth; ++s) {
    const auto start = formats::read_value<std::uint32_t>(packed, 4 + 4 * s);
    const auto end = s + 1 < depth ? formats::read_value<std::uint32_t>(packed, 8 + 4 * s)
                                   : static_cast<std::uint32_t>(packed.size());
    if (start < 64 || end < start || end > packed.size()) {
      fail(slice.name(), "its run lengths are damaged");
    }
    const std::string plane =
        unpacked_run_lengths(packed.substr(start, end - start), count, slice.name());
    for (std::size_t i = 0; i < count; ++i) bytes[i * depth + depth - 1 - s] = plane[i];
  }
  return bytes;
}

/// The compressed bytes of slices, each file read once if its slices follow each other.
class PackedFrames {
 public:
  std::string of(const DicomSlice& slice) {
    if (slice.path != path_) {
      path_ = slice.path;
      file_ = formats::read_file(path_, kMaxImageBytes);
      fragments_ = Fragments(slice, file_);
    }
    return packed_frame(slice, fragments_);
  }

 private:
  std::string path_, file_;
  Fragments fragments_;
};

/// What messages call these slices: the slice, the file of several frames, or the folder.
std::string object_of(const std::vector<DicomSlice>& slices) {
  const DicomSlice& first = slices.front();
  if (slices.size() == 1) return first.name();
  const bool is_one_file = std::all_of(slices.begin(), slices.end(), [&](const DicomSlice& slice) {
    return slice.path == first.path;
  });
  return is_one_file ? first.path : std::filesystem::path(first.path).parent_path().string();
}

/// Runs the child on slices of one transfer syntax.
void unpack(const std::vector<DicomSlice>& slices, const Progress& progress,
            std::map<std::string, std::string>& result) {
  static const formats::Worker kDicom = {.program = "palmar-dicom",
                                         .variable = "PALMAR_DICOM",
                                         .name = "the DICOM program",
                                         .crashed = "the decoder crashed",
                                         .reason = "its compressed pixels are damaged"};
  if (!std::filesystem::exists(formats::program_of(kDicom))) {
    throw formats::ProgramMissing(formats::program_of(kDicom).string() +
                                  " isn't there, which compressed DICOM files are unpacked with");
  }
  Json frames = Json::array();
  std::string packed;
  double pixels = 0.0;
  const std::string object = object_of(slices);
  PackedFrames packed_frames;
  for (const DicomSlice& slice : slices) {
    const std::string bytes = packed_frames.of(slice);
    check_stream(slice, bytes);
    frames.push_back({{"name", slice.name()},
                      {"bytes", bytes.size()},
                      {"columns", slice.columns},
                      {"rows", slice.rows},
                      {"bits_allocated", slice.bits_allocated},
                      {"bits_stored", slice.bits_stored},
                      {"high_bit", slice.high_bit},
                      {"is_signed", slice.is_signed}});
    packed += bytes;
    pixels += static_cast<double>(slice.columns) * slice.rows;
    check_image_size(object, pixels, 1.0, 1.0);
    if (packed.size() > kMaxImageBytes) {
      throw InputError(object + ": has more than 2 GB of compressed pixels");
    }
  }
  if (pixels > kAlwaysUnpacked &&
      pixels > kMostPixelsPerByte * static_cast<double>(packed.size())) {
    throw InputError(
        fmt::format("{}: says it has {:g} million pixels in {} compressed bytes; up to {:g} pixels "
                    "for a byte are read",
                    object, 1e-6 * pixels, packed.size(), kMostPixelsPerByte));
  }
  const formats::WorkerFolder folder;
  formats::write_file(folder.path() / "packed.bin", packed);
  const formats::WorkerLimits limits = {
      .seconds = 30.0 + 1e-5 * pixels,
      .memory_mb = 1024.0 + 16e-6 * pixels + 2e-6 * static_cast<double>(packed.size()),
      .is_fixed = true};
  formats::run_worker(
      kDicom, "unpack",
      Json{{"transfer_syntax", slices[0].transfer_syntax}, {"frames", std::move(frames)}}.dump(),
      folder, object, limits, progress);
  const std::string unpacked = formats::read_file(folder.path() / "pixels.bin");
  std::size_t at = 0;
  for (const DicomSlice& slice : slices) {
    const std::size_t size = static_cast<std::size_t>(slice.rows) *
                             static_cast<std::size_t>(slice.columns) *
                             static_cast<std::size_t>(slice.bits_allocated / 8);
    if (size > unpacked.size() - at) throw InputError(slice.name() + ": unpacks to too few pixels");
    result[slice.name()] = unpacked.substr(at, size);
    at += size;
  }
}

}  // namespace

std::string unread_compression(std::string_view transfer_syntax) {
  static const std::map<std::string_view, std::string> kNames = {
      {kRle, ""},
      {"1.2.840.10008.1.2.4.50", ""},
      {"1.2.840.10008.1.2.4.51", ""},
      {"1.2.840.10008.1.2.4.57", ""},
      {"1.2.840.10008.1.2.4.70", ""},
      {"1.2.840.10008.1.2.4.80", ""},
      {"1.2.840.10008.1.2.4.81", ""},
      {"1.2.840.10008.1.2.4.90", ""},
      {"1.2.840.10008.1.2.4.91", ""},
      {"1.2.840.10008.1.2.4.100", "MPEG-2"}};
  const auto found = kNames.find(transfer_syntax);
  return found != kNames.end() ? found->second : fmt::format("transfer syntax {}", transfer_syntax);
}

std::map<std::string, std::string> unpacked_pixels(const std::vector<DicomSlice>& slices,
                                                   const Progress& progress) {
  std::map<std::string, std::vector<DicomSlice>> by_syntax;
  for (const DicomSlice& slice : slices) {
    const std::string unread = unread_compression(slice.transfer_syntax);
    if (!unread.empty()) {
      throw InputError(fmt::format("{}: is compressed ({}), which isn't read", slice.path, unread));
    }
    by_syntax[slice.transfer_syntax].push_back(slice);
  }
  std::map<std::string, std::string> result;
  for (const auto& [syntax, group] : by_syntax) {
    if (syntax != kRle) {
      unpack(group, progress, result);
      continue;
    }
    PackedFrames packed_frames;
    for (const DicomSlice& slice : group) {
      result[slice.name()] = unpacked_rle(slice, packed_frames.of(slice));
    }
  }
  return result;
}

}  // namespace palmar::images
