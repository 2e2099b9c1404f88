// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli.h"
#include "palmar/hand/skeleton.h"
#include "palmar/records/posture/posture_file.h"

namespace palmar::cli {

/// A note per angle that the range of motion changed; `place` ("frame 3") comes first if not empty.
void note_clamped(const CommonOptions& common, const std::string& place,
                  const std::vector<hand::ClampedAngle>& clamped);

/// What reading a posture changed or filled in: clamped angles, missing ones.
void note_frame(const CommonOptions& common, const records::PostureFrame& frame);

/// Placement X,Y,Z,QW,QX,QY,QZ: mm, then a unit quaternion, w first. Throws UsageError naming the
/// option.
geometry::Rigid3 parse_placement(const std::string& option, const std::string& text);

}  // namespace palmar::cli
