// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/skeleton.h"
#include "palmar/records/posture/posture_file.h"

namespace palmar::workflow {

/// A note per angle that the range of motion changed; `place` ("frame 3") comes first if not empty.
std::vector<std::string> clamped_notes(const std::string& place,
                                       const std::vector<hand::ClampedAngle>& clamped);

/// What reading a posture changed or filled in: missing angles, clamped ones.
std::vector<std::string> frame_notes(const records::PostureFrame& frame);

}  // namespace palmar::workflow
