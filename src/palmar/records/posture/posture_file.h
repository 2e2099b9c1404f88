// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grip.h"
#include "palmar/hand/skeleton.h"

namespace palmar::records {

/// One posture of a file, held to the hand's range of motion.
struct PostureFrame {
  std::string name;            ///< "frame 3", "cup": what messages call it; empty for a single one
  std::optional<double> time;  ///< s
  hand::Posture posture;
  std::vector<hand::ClampedAngle> clamped;  ///< angles that were outside the range of motion
  std::vector<hand::Dof> missing;           ///< not in the file: at the reference posture's angle
  std::optional<geometry::Rigid3> product_from_hand;  ///< where the hand holds a product, if the
                                                      ///< file says so Where the hand is in the
                                                      ///< frame of markers or mesh it was found
                                                      ///< from, if the file says so.
  std::optional<geometry::Rigid3> measured_from_hand;
  std::optional<grasp::Grip> grip;  ///< by which grip, likewise
};

struct PostureFile {
  std::vector<PostureFrame> frames;  ///< at least one
  std::vector<std::string> notes;    ///< columns that were ignored
};

/// Reads joint angles (docs/using/postures.md). JSON: an object of angles, alone or as "posture" of
/// a grasp, of an assessment.json or of what `palmar hand pose` prints; several as "frames",
/// "assessments" or a list. CSV: one row per frame, one column per degree of freedom, time_s and
/// frame optional; an empty cell is a missing angle. Names end in their unit:
/// index_pip_flexion_deg or index_pip_flexion_rad.
///
/// Throws InputError naming file, place, name, value and what is needed: no JSON or CSV, an unknown
/// name (with the nearest known one), a name without unit, an angle twice, no finite number, an
/// angle beyond a full turn, a file without any angle.
PostureFile read_postures(const std::string& path, const hand::Skeleton& skeleton);

/// One of a file's frames: number `which` from 1; without it the file must have only one. Throws
/// UsageError for a number that isn't there, InputError if it has several and none is asked for.
const PostureFrame& frame_of(const PostureFile& file, const std::string& path,
                             std::optional<int> which);

/// {"index_mcp_flexion_deg": 40, ...}, all 23; shortest digits that read back to the same double.
std::string posture_json(const hand::Posture& posture);

}  // namespace palmar::records
