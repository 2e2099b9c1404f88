// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/hand/dimensions/tape_measures.h"
#include "palmar/hand/hand.h"

namespace palmar::records {

/// What `palmar hand info --json` prints: dimensions in mm, joints with centre, axis and range of
/// motion in degrees, sources, provenance.
std::string hand_info_json(const hand::Hand& hand);
/// What `palmar hand measure --json` prints: the same, and what a tape measures, mm.
std::string hand_measures_json(const hand::Hand& hand, const hand::HandTape& tape);

/// What `palmar hand tissue --json` prints: per region both laws with low and high, MPa and mm, and
/// where they come from.
std::string tissue_json(const hand::Tissue& tissue);

}  // namespace palmar::records
