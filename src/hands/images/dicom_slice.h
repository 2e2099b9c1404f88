// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/images/dicom.h"
#include "palmar/geometry/types.h"

namespace palmar::images {

/// What a DICOM file says about its image, without the pixels.
struct DicomSlice {
  std::string path;
  std::string series_uid, description, modality, laterality, frame_of_reference;
  std::string image_type, transfer_syntax, photometric;
  int series_number = 0;
  int instance = 0;               ///< Instance Number, 0 if none
  int images_in_acquisition = 0;  ///< 0 if not said
  int rows = 0, columns = 0, samples = 1;
  int frames = 1;  ///< in the file
  int frame = 0;   ///< which of them this is
  int parts = 1;   ///< files that the image was split into (a concatenation)
  /// The file says where its first frame lies and how far apart they are, not on which side.
  bool has_assumed_order = false;
  /// What may tell images at one place apart: "echo time" is "4.6 ms".
  std::map<std::string, std::string> kind;
  int bits_allocated = 0, bits_stored = 0, high_bit = 0;
  bool is_signed = false;
  double slope = 1.0, intercept = 0.0;
  Vec3 row = Vec3::UnitX(), column = Vec3::UnitY();  ///< directions of growing i and j
  Vec3 position = Vec3::Zero();                      ///< centre of the first pixel, mm
  double pixel_width = 1.0, pixel_height = 1.0;      ///< mm, along i and j
  std::optional<double> thickness;                   ///< mm
  Vec3 fat_shift = Vec3::Zero();                     ///< ImageFile::fat_shift
  bool has_pixels = false, is_encapsulated = false;
  bool is_lossy = false;  ///< compressed with loss, once
  std::uint64_t pixel_offset = 0, pixel_length = 0;
  /// Why it is no slice of a volume; empty if it is one.
  std::string damage;

  double along_normal() const { return row.cross(column).dot(position); }
  /// The path; of a multi-frame file with the frame, from 1.
  std::string name() const;
};

/// Reads the header of one file: its slice, or those of all its frames; nothing if it isn't DICOM.
/// What is wrong goes into `damage`.
std::vector<DicomSlice> read_dicom_headers(const std::string& path);

/// A series with its slices' headers, in the order of `series.files`.
struct DicomStack {
  DicomSeries series;
  std::vector<DicomSlice> slices;
  std::vector<std::string> notes;
};

/// As find_dicom_series(); of one file those it holds.
std::vector<DicomStack> find_dicom_stacks(const std::string& path, const Progress& progress);

/// Orders the slices by position and fills `series`, with the refusal, and `notes`. Slices at one
/// position stay, side by side.
DicomStack order_slices(std::vector<DicomSlice> slices);

/// Bytes of pixels that aren't read file by file: those of multi-frame files, and what was
/// compressed.
class DicomPixels {
 public:
  /// Reads multi-frame files and unpacks what is compressed. Throws InputError naming the file.
  explicit DicomPixels(const std::vector<DicomSlice>& slices, const Progress& progress = {});
  /// Values of a slice (one of those given), after rescaling, row by row. Throws InputError naming
  /// the file.
  std::vector<float> values(const DicomSlice& slice) const;

 private:
  std::map<std::string, std::string> file_;      ///< whole multi-frame files, by path
  std::map<std::string, std::string> unpacked_;  ///< by name of the slice
};

/// Positions closer than this are one position, mm: writers round.
inline constexpr double kSamePosition = 0.01;
/// Largest image in memory, as float.
inline constexpr std::uint64_t kMaxImageBytes = std::uint64_t{2} << 30;

/// Throws InputError naming `what` if an image of this size is empty or above kMaxImageBytes.
void check_image_size(const std::string& what, double width, double height, double slices);

}  // namespace palmar::images
