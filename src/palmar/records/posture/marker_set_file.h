// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/formats/motion/marker_file.h"
#include "palmar/hand/posture/marker_set.h"

namespace palmar::records {

/// Reads where a laboratory's markers sit (docs/using/postures.md), as CSV with the columns label,
/// landmark, vertex, part, x_mm, y_mm, z_mm, height_mm (cells may be empty), or as JSON {"markers":
/// [{"label", "landmark" | "vertex" | "point_mm" [with "part"], "height_mm"}]}. Each marker says
/// one of:
///
/// - landmark: a named point (landmarks.h), `height` above the skin;
/// - vertex: a vertex of the hand's skin, likewise;
/// - a point in the hand frame, reference posture, mm: fixed to `part` (a segment,
///   thumb_metacarpal, forearm), or without one moving with the skin nearest to it.
///
/// Throws InputError naming file, line or entry, and what is needed: an unknown column, landmark or
/// part (with the nearest known one), a label twice, a marker without a place or with two, a point
/// farther than 60 mm from the skin.
hand::MarkerSet read_marker_set(const std::string& path, const hand::Hand& hand);

/// A recording's positions in the order of a marker set.
struct MatchedMarkers {
  hand::MarkerSet set;                                   ///< the markers that the recording has
  std::vector<std::vector<std::optional<Vec3>>> frames;  ///< per frame and marker
  std::vector<std::string> notes;                        ///< labels that stand on one side only
};

/// Looks the set's labels up in the recording: the same text, else without what stands before a
/// colon ("Anna:index_nail") and without regard to case. Throws InputError naming `path` if none or
/// fewer than four are there.
MatchedMarkers match_markers(const hand::MarkerSet& set, const formats::MarkerRecording& recording,
                             const std::string& path);

}  // namespace palmar::records
