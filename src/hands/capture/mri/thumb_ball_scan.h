// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/skin_registration.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// One limit posture of the thumb as it was scanned, in the hand frame.
struct ThumbLimitScan {
  hand::Posture posture;
  SkinScan skin;
};

struct ThumbBallScanOptions {
  double spacing = 9.0;  ///< of the points taken from the skin, mm
  void check() const;    ///< throws UsageError: field, value, allowed range
};

/// A correction and what it stands on.
struct ThumbBallFit {
  hand::ThumbBallCorrection correction;
  std::optional<hand::ThumbBallCorrection> by_markers;  ///< by these alone, as in the thesis
  int markers = 0;      ///< found in the reference and most limit postures
  int skin_points = 0;  ///< taken from the scanned skin besides
  std::vector<std::string> notes;
};

/// The thumb-ball correction of a hand (Xie 2014, eq. 2-8 to 2-10) from scans of the limit postures
/// (flexion, extension, abduction, adduction; those that lack get no correction). `markers`:
/// centres in the reference posture, hand frame. Each marker's skin point is its foot on the skin;
/// in a limit posture it lies as far below the marker found there. Beyond the thesis: points of the
/// skin between and around the markers, taken from the posed skin bent onto the scan, are met as
/// well.
ThumbBallFit fit_scanned_thumb_ball(const hand::Hand& hand, const std::vector<Vec3>& markers,
                                    const std::array<std::optional<ThumbLimitScan>, 4>& limits,
                                    const ThumbBallScanOptions& options = {},
                                    const Progress& progress = {});

/// Vertices round the thumb ball: skin of the palm that the CMC joint moves by a twentieth or more,
/// and up to 12 mm beyond on the thumb's first phalanx.
std::vector<int> thumb_ball_skin(const hand::Hand& hand);

}  // namespace palmar::capture
