// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/hand.h"

namespace palmar::records {

/// Version of the tissue files that this program writes; a newer one is refused.
inline constexpr int kTissueFileVersion = 1;

/// Tissue of a hand as a TOML file that people edit (docs/using/tissue.md).
///
///     source = "whose numbers these are"
///     [finger]                     # all fourteen phalangeal regions; also [palm], [dorsum]
///     swelling_height_mm = 2.0     # swelling_radius_mm, swelling_width_mm, neighbourhood_mm
///     [finger.half_space]          # and [finger.layered]
///     g0_kpa = 5.0                 # g0_low_kpa, g0_high_kpa: the range
///     g_limit_kpa = 95.0
///     limit_depth_mm = 4.0
///     [finger.on_bone]             # g0_kpa, its range, and stiffening
///     [region.index_distal.layered]
///     g0_kpa = 6.0                 # one region alone, over its group
///
/// What the file doesn't give stays as in `base`; a value given without its low or high has no
/// range: both become the value itself.
///
/// Throws InputError naming file, line, key, value and what is allowed: for a file that can't be
/// read or is no TOML, an unknown key (with the nearest known one), a value of the wrong kind or
/// outside its limits, and a set with fault_of() (tissue.h).
hand::Tissue read_tissue(const std::string& path, const hand::Tissue& base);

/// The whole set as such a file: a group's values are those of its first region, regions that
/// differ stand below. Numbers read back within one unit of the last digit. Throws OutputError.
void write_tissue(const std::string& path, const hand::Tissue& tissue);
std::string tissue_toml(const hand::Tissue& tissue);

}  // namespace palmar::records
