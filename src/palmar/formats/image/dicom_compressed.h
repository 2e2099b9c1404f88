// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/formats/image/dicom_slice.h"

namespace palmar {

/// Name of a transfer syntax whose pixels are compressed in a way that isn't read ("JPEG 2000"); ""
/// for RLE and lossless JPEG, which are.
std::string unread_compression(std::string_view transfer_syntax);

/// Pixels of a slice in fragments, as an uncompressed file would have them: little-endian, row by
/// row. Throws InputError naming the file if they are damaged, cut off or of another size.
///
/// Source: DICOM PS3.5, A.4 (fragments), annex G (RLE).
std::string decompressed_pixels(const DicomSlice& slice, std::string_view file);

/// Lossless JPEG of one component, 2 to 16 bits: samples row by row. Throws InputError that begins
/// with `name`.
///
/// Source: ITU-T T.81 (1992), annexes B.2, F.2.2 (Huffman codes) and H (lossless mode).
std::vector<std::uint16_t> lossless_jpeg(std::string_view bytes, int columns, int rows,
                                         const std::string& name);

}  // namespace palmar
