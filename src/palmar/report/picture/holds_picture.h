// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/core/language.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

struct HoldsPictureOptions {
  int tile_width = 480;    ///< pixels, 160 to 1600; a tile is as high as it is wide
  int columns = 4;         ///< 1 to 8
  int most = 8;            ///< holds that are shown, from 1
  std::optional<Vec3> up;  ///< upwards in the picture, product frame; unset: +z
  Language language = Language::kEnglish;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Ways to hold a product as one sheet, best first: hand and product of each, seen from where one
/// sees best how it is held (hold_camera.h), with its number, words, score and what speaks against
/// it. `hand` is the one that they were ranked with.
Image holds_picture(const hand::Hand& hand, const product::Product& product,
                    const grasp::RankedHolds& ranked, const HoldsPictureOptions& options = {},
                    const Progress& progress = {});

/// Text in lines that are at most so many pixels wide; the last one ends in "..." if there would be
/// more than `most`.
std::vector<std::string> wrapped(const std::string& text, double width, double cap_height,
                                 std::size_t most);

}  // namespace palmar::report
