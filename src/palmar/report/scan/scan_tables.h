// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/capture/scan/scan_record.h"
#include "palmar/hand/dimensions/tape_measures.h"

namespace palmar {

// Sections of the report on a hand made from scans, as HTML; "" where there is nothing to tell.

/// "thumb flexion": the posture for people.
std::string words_of(ScanPosture posture);

/// Every scan and what was found in it; postures that weren't scanned, too.
std::string scans_section(const ScanRecord& record);

/// Mean distances of bones: fingers (Xie 2014, tables 2-2, 2-4) and thumb (2-3, 2-4), with charts.
std::string bone_error_section(const ScanRecord& record);

/// Range of every joint, and whether the scans told it.
std::string joint_range_section(const ScanRecord& record);

/// Distance of the skin, thumb ball (Xie 2014, table 2-5), contact with the product.
std::string skin_section(const ScanRecord& record);

/// Sizes of hand and segments.
std::string dimensions_section(const Hand& hand);
/// The same with what a tape measures along the skin.
std::string dimensions_section(const Hand& hand, const HandTape& tape);

}  // namespace palmar
