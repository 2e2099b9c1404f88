// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/image/exif.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace palmar {
namespace {

constexpr std::string_view kHead("Exif\0\0", 6);

enum Tag : std::uint16_t {
  kMake = 0x010F,
  kModel = 0x0110,
  kExifFields = 0x8769,
  kFocalLength = 0x920A,
  kWidth = 0xA002,
  kHeight = 0xA003,
  kFocalPlaneX = 0xA20E,
  kFocalPlaneUnit = 0xA210,
  kFocal35mm = 0xA405,
  kSerial = 0xA431,
};

enum Type : std::uint16_t { kAscii = 2, kShort = 3, kLong = 4, kRational = 5 };

/// Numbers of either byte order; beyond the end: 0.
class TiffBytes {
 public:
  explicit TiffBytes(std::string_view bytes) : bytes_(bytes), is_little_(bytes.starts_with("II")) {}

  std::uint32_t number(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return 0;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = is_little_ ? at + size - 1 - i : at + i;
      value = value << 8 | static_cast<std::uint8_t>(bytes_[from]);
    }
    return value;
  }
  std::string_view text(std::size_t at, std::size_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) return {};
    return bytes_.substr(at, size);
  }

 private:
  std::string_view bytes_;
  bool is_little_;
};

struct Field {
  std::uint16_t type = 0;
  std::uint32_t count = 0;
  std::size_t at = 0;  ///< of its value
};

double number_of(const TiffBytes& tiff, const Field& field) {
  if (field.type == kShort) return tiff.number(field.at, 2);
  if (field.type == kLong) return tiff.number(field.at, 4);
  if (field.type != kRational) return 0.0;
  const double divisor = tiff.number(field.at + 4, 4);
  return divisor > 0.0 ? tiff.number(field.at, 4) / divisor : 0.0;
}

std::string text_of(const TiffBytes& tiff, const Field& field) {
  if (field.type != kAscii) return {};
  std::string text(tiff.text(field.at, field.count));
  while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
  return text;
}

/// Calls take(tag, field) for every field of the directory at `at`.
template <typename Take>
void read_directory(const TiffBytes& tiff, std::size_t at, const Take& take) {
  const std::uint32_t count = tiff.number(at, 2);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t entry = at + 2 + std::size_t{12} * i;
    Field field{static_cast<std::uint16_t>(tiff.number(entry + 2, 2)), tiff.number(entry + 4, 4),
                entry + 8};
    const std::size_t size = field.type == kRational ? 8
                             : field.type == kLong   ? 4
                             : field.type == kShort  ? 2
                                                     : 1;
    constexpr std::size_t kInPlace = 4;
    if (size * field.count > kInPlace) field.at = tiff.number(entry + 8, 4);
    take(static_cast<std::uint16_t>(tiff.number(entry, 2)), field);
  }
}

void append(std::string& words, const std::string& more) {
  if (more.empty()) return;
  words += (words.empty() ? "" : " ") + more;
}

PhotoExif parse(const TiffBytes& tiff) {
  PhotoExif exif;
  std::string make, model, serial;
  double resolution = 0.0, unit = 2.0;
  const auto take = [&](std::uint16_t tag, const Field& field) {
    switch (tag) {
      case kMake:
        make = text_of(tiff, field);
        break;
      case kModel:
        model = text_of(tiff, field);
        break;
      case kSerial:
        serial = text_of(tiff, field);
        break;
      case kFocalLength:
        exif.focal_mm = number_of(tiff, field);
        break;
      case kFocal35mm:
        exif.focal_35mm = number_of(tiff, field);
        break;
      case kFocalPlaneX:
        resolution = number_of(tiff, field);
        break;
      case kFocalPlaneUnit:
        unit = number_of(tiff, field);
        break;
      case kWidth:
        exif.width = static_cast<int>(number_of(tiff, field));
        break;
      case kHeight:
        exif.height = static_cast<int>(number_of(tiff, field));
        break;
      default:
        break;
    }
  };
  std::size_t inner = 0;
  read_directory(tiff, tiff.number(4, 4), [&](std::uint16_t tag, const Field& field) {
    if (tag == kExifFields) inner = tiff.number(field.at, 4);
    take(tag, field);
  });
  if (inner > 0) read_directory(tiff, inner, take);
  append(exif.camera, make);
  append(exif.camera, model);
  append(exif.camera, serial);
  constexpr double kInch = 25.4, kCentimetre = 10.0;  // mm
  exif.pixels_per_mm = resolution / (unit == 3.0 ? kCentimetre : kInch);
  return exif;
}

/// A directory of fields in big-endian order.
class Directory {
 public:
  void add(Tag tag, Type type, std::uint32_t count, const std::string& value) {
    fields_.push_back({tag, type, count, value});
  }
  void add_text(Tag tag, const std::string& text) {
    add(tag, kAscii, static_cast<std::uint32_t>(text.size() + 1), text + '\0');
  }
  void add_number(Tag tag, double value) {
    constexpr std::uint32_t kParts = 1000;
    add(tag, kRational, 1,
        bytes(static_cast<std::uint32_t>(std::lround(value * kParts)), 4) + bytes(kParts, 4));
  }
  void add_short(Tag tag, int value) {
    add(tag, kShort, 1, bytes(static_cast<std::uint32_t>(value), 2));
  }
  void add_long(Tag tag, std::uint32_t value) { add(tag, kLong, 1, bytes(value, 4)); }

  std::size_t size() const {
    std::size_t sum = 6 + 12 * fields_.size();
    for (const auto& field : fields_) sum += field.value.size() > 4 ? field.value.size() : 0;
    return sum;
  }
  /// As it stands at `at` in the file.
  std::string format(std::size_t at) const {
    std::string head = bytes(static_cast<std::uint32_t>(fields_.size()), 2), tail;
    const std::size_t behind = at + 6 + 12 * fields_.size();
    for (const auto& field : fields_) {
      head += bytes(field.tag, 2) + bytes(field.type, 2) + bytes(field.count, 4);
      if (field.value.size() > 4) {
        head += bytes(static_cast<std::uint32_t>(behind + tail.size()), 4);
        tail += field.value;
      } else {
        head += field.value + std::string(4 - field.value.size(), '\0');
      }
    }
    return head + bytes(0, 4) + tail;
  }
  static std::string bytes(std::uint32_t value, int size) {
    std::string text;
    for (int i = size - 1; i >= 0; --i) text += static_cast<char>(value >> (8 * i) & 0xFF);
    return text;
  }

 private:
  struct Entry {
    Tag tag;
    Type type;
    std::uint32_t count;
    std::string value;
  };
  std::vector<Entry> fields_;
};

}  // namespace

std::optional<double> PhotoExif::focal_pixels(int picture_width, int picture_height) const {
  const double larger = std::max(picture_width, picture_height);
  if (focal_mm > 0.0 && pixels_per_mm > 0.0) {
    // The picture may have been made smaller since.
    const double taken = std::max(width, height);
    return focal_mm * pixels_per_mm * (taken > 0.0 ? larger / taken : 1.0);
  }
  if (focal_35mm > 0.0) {
    const double film = std::hypot(36.0, 24.0);  // mm
    return focal_35mm * std::hypot(picture_width, picture_height) / film;
  }
  return {};
}

std::optional<PhotoExif> read_exif(std::string_view jpeg) {
  if (!jpeg.starts_with("\xff\xd8")) return {};
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(jpeg[at]); };
  std::size_t at = 2;
  while (at + 4 <= jpeg.size() && byte(at) == 0xFF) {
    const std::uint8_t marker = byte(at + 1);
    const std::size_t length = std::size_t{byte(at + 2)} << 8 | byte(at + 3);
    if (length < 2 || marker == 0xDA) return {};  // the picture itself
    const std::string_view segment = jpeg.substr(at + 4, length - 2);
    if (marker == 0xE1 && segment.starts_with(kHead)) {
      const std::string_view tiff = segment.substr(kHead.size());
      if (!tiff.starts_with(std::string_view("II*\0", 4)) &&
          !tiff.starts_with(std::string_view("MM\0*", 4))) {
        return {};
      }
      return parse(TiffBytes(tiff));
    }
    at += 2 + length;
  }
  return {};
}

std::string format_exif(const PhotoExif& exif) {
  constexpr std::uint32_t kFirst = 8;
  Directory outer, inner;
  outer.add_text(kModel, exif.camera);
  inner.add_number(kFocalLength, exif.focal_mm);
  inner.add_long(kWidth, static_cast<std::uint32_t>(exif.width));
  inner.add_long(kHeight, static_cast<std::uint32_t>(exif.height));
  inner.add_number(kFocalPlaneX, exif.pixels_per_mm * 10.0);
  inner.add_short(kFocalPlaneUnit, 3);
  inner.add_short(kFocal35mm, static_cast<int>(std::lround(exif.focal_35mm)));
  // Its size doesn't depend on where the inner one stands.
  Directory with_place = outer;
  with_place.add_long(kExifFields, 0);
  const std::size_t place = kFirst + with_place.size();
  outer.add_long(kExifFields, static_cast<std::uint32_t>(place));
  return std::string(kHead) + std::string("MM\0*", 4) + Directory::bytes(kFirst, 4) +
         outer.format(kFirst) + inner.format(place);
}

}  // namespace palmar
