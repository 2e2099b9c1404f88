// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "hands/images/dicom_slice.h"
#include "palmar/core/progress.h"

namespace palmar::images {

/// Name of a transfer syntax whose pixels are compressed in a way that isn't read ("MPEG-2"); ""
/// for run lengths (RLE), JPEG, JPEG-LS and JPEG 2000, which are.
std::string unread_compression(std::string_view transfer_syntax);

/// Pixels of slices in fragments, as an uncompressed file would have them: little-endian, row by
/// row; by the slice's name. All have one transfer syntax or are grouped by it.
///
/// GDCM unpacks them in a child process, palmar-dicom, with limits of time and memory: some damaged
/// streams crash its decoders. Throws InputError naming the file if pixels are damaged, cut off or
/// of another size, if the child crashes on them or needs more than its limits (30 s and 10 s for a
/// million pixels; 1 GB and 16 bytes for a pixel), or if more than 16 million pixels have more than
/// 1000 for a compressed byte; ProgramMissing if the program isn't there. Run
/// lengths are unpacked here: GDCM crashes on more damaged ones than on any other kind.
///
/// Source: DICOM PS3.5, A.4 (fragments), annex G (RLE).
std::map<std::string, std::string> unpacked_pixels(const std::vector<DicomSlice>& slices,
                                                   const Progress& progress = {});

}  // namespace palmar::images
