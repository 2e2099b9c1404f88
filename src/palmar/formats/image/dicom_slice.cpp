// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/image/dicom_slice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/dicom_elements.h"

namespace palmar {
namespace {

constexpr std::size_t kHeadBytes = 16384;  // most headers; longer ones are read again, whole
constexpr double kSquare = 1e-3;           // cosine between axes that still counts as square

int whole_number(const DicomElements& elements, DicomTag tag, int missing) {
  const auto value = elements.number(tag);
  if (!value || std::abs(*value) > 1e9) return missing;
  return static_cast<int>(std::lround(*value));
}

/// Where the slice is; the reason if the file doesn't say it rightly.
std::string read_plane(const DicomAttributes& elements, DicomSlice& slice) {
  const auto orientation = elements.numbers(0x00200037);
  if (!orientation || orientation->size() != 6) {
    return "has no Image Orientation (0020,0037) of six numbers";
  }
  const auto position = elements.numbers(0x00200032);
  if (!position || position->size() != 3) {
    return "has no Image Position (0020,0032) of three numbers";
  }
  const auto spacing = elements.numbers(0x00280030);
  if (!spacing || spacing->size() != 2) return "has no Pixel Spacing (0028,0030) of two numbers";
  const std::vector<double>& o = *orientation;
  slice.row = Vec3(o[0], o[1], o[2]);
  slice.column = Vec3(o[3], o[4], o[5]);
  slice.position = Vec3((*position)[0], (*position)[1], (*position)[2]);
  slice.pixel_height = (*spacing)[0];
  slice.pixel_width = (*spacing)[1];
  for (const Vec3* axis : {&slice.row, &slice.column}) {
    if (std::abs(axis->norm() - 1.0) > 0.01) {
      return fmt::format("Image Orientation (0020,0037): an axis has length {:g}; 1 is required",
                         axis->norm());
    }
  }
  const double cosine = slice.row.dot(slice.column);
  if (std::abs(cosine) > kSquare) {
    return fmt::format(
        "Image Orientation (0020,0037): the axes aren't square; the angle between them is {:.2f} "
        "degrees",
        std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::acos(-1.0));
  }
  // Six digits, as most scanners write, tilt axes by about 1e-6.
  slice.row.normalize();
  slice.column = (slice.column - slice.row.dot(slice.column) * slice.row).normalized();
  for (const double size : {slice.pixel_width, slice.pixel_height}) {
    if (!(size >= 0.01 && size <= 100.0)) {
      return fmt::format("Pixel Spacing (0028,0030) is {:g} mm; 0.01 to 100 mm are allowed", size);
    }
  }
  if (slice.position.cwiseAbs().maxCoeff() > 1e5) {
    return fmt::format("Image Position (0020,0032) is {:g} mm away from the origin",
                       slice.position.norm());
  }
  return {};
}

/// Rescale Slope and Intercept; the reason if they are none.
std::string read_rescaling(const DicomAttributes& elements, DicomSlice& slice) {
  for (const auto& [tag, target, name] :
       {std::tuple{DicomTag{0x00281053}, &slice.slope, "Rescale Slope (0028,1053)"},
        std::tuple{DicomTag{0x00281052}, &slice.intercept, "Rescale Intercept (0028,1052)"}}) {
    if (elements.text(tag).empty()) continue;
    const auto value = elements.number(tag);
    if (!value || std::abs(*value) > 1e12) {
      return fmt::format("{} is \"{}\"; a number is required", name, elements.text(tag));
    }
    *target = *value;
  }
  if (slice.slope == 0.0) return "Rescale Slope (0028,1053) is 0";
  return {};
}

/// How the pixels are stored; the reason if that can't be read.
std::string read_layout(const DicomElements& elements, DicomSlice& slice) {
  slice.rows = elements.integer(0x00280010).value_or(0);
  slice.columns = elements.integer(0x00280011).value_or(0);
  slice.samples = elements.integer(0x00280002).value_or(1);
  slice.photometric = elements.text(0x00280004);
  slice.frames = whole_number(elements, 0x00280008, 1);
  if (slice.frames == 0) slice.frames = 1;  // some writers mean "not a multi-frame file"
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
  if (slice.frames < 1 || static_cast<std::size_t>(slice.frames) > kMostDicomFrames) {
    return fmt::format("holds {} frames; 1 to {} are read", slice.frames, kMostDicomFrames);
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

/// The frames of a multi-frame file: what each says of itself stands before what is said of all.
std::vector<DicomSlice> frames_of(const DicomElements& elements, const DicomSlice& whole) {
  if (elements.frame.size() != static_cast<std::size_t>(whole.frames)) {
    DicomSlice slice = whole;
    slice.damage = fmt::format(
        "holds {} frames and says of {} where they lie (Per-frame Functional Groups (5200,9230)); "
        "each "
        "needs its place",
        whole.frames, elements.frame.size());
    return {slice};
  }
  std::vector<DicomSlice> slices(elements.frame.size(), whole);
  for (std::size_t f = 0; f < slices.size(); ++f) {
    DicomAttributes attributes = elements.frame[f];
    attributes.value.insert(elements.shared.value.begin(), elements.shared.value.end());
    DicomSlice& slice = slices[f];
    slice.frame = static_cast<int>(f);
    slice.thickness = attributes.number(0x00180050);
    slice.damage = read_rescaling(attributes, slice);
    if (slice.damage.empty()) slice.damage = read_plane(attributes, slice);
  }
  return slices;
}

}  // namespace

std::string DicomSlice::name() const {
  return frames > 1 ? fmt::format("{} (frame {})", path, frame + 1) : path;
}

std::vector<DicomSlice> read_dicom_headers(const std::string& path) {
  FileEnds ends = read_ends(path, kHeadBytes);
  if (!looks_like_dicom(ends.head)) return {};
  DicomElements elements = dicom_elements(ends.head, ends.bytes);
  std::string whole;
  if (elements.is_partial) {
    whole = read_file(path, kMaxImageBytes);
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
  if (slice.frames > 1) return frames_of(elements, slice);
  slice.damage = read_plane(elements, slice);
  return {slice};
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

}  // namespace palmar
