// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace palmar::images {

/// A DICOM file put together by hand, element by element, as PS3.5 section 7.1 has it: knows
/// nothing of Palmar's own writer.
struct DicomTestFile {
  std::map<std::uint32_t, std::pair<std::string, std::string>> element;  ///< VR, value
  bool is_explicit = true;
  bool has_preamble = true;
  std::string transfer_syntax = "1.2.840.10008.1.2.1";

  /// An MR slice of `columns` x `rows` pixels whose values count up from `first_value`, at z mm.
  static DicomTestFile slice(int columns, int rows, double z, int first_value = 0) {
    DicomTestFile file;
    file.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4");
    file.text(0x00080018, "UI", "1.2.3." + std::to_string(static_cast<int>(z * 100) + 5000));
    file.text(0x00080060, "CS", "MR");
    file.text(0x0008103E, "LO", "t1 coronal");
    file.text(0x0020000E, "UI", "1.2.3.4");
    file.text(0x00200011, "IS", "7");
    file.text(0x00200032, "DS", "-10\\20\\" + std::to_string(z));
    file.text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
    file.number(0x00280002, 1);
    file.text(0x00280004, "CS", "MONOCHROME2");
    file.number(0x00280010, rows);
    file.number(0x00280011, columns);
    file.text(0x00280030, "DS", "0.5\\0.25");
    file.number(0x00280100, 16);
    file.number(0x00280101, 16);
    file.number(0x00280102, 15);
    file.number(0x00280103, 0);
    std::vector<int> pixels;
    for (int p = 0; p < columns * rows; ++p) pixels.push_back(first_value + p);
    file.pixels(pixels);
    return file;
  }

  void text(std::uint32_t tag, const std::string& vr, std::string value) {
    if (value.size() % 2 != 0) value += vr == "UI" ? '\0' : ' ';
    element[tag] = {vr, value};
  }
  void number(std::uint32_t tag, int value) { element[tag] = {"US", two_bytes(value)}; }
  void pixels(const std::vector<int>& values) {
    std::string bytes;
    for (const int value : values) bytes += two_bytes(value);
    element[0x7FE00010] = {"OW", bytes};
  }

  /// A sequence of these items, with their lengths or (`is_open`) delimiters.
  void sequence(std::uint32_t tag, const std::vector<DicomTestFile>& items, bool is_open = false) {
    std::string bytes;
    for (const DicomTestFile& item : items) {
      const std::string content = item.body();
      bytes += std::string("\xFE\xFF\x00\xE0", 4) +
               (is_open ? std::string(4, '\xFF') : four_bytes(content.size())) + content +
               (is_open ? std::string("\xFE\xFF\x0D\xE0\0\0\0\0", 8) : std::string());
    }
    element[tag] = {"SQ", bytes};
  }

  std::string bytes() const {
    std::string result;
    if (has_preamble) {
      DicomTestFile meta;
      meta.text(0x00020002, "UI", "1.2.840.10008.5.1.4.1.1.4");
      meta.text(0x00020010, "UI", is_explicit ? transfer_syntax : "1.2.840.10008.1.2");
      const std::string rest = meta.body();
      result = std::string(128, '\0') + "DICM" + std::string("\2\0\0\0UL\4\0", 8) +
               four_bytes(rest.size()) + rest;
    }
    return result + body();
  }
  void write(const std::filesystem::path& path) const {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes();
  }

  static std::string two_bytes(int value) {
    const auto bits = static_cast<std::uint16_t>(value & 0xFFFF);
    return {static_cast<char>(bits & 0xFF), static_cast<char>(bits >> 8)};
  }
  static std::string four_bytes(std::size_t value) {
    return two_bytes(static_cast<int>(value & 0xFFFF)) +
           two_bytes(static_cast<int>(value >> 16 & 0xFFFF));
  }

 private:
  std::string body() const {
    std::string result;
    for (const auto& [tag, content] : element) {
      const auto& [vr, value] = content;
      result += two_bytes(static_cast<int>(tag >> 16)) + two_bytes(static_cast<int>(tag & 0xFFFF));
      const bool is_long = vr == "OW" || vr == "OB" || vr == "SQ" || vr == "UN";
      if (is_explicit) result += vr + (is_long ? std::string(2, '\0') : std::string());
      result += is_explicit && !is_long ? two_bytes(static_cast<int>(value.size()))
                                        : four_bytes(value.size());
      result += value;
    }
    return result;
  }
};

/// A multi-frame (enhanced MR) file: one frame at each of these z, mm; values count up from 100
/// times the frame's index.
inline DicomTestFile multi_frame_file(int columns, int rows, const std::vector<double>& z,
                                      bool is_open = false) {
  const auto with = [](std::uint32_t tag, const std::string& value) {
    DicomTestFile item;
    item.text(tag, "DS", value);
    return item;
  };
  DicomTestFile file = DicomTestFile::slice(columns, rows, 0);
  for (const std::uint32_t tag : {0x00200032, 0x00200037, 0x00280030}) file.element.erase(tag);
  DicomTestFile shared;
  shared.sequence(0x00209116, {with(0x00200037, "1\\0\\0\\0\\1\\0")}, is_open);
  shared.sequence(0x00289110, {with(0x00280030, "0.5\\0.25")}, is_open);
  DicomTestFile scaled = with(0x00281052, "1");
  scaled.text(0x00281053, "DS", "2");
  shared.sequence(0x00289145, {scaled}, is_open);
  file.sequence(0x52009229, {shared}, is_open);
  std::vector<DicomTestFile> frames;
  std::vector<int> pixels;
  for (std::size_t f = 0; f < z.size(); ++f) {
    DicomTestFile frame;
    frame.sequence(0x00209113, {with(0x00200032, "-10\\20\\" + std::to_string(z[f]))}, is_open);
    frames.push_back(frame);
    for (int p = 0; p < columns * rows; ++p) pixels.push_back(100 * static_cast<int>(f) + p);
  }
  file.sequence(0x52009230, frames, is_open);
  file.text(0x00280008, "IS", std::to_string(z.size()));
  file.pixels(pixels);
  return file;
}

/// A series of four slices of 4 x 3 pixels, 2 mm apart, as files in `folder`.
inline void write_test_series(const std::filesystem::path& folder) {
  for (int k = 0; k < 4; ++k) {
    DicomTestFile::slice(4, 3, 2.0 * k, 100 * k).write(folder / (std::to_string(k) + ".dcm"));
  }
}

}  // namespace palmar::images
