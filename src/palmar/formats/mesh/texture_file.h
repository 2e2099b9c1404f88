// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::formats {

/// Largest side of an image that is read.
inline constexpr int kMaxTextureSide = 32768;

/// Decodes a PNG or JPEG image (8 bits a channel after decoding; greys become colours, what is
/// transparent keeps its colour). Throws InputError "`name`: ..." for anything else, a damaged
/// file, and images without pixels or larger than kMaxTextureSide.
geometry::RgbImage read_texture(std::string_view bytes, const std::string& name);

/// The image as a PNG.
std::string format_png(const geometry::RgbImage& image);

/// The image as a JPEG of a quality from 1 to 100, `exif` (exif.h) as its segment APP1 if not
/// empty. Throws UsageError for another quality or an image without pixels.
std::string format_jpeg(const geometry::RgbImage& image, int quality, const std::string& exif = "");

}  // namespace palmar::formats
