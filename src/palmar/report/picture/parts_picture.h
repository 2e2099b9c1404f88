// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

struct PartsPictureOptions {
  int width = 1600;  ///< pixels, 200 to 8000
  int height = 800;  ///< pixels, 100 to 4000
};

/// Colour of the part with a number (from 1); told apart by people with red-green blindness, too.
Rgb part_colour(int number);

/// A product from two sides, each part in its colour with its number and centre line, and a list
/// of the parts with their sizes.
Image parts_picture(const product::Product& product, const product::ProductParts& parts,
                    const PartsPictureOptions& options = {}, const Progress& progress = {});

/// A picture as an SVG file, for documents that take no PNG.
std::string picture_svg(const Image& image);

}  // namespace palmar::report
