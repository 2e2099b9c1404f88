// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palmar::images {

/// Group and element of a DICOM attribute as one number: (0028,0010) is 0x00280010.
using DicomTag = std::uint32_t;

inline constexpr std::string_view kImplicitLittleEndian = "1.2.840.10008.1.2";
inline constexpr std::string_view kExplicitLittleEndian = "1.2.840.10008.1.2.1";

/// Values by tag, into the bytes of a file.
struct DicomAttributes {
  std::map<DicomTag, std::string_view> value;

  /// Text without the blanks around it, as UTF-8; "" if there is none.
  std::string text(DicomTag tag) const;
  /// Numbers of a decimal or integer string; nothing if absent or if any isn't a finite number.
  std::optional<std::vector<double>> numbers(DicomTag tag) const;
  std::optional<double> number(DicomTag tag) const;
  /// A 16-bit integer.
  std::optional<int> integer(DicomTag tag) const;
  /// A 32-bit integer, a 64-bit floating-point number, the tag that an element names.
  std::optional<std::uint32_t> integer32(DicomTag tag) const;
  std::optional<double> float64(DicomTag tag) const;
  std::optional<DicomTag> named_tag(DicomTag tag) const;
};

/// The attributes at the first level of a DICOM file, looked at without trusting any length in it.
/// Of sequences only those are looked into that say where the frames of a multi-frame file lie and
/// what they are.
///
/// Source: DICOM PS3.5 (2023), section 7.1 (data elements), A.4 (fragments); PS3.10, section 7;
/// PS3.3, C.7.6.16 (functional groups).
struct DicomElements : DicomAttributes {
  DicomAttributes shared;              ///< of all frames: place, pixel size, rescaling, kind
  std::vector<DicomAttributes> frame;  ///< of each frame, where it says something by itself
  std::string transfer_syntax;
  std::uint64_t pixel_offset = 0, pixel_length = 0;  ///< of native Pixel Data, if any
  bool has_pixels = false;
  /// Pixel Data in fragments (compressed).
  bool is_encapsulated = false;
  /// The bytes end before the file does, and something needed lies behind them.
  bool is_partial = false;
  /// What is wrong with the file, with the byte; empty if nothing is.
  std::string damage;
};

/// Most frames that a file may have.
inline constexpr std::size_t kMostDicomFrames = 20000;

/// True if a file that begins with `head` is DICOM: "DICM" behind 128 bytes, or, in old files
/// without them, a first element of group 8.
bool looks_like_dicom(std::string_view head);

/// Elements of a file of `file_bytes` bytes whose beginning is `bytes`, up to Pixel Data.
DicomElements dicom_elements(std::string_view bytes, std::uint64_t file_bytes);

}  // namespace palmar::images
