// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "palmar/hand/anatomy.h"
#include "palmar/report/picture/image.h"

namespace palmar::report {

/// 256 colours from low to high along a path through the OKLab colour space: lightness rises
/// steadily, so the map stays readable in grey and for every kind of colour vision, and
/// neighbouring colours are equally far apart (perceptually uniform). Computed, not copied.
///
///     kEmber  dark violet - red - orange - pale yellow: pressure
///     kFern   dark blue - green - yellow: lengths and depths
///
/// Source: Ottosson 2020, "A perceptual color space for image processing" (OKLab).
enum class Colormap { kEmber, kFern };

using ColourTable = std::array<Rgb, 256>;
const ColourTable& colour_table(Colormap map);

/// Colour of `share` in [0, 1]; values outside are held at the ends, NaN at the low end.
Rgb map_colour(Colormap map, double share);

/// What carries no pressure.
inline constexpr Rgb kSkinColour{232, 200, 178};     ///< skin in pictures of the grasp
inline constexpr Rgb kNeutralColour{214, 214, 210};  ///< skin or product outside the contact
inline constexpr Rgb kProductColour{126, 148, 170};
inline constexpr Rgb kBoneColour{240, 232, 208};

/// Vertex colours for a field: `neutral` where the value is at or below `threshold`, else the map
/// from 0 to `upper`. Throws UsageError unless upper > 0.
std::vector<Rgb> field_colours(std::span<const double> field, double upper, Colormap map,
                               Rgb neutral = kNeutralColour, double threshold = 0.0);

/// 20 colours that distinguish the regions: one hue per finger (after Okabe and Ito 2008, chosen
/// for colour-blind readers), lighter towards the tip; the palm's pads in greys and earth colours.
/// Neighbouring regions differ in lightness, too.
Rgb region_colour(hand::Region region);

}  // namespace palmar::report
