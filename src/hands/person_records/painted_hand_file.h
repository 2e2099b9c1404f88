// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "hands/capture/scan/scan_truth.h"
#include "hands/phantom/photo/painted_hand.h"

namespace palmar::person_records {

/// One scan or set of photographs of a painted hand.
struct PaintedHandPlace {
  std::string file;                 ///< as it shall be named
  geometry::Rigid3 scan_from_hand;  ///< mm
};

/// What is known of a painted synthetic person, to hold measurements against: FOLDER/subject.json
/// (dimensions; per posture angles, joints with axis and centre, dots, creases, all in the scan's
/// frame; keys carry units) and FOLDER/POSTURE.ply (the skin without error, scan's frame, mm).
/// Throws OutputError.
void write_painted_hand(const std::string& folder, const phantom::PaintedHand& hand,
                        std::uint64_t seed,
                        const std::map<hand::ScanPosture, PaintedHandPlace>& places);

/// What such a folder's subject.json (and reference.ply beside it, if there) says of the person.
/// Throws InputError naming the file and what is wrong or lacks.
capture::ScanTruth read_scan_truth(const std::string& path);

}  // namespace palmar::person_records
