// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "hands/capture/scan/hand_from_scan.h"

namespace palmar::capture {

/// What is known of a scanned person from elsewhere: of a synthetic one everything.
struct ScanTruth {
  hand::HandDimensions dimensions;
  std::map<hand::ScanPosture, PlacedJoints> postures;  ///< in the frame of each scan
  geometry::TriangleMesh skin;  ///< of the reference, its scan's frame; may be empty
};

/// How far a joint or fingertip of the hand, posed as the scan was fitted, lies from the true one.
struct PlaceError {
  hand::ScanPosture posture{};
  hand::Segment segment{};     ///< distal of the joint; of a fingertip: the last
  double place = 0.0;          ///< mm
  std::optional<double> axis;  ///< between the flexion axes, rad; none for a fingertip
};

/// Differences of one kind of dimension over all segments (Xie 2014, 4.5), mm.
struct DimensionErrors {
  double mean = 0.0;     ///< of the absolute values
  double largest = 0.0;  ///< absolute
};

struct ScanErrors {
  DimensionErrors x, y, z;          ///< breadth, length, thickness of the 15 segments
  hand::HandDimensions difference;  ///< found less true, of every dimension
  std::vector<PlaceError> places;
  double skin_mean = 0.0, skin_p95 = 0.0;  ///< of the hand's skin to the true one, mm; 0 without
};

/// Postures that both know; skin without the forearm.
ScanErrors scan_errors(const HandFromScan& made, const ScanTruth& truth);

/// Mean of the PIP joints, DIP joints or fingertips of fingers II to V in one posture (Xie 2014,
/// tables 4-1, 4-2): joint kPip, kDip or the tip. Nothing if there is none.
enum class FingerPlace { kPip, kDip, kTip };
struct MeanPlaceError {
  double place = 0.0;          ///< mm
  std::optional<double> axis;  ///< rad
};
std::optional<MeanPlaceError> mean_error(const ScanErrors& errors, hand::ScanPosture posture,
                                         FingerPlace place);

}  // namespace palmar::capture
