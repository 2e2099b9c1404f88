// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/exif.h"

#include <libexif/exif-data.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

namespace palmar::images {
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

/// libexif's data, freed at the end.
using ExifPointer =
    std::unique_ptr<ExifData, decltype([](ExifData* data) { exif_data_unref(data); })>;

/// The fields of one file.
class Fields {
 public:
  explicit Fields(std::string_view segment) : data_(exif_data_new()) {
    // As the file has them: nothing left out, nothing filled in.
    exif_data_unset_option(data_.get(), EXIF_DATA_OPTION_IGNORE_UNKNOWN_TAGS);
    exif_data_unset_option(data_.get(), EXIF_DATA_OPTION_FOLLOW_SPECIFICATION);
    exif_data_load_data(data_.get(), reinterpret_cast<const unsigned char*>(segment.data()),
                        static_cast<unsigned int>(segment.size()));
  }

  /// 0 if there is none.
  double number(Tag tag) const {
    const ExifEntry* entry = find(tag);
    if (entry == nullptr || entry->data == nullptr || entry->components < 1 ||
        entry->size < exif_format_get_size(entry->format)) {
      return 0.0;
    }
    const ExifByteOrder order = exif_data_get_byte_order(data_.get());
    switch (entry->format) {
      case EXIF_FORMAT_SHORT:
        return exif_get_short(entry->data, order);
      case EXIF_FORMAT_LONG:
        return exif_get_long(entry->data, order);
      case EXIF_FORMAT_RATIONAL: {
        const ExifRational ratio = exif_get_rational(entry->data, order);
        return ratio.denominator > 0 ? static_cast<double>(ratio.numerator) / ratio.denominator
                                     : 0.0;
      }
      default:
        return 0.0;
    }
  }
  std::string text(Tag tag) const {
    const ExifEntry* entry = find(tag);
    if (entry == nullptr || entry->format != EXIF_FORMAT_ASCII || entry->data == nullptr) return {};
    std::string text(reinterpret_cast<const char*>(entry->data), entry->size);
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) text.pop_back();
    return text;
  }

 private:
  const ExifEntry* find(Tag tag) const {
    for (const ExifIfd directory : {EXIF_IFD_0, EXIF_IFD_EXIF}) {
      if (ExifEntry* entry =
              exif_content_get_entry(data_->ifd[directory], static_cast<ExifTag>(tag))) {
        return entry;
      }
    }
    return nullptr;
  }

  ExifPointer data_;
};

void append(std::string& words, const std::string& more) {
  if (more.empty()) return;
  words += (words.empty() ? "" : " ") + more;
}

PhotoExif exif_of(const Fields& fields) {
  PhotoExif exif;
  append(exif.camera, fields.text(kMake));
  append(exif.camera, fields.text(kModel));
  append(exif.camera, fields.text(kSerial));
  exif.focal_mm = fields.number(kFocalLength);
  exif.focal_35mm = fields.number(kFocal35mm);
  constexpr double kMostPixels = 1e6;  // along an edge
  exif.width = static_cast<int>(std::min(fields.number(kWidth), kMostPixels));
  exif.height = static_cast<int>(std::min(fields.number(kHeight), kMostPixels));
  constexpr double kInch = 25.4, kCentimetre = 10.0;  // mm
  exif.pixels_per_mm =
      fields.number(kFocalPlaneX) / (fields.number(kFocalPlaneUnit) == 3.0 ? kCentimetre : kInch);
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

bool PhotoExif::is_cropped(int picture_width, int picture_height) const {
  if (width <= 0 || height <= 0 || picture_width <= 0 || picture_height <= 0) return false;
  // Pictures are turned upright after they were taken.
  const auto proportion = [](double a, double b) { return std::max(a, b) / std::min(a, b); };
  const double taken = proportion(width, height);
  constexpr double kRounding = 0.01;
  return std::abs(proportion(picture_width, picture_height) - taken) > kRounding * taken;
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
      return exif_of(Fields(segment));
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

}  // namespace palmar::images
