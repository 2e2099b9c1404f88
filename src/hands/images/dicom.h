// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"

namespace palmar::images {

/// One series of DICOM files.
struct DicomSeries {
  std::string uid;
  int number = 0;           ///< Series Number, 0 if it has none
  std::string description;  ///< Series Description
  std::string modality;     ///< "MR"
  std::string laterality;   ///< "R", "L" or ""
  int columns = 0, rows = 0, slices = 0;
  std::vector<std::string> files;  ///< in the order of position
  /// Why it is no volume: a localiser of several directions, colour, one slice. Empty if it is one.
  std::string refusal;
};

/// Every series of a folder (looked through with the folders in it), by number, then by UID; or
/// that of one file. Files of a folder that aren't DICOM are passed over. Throws InputError for a
/// folder that is missing or has none, and for a file that isn't DICOM.
std::vector<DicomSeries> find_dicom_series(const std::string& path);

/// Whether `path` is a file that begins as DICOM files do.
bool is_dicom_file(const std::string& path);

/// Which series is meant: its number, or part of its description. Nothing: the only one.
struct SeriesChoice {
  std::optional<int> number;
  std::string description;
};

/// An image read from files.
struct ImageFile {
  imaging::Volume image;
  std::string description;  ///< series' description, or the file's name
  std::string laterality;
  std::vector<std::string> notes;  ///< duplicates left out, small irregularities: sentences
  /// Along the read-out, as long as what fat is shown off water by the bandwidth that the file
  /// states, mm; towards which side it doesn't say. Zero where that isn't known. (dicom_readout.h)
  Vec3 fat_shift = Vec3::Zero();
  /// Slices that don't belong between their neighbours (imaging/odd_slices.h), most likely damaged:
  /// sentences naming the file. Not among the notes.
  std::vector<std::string> odd_slices;
};

/// Reads a folder of DICOM files, a DICOM file of several frames, or a NIfTI file (.nii, .nii.gz).
/// Throws InputError naming file and place for: missing or doubled slices, mixed series, several
/// that fit the choice (all named), colour, compression that can't be read, a truncated slice, axes
/// that aren't square.
ImageFile read_image(const std::string& path, const SeriesChoice& choice = {},
                     const Progress& progress = {});

/// What write_dicom_series() says about the image beside its grid.
struct DicomHeader {
  std::string patient = "Phantom";  ///< Patient Name and ID
  std::string description;
  std::string laterality;  ///< "R", "L" or ""
  int number = 1;
  std::string study_uid;   ///< "" : made from patient
  double fat_shift = 0.0;  ///< along the rows, mm: written as bandwidth of the read-out; 0: unsaid
};

/// Writes one MR series, a file per slice, 16 bits, with the tags of an MR image: position,
/// orientation, spacing, frame of reference. UIDs are made from the content: same input, same
/// bytes. `folder` is created; throws OutputError.
void write_dicom_series(const std::string& folder, const imaging::Volume& image,
                        const DicomHeader& header);

/// Writes NIfTI, gzipped if `path` says so.
void write_image(const std::string& path, const imaging::Volume& image);

}  // namespace palmar::images
