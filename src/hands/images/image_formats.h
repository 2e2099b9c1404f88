// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "hands/images/dicom.h"
#include "hands/imaging/odd_slices.h"

namespace palmar::images {

/// The series of a folder, or of one file of several frames, that `choice` means. As read_image().
ImageFile read_dicom(const std::string& path, const SeriesChoice& choice, const Progress& progress);

/// What is wrong with a slice; `where` names it.
std::string odd_slice_text(const std::string& where, const imaging::OddSlice& odd);

/// NIfTI-1 in one file, plain or gzipped. Its frame has x to the right's opposite: +x is the
/// patient's right in neither: RAS coordinates become DICOM's by negating x and y. Throws
/// InputError that begins with `name`.
///
/// Source: R. Cox et al., nifti1.h (NIfTI Data Format Working Group, 2004), methods 1 to 3.
ImageFile read_nifti(std::string_view bytes, const std::string& name);
/// Float values, both transforms; gzipped if `compress`.
std::string nifti_bytes(const imaging::Volume& image, bool compress);

/// Unpacks gzip up to `size` bytes; fewer if there are fewer. Throws InputError that begins with
/// `name` for damaged data.
std::string gunzip(std::string_view bytes, std::size_t size, const std::string& name);
std::string gzip(std::string_view bytes);

}  // namespace palmar::images
