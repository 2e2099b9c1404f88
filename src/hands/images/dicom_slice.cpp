// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/images/dicom_slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "hands/images/dicom_elements.h"
#include "hands/images/dicom_frames.h"
#include "hands/images/dicom_plane.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"

namespace palmar::images {
namespace {

constexpr std::size_t kHeadBytes = 16384;  // most headers; longer ones are read again, whole

int whole_number(const DicomElements& elements, DicomTag tag, int missing) {
  const auto value = elements.number(tag);
  if (!value || std::abs(*value) > 1e9) return missing;
  return static_cast<int>(std::lround(*value));
}

/// How the pixels are stored; the reason if that can't be read.
std::string read_layout(const DicomElements& elements, DicomSlice& slice) {
  slice.rows = elements.integer(0x00280010).value_or(0);
  slice.columns = elements.integer(0x00280011).value_or(0);
  slice.samples = elements.integer(0x00280002).value_or(1);
  slice.photometric = elements.text(0x00280004);
  slice.bits_allocated = elements.integer(0x00280100).value_or(0);
  slice.bits_stored = elements.integer(0x00280101).value_or(slice.bits_allocated);
  slice.high_bit = elements.integer(0x00280102).value_or(slice.bits_stored - 1);
  slice.is_signed = elements.integer(0x00280103).value_or(0) == 1;
  if (slice.rows < 1 || slice.columns < 1) {
    return fmt::format("has {} rows and {} columns", slice.rows, slice.columns);
  }
  const int bits = slice.bits_allocated;
  if (bits != 8 && bits != 16 && bits != 32) {
    return fmt::format("Bits Allocated (0028,0100) is {}; 8, 16 and 32 are read", bits);
  }
  if (slice.bits_stored < 1 || slice.high_bit >= bits || slice.high_bit + 1 < slice.bits_stored) {
    return fmt::format("{} bits stored up to bit {} don't fit {} bits allocated", slice.bits_stored,
                       slice.high_bit, bits);
  }
  const std::string frames_text = elements.text(0x00280008);
  slice.frames = whole_number(elements, 0x00280008, frames_text.empty() ? 1 : -1);
  if (slice.frames == 0) slice.frames = 1;  // some writers mean "not a multi-frame file"
  if (slice.frames < 1 || static_cast<std::size_t>(slice.frames) > kMostDicomFrames) {
    slice.frames = 1;
    return fmt::format("Number of Frames (0028,0008) is \"{}\"; 1 to {} are allowed", frames_text,
                       kMostDicomFrames);
  }
  const bool is_native = slice.samples == 1 && !slice.is_encapsulated;
  const std::uint64_t expected = static_cast<std::uint64_t>(slice.rows) *
                                 static_cast<std::uint64_t>(slice.columns) *
                                 static_cast<std::uint64_t>(bits / 8);
  const auto frames = static_cast<std::uint64_t>(slice.frames);
  if (is_native && slice.pixel_length / frames < expected) {
    return fmt::format("is cut off: {}{} x {} pixels of {} bits need {} bytes, {} are there",
                       frames > 1 ? fmt::format("{} frames of ", frames) : "", slice.columns,
                       slice.rows, bits, expected * frames, slice.pixel_length);
  }
  return read_rescaling(elements, slice);
}

}  // namespace

std::string DicomSlice::name() const {
  return frames > 1 ? fmt::format("{} (frame {})", path, frame + 1) : path;
}

std::vector<DicomSlice> read_dicom_headers(const std::string& path) {
  formats::FileEnds ends = formats::read_ends(path, kHeadBytes);
  if (!looks_like_dicom(ends.head)) return {};
  DicomElements elements = dicom_elements(ends.head, ends.bytes);
  std::string whole;
  if (elements.is_partial) {
    whole = formats::read_file(path, kMaxImageBytes);
    elements = dicom_elements(whole, whole.size());
  }
  // A folder's index, as on a CD, is no slice.
  if (elements.text(0x00020002) == "1.2.840.10008.1.3.10") return {};

  DicomSlice slice;
  slice.path = path;
  slice.series_uid = elements.text(0x0020000E);
  slice.description = elements.text(0x0008103E);
  slice.modality = elements.text(0x00080060);
  slice.laterality = elements.text(0x00200060);
  if (slice.laterality.empty()) slice.laterality = elements.text(0x00200062);
  if (slice.laterality != "R" && slice.laterality != "L") slice.laterality.clear();
  slice.frame_of_reference = elements.text(0x00200052);
  slice.image_type = elements.text(0x00080008);
  slice.transfer_syntax = elements.transfer_syntax;
  slice.series_number = whole_number(elements, 0x00200011, 0);
  slice.instance = whole_number(elements, 0x00200013, 0);
  slice.images_in_acquisition = whole_number(elements, 0x00201002, 0);
  slice.parts = elements.integer(0x00209163).value_or(1);
  slice.thickness = elements.number(0x00180050);
  slice.has_pixels = elements.has_pixels;
  slice.is_encapsulated = elements.is_encapsulated;
  slice.is_lossy = elements.text(0x00282110) == "01" ||
                   slice.transfer_syntax == "1.2.840.10008.1.2.4.50" ||
                   slice.transfer_syntax == "1.2.840.10008.1.2.4.51";
  slice.pixel_offset = elements.pixel_offset;
  slice.pixel_length = elements.pixel_length;
  slice.damage = elements.damage;
  if (slice.transfer_syntax == "1.2.840.10008.1.2.2")
    slice.damage = "is big-endian, which isn't read";
  if (slice.transfer_syntax == "1.2.840.10008.1.2.1.99")
    slice.damage = "is deflated, which isn't read";
  if (!slice.damage.empty()) return {slice};
  if (!slice.has_pixels) {
    slice.damage = "holds no pixels";
    return {slice};
  }
  slice.damage = read_layout(elements, slice);
  if (!slice.damage.empty()) return {slice};
  return frames_of(elements, slice);
}

void check_image_size(const std::string& what, double width, double height, double slices) {
  const double bytes = width * height * slices * static_cast<double>(sizeof(float));
  if (!(width >= 1.0 && height >= 1.0 && slices >= 1.0)) {
    throw InputError(fmt::format("{}: has {:g} x {:g} x {:g} voxels", what, width, height, slices));
  }
  if (bytes > static_cast<double>(kMaxImageBytes)) {
    throw InputError(
        fmt::format("{}: {:g} x {:g} x {:g} voxels need {:.1f} GB; up to {:.1f} GB are read", what,
                    width, height, slices, bytes / 1e9, static_cast<double>(kMaxImageBytes) / 1e9));
  }
}

}  // namespace palmar::images
