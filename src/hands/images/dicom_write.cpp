// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "hands/images/dicom.h"
#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_readout.h"
#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/bytes.h"
#include "palmar/formats/file.h"
#include "palmar/formats/sha256.h"

namespace palmar::images {
namespace {

constexpr std::string_view kMrImageStorage = "1.2.840.10008.5.1.4.1.1.4";

/// "2.25." and a number of 128 bits (DICOM PS3.5, B.2), here the first ones of a hash.
std::string uid_of(const std::string& text) {
  const std::string hex = formats::sha256_hex(text).substr(0, 32);
  std::string decimal = "0";  // hex to decimal, digit by digit
  for (const char digit : hex) {
    int carry = digit <= '9' ? digit - '0' : digit - 'a' + 10;
    for (auto d = decimal.rbegin(); d != decimal.rend(); ++d) {
      const int value = (*d - '0') * 16 + carry;
      *d = static_cast<char>('0' + value % 10);
      carry = value / 10;
    }
    while (carry > 0) {
      decimal.insert(decimal.begin(), static_cast<char>('0' + carry % 10));
      carry /= 10;
    }
  }
  return "2.25." + decimal.substr(std::min(decimal.find_first_not_of('0'), decimal.size() - 1));
}

/// Decimal string: 16 characters at most (PS3.5, table 6.2-1).
std::string decimal_string(double value) {
  if (value == 0.0) return "0";
  for (int digits = 15; digits > 3; --digits) {
    std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.size() <= 16) return text;
  }
  return fmt::format("{:.8e}", value);
}

std::string decimal_strings(std::initializer_list<Vec3> vectors) {
  std::string text;
  for (const Vec3& v : vectors) {
    for (int a = 0; a < 3; ++a) text += (text.empty() ? "" : "\\") + decimal_string(v[a]);
  }
  return text;
}

/// Text without what separates values or is no plain character.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text.substr(0, 64)) result += c >= ' ' && c != '\\' && c < 127 ? c : '_';
  return result;
}

/// A data set in the explicit little-endian syntax. Elements must be added in ascending order.
class DataSet {
 public:
  void text(DicomTag tag, const char* vr, std::string value) {
    if (value.size() % 2 != 0) value += std::string_view(vr) == "UI" ? '\0' : ' ';
    head(tag, vr);
    formats::append_value(bytes_, static_cast<std::uint16_t>(value.size()));
    bytes_ += value;
  }
  void number(DicomTag tag, int value) {
    head(tag, "US");
    formats::append_value(bytes_, std::uint16_t{2});
    formats::append_value(bytes_, static_cast<std::uint16_t>(value));
  }
  void raw(DicomTag tag, const char* vr, const std::string& value) {
    head(tag, vr);
    formats::append_value(bytes_, std::uint16_t{0});
    formats::append_value(bytes_, static_cast<std::uint32_t>(value.size() + value.size() % 2));
    bytes_ += value;
    if (value.size() % 2 != 0) bytes_ += '\0';
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void head(DicomTag tag, const char* vr) {
    formats::append_value(bytes_, static_cast<std::uint16_t>(tag >> 16));
    formats::append_value(bytes_, static_cast<std::uint16_t>(tag & 0xFFFF));
    bytes_.append(vr, 2);
  }
  std::string bytes_;
};

/// How values become integers of 16 bits.
struct Storage {
  bool is_signed = false;
  double slope = 1.0;  ///< a power of two, exact as text
};

Storage storage_of(const std::vector<float>& values) {
  Storage storage;
  double largest = 0.0;
  bool is_whole = true;
  for (const float value : values) {
    if (!std::isfinite(value)) throw OutputError("an image with values that aren't finite");
    largest = std::max(largest, static_cast<double>(std::abs(value)));
    storage.is_signed = storage.is_signed || value < 0.0F;
    is_whole = is_whole && value == std::floor(value);
  }
  if (is_whole && largest <= 32767.0) return storage;
  while (largest > 32767.0 * storage.slope) storage.slope *= 2.0;
  while (largest > 0.0 && largest <= 16383.0 * storage.slope && storage.slope > 0x1p-30) {
    storage.slope /= 2.0;
  }
  return storage;
}

std::string pixel_bytes(const imaging::Volume& image, int k, const Storage& storage) {
  const std::size_t plane = image.grid.at(0, 0, 1);
  std::string bytes;
  bytes.reserve(2 * plane);
  for (std::size_t i = 0; i < plane; ++i) {
    const double stored =
        std::round(image.value[plane * static_cast<std::size_t>(k) + i] / storage.slope);
    formats::append_value(bytes,
                          static_cast<std::uint16_t>(static_cast<std::int32_t>(stored) & 0xFFFF));
  }
  return bytes;
}

struct SeriesNames {
  std::string study, series, frame;
};

std::string slice_bytes(const imaging::Volume& image, int k, const DicomHeader& header,
                        const SeriesNames& names, const Storage& storage) {
  const imaging::VolumeGrid& grid = image.grid;
  const std::string pixels = pixel_bytes(image, k, storage);
  const std::string instance = uid_of(names.series + "/" + std::to_string(k) + "/" + pixels);

  DataSet meta;
  meta.raw(0x00020001, "OB", std::string("\0\1", 2));
  meta.text(0x00020002, "UI", std::string(kMrImageStorage));
  meta.text(0x00020003, "UI", instance);
  meta.text(0x00020010, "UI", std::string(kExplicitLittleEndian));
  meta.text(0x00020012, "UI", uid_of("Palmar"));
  meta.text(0x00020013, "SH", "PALMAR");

  DataSet set;
  set.text(0x00080008, "CS", "DERIVED\\SECONDARY\\OTHER");
  set.text(0x00080016, "UI", std::string(kMrImageStorage));
  set.text(0x00080018, "UI", instance);
  for (const DicomTag tag : {0x00080020U}) set.text(tag, "DA", "");
  set.text(0x00080030, "TM", "");
  set.text(0x00080050, "SH", "");
  set.text(0x00080060, "CS", "MR");
  set.text(0x00080070, "LO", "Palmar");
  set.text(0x00080090, "PN", "");
  set.text(0x0008103E, "LO", plain(header.description));
  set.text(0x00100010, "PN", plain(header.patient));
  set.text(0x00100020, "LO", plain(header.patient));
  set.text(0x00100030, "DA", "");
  set.text(0x00100040, "CS", "");
  set.text(0x00180015, "CS", "HAND");
  set.text(0x00180020, "CS", "SE");
  set.text(0x00180021, "CS", "NONE");
  set.text(0x00180022, "CS", "");
  set.text(0x00180023, "CS", "3D");
  set.text(0x00180050, "DS", decimal_string(grid.spacing[2]));
  set.text(0x00180080, "DS", "500");  // repetition and echo time of a T1 image, ms
  set.text(0x00180081, "DS", "12");
  constexpr double kFrequency = 63.87;  // MHz, at 1.5 tesla
  const double bandwidth =
      header.fat_shift == 0.0
          ? 0.0
          : kFatBelowWater * 1e6 * kFrequency * grid.spacing[0] / std::abs(header.fat_shift);
  if (bandwidth > 0.0) set.text(0x00180084, "DS", decimal_string(kFrequency));
  set.text(0x00180087, "DS", "1.5");  // tesla
  set.text(0x00180088, "DS", decimal_string(grid.spacing[2]));
  set.text(0x00180091, "IS", "1");
  if (bandwidth > 0.0) {
    set.text(0x00180095, "DS", decimal_string(bandwidth));
    set.text(0x00181312, "CS", "COL");  // phases along the columns, read-out along the rows
  }
  set.text(0x00185100, "CS", "HFP");
  set.text(0x0020000D, "UI", names.study);
  set.text(0x0020000E, "UI", names.series);
  set.text(0x00200010, "SH", "1");
  set.text(0x00200011, "IS", std::to_string(header.number));
  set.text(0x00200013, "IS", std::to_string(k + 1));
  set.text(0x00200032, "DS", decimal_strings({grid.to_patient(Vec3(0, 0, k))}));
  set.text(0x00200037, "DS", decimal_strings({grid.axes.col(0), grid.axes.col(1)}));
  set.text(0x00200052, "UI", names.frame);
  set.text(0x00200060, "CS", header.laterality);
  set.text(0x00201002, "IS", std::to_string(grid.size[2]));
  set.text(0x00201040, "LO", "");
  set.number(0x00280002, 1);
  set.text(0x00280004, "CS", "MONOCHROME2");
  set.number(0x00280010, grid.size[1]);
  set.number(0x00280011, grid.size[0]);
  set.text(0x00280030, "DS",
           decimal_string(grid.spacing[1]) + "\\" + decimal_string(grid.spacing[0]));
  set.number(0x00280100, 16);
  set.number(0x00280101, 16);
  set.number(0x00280102, 15);
  set.number(0x00280103, storage.is_signed ? 1 : 0);
  if (storage.slope != 1.0) {
    set.text(0x00281052, "DS", "0");
    set.text(0x00281053, "DS", decimal_string(storage.slope));
    set.text(0x00281054, "LO", "US");
  }
  set.raw(0x7FE00010, "OW", pixels);

  std::string file(128, '\0');
  file += "DICM";
  DataSet length;  // of the meta information
  length.raw(0x00020000, "UL", "");
  std::string group("\x02\0\0\0UL\x04\0", 8);
  formats::append_value(group, static_cast<std::uint32_t>(meta.bytes().size()));
  return file + group + meta.bytes() + set.bytes();
}

}  // namespace

void write_dicom_series(const std::string& folder, const imaging::Volume& image,
                        const DicomHeader& header) {
  const imaging::VolumeGrid& grid = image.grid;
  for (const int size : grid.size) {
    if (size < 1 || size > 65535) {
      throw OutputError(fmt::format("{}: an image of {} x {} x {} voxels; 1 to 65535 are allowed",
                                    folder, grid.size[0], grid.size[1], grid.size[2]));
    }
  }
  if (image.value.size() != grid.count()) {
    throw OutputError(
        fmt::format("{}: {} values for {} voxels", folder, image.value.size(), grid.count()));
  }
  Storage storage;
  try {
    storage = storage_of(image.value);
  } catch (const OutputError& error) {
    throw OutputError(folder + ": " + error.what());
  }
  formats::Sha256 content;
  content.add(std::string_view(reinterpret_cast<const char*>(image.value.data()),
                               image.value.size() * sizeof(float)));
  content.add(decimal_strings({grid.origin, grid.spacing, grid.axes.col(0), grid.axes.col(1)}));
  content.add(header.description + std::to_string(header.number));
  SeriesNames names;
  names.study = header.study_uid.empty() ? uid_of("study " + header.patient) : header.study_uid;
  names.series = uid_of(names.study + content.hex());
  names.frame = uid_of("frame " + names.study);
  formats::create_folder(folder);
  for (int k = 0; k < grid.size[2]; ++k) {
    const auto path = std::filesystem::path(folder) / fmt::format("slice-{:04}.dcm", k + 1);
    formats::write_file(path, slice_bytes(image, k, header, names, storage));
  }
}

}  // namespace palmar::images
