// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/posture_notes.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/workflow/hand/posture_notes.h"

namespace palmar::cli {

void note_clamped(const CommonOptions& common, const std::string& place,
                  const std::vector<hand::ClampedAngle>& clamped) {
  for (const std::string& text : workflow::clamped_notes(place, clamped)) note(common, text);
}

void note_frame(const CommonOptions& common, const records::PostureFrame& frame) {
  for (const std::string& text : workflow::frame_notes(frame)) note(common, text);
}

geometry::Rigid3 parse_placement(const std::string& option, const std::string& text) {
  const std::vector<double> n = workflow::parse_list(option, text);
  if (n.size() != 7) {
    throw UsageError(
        fmt::format("{}: \"{}\" has {} numbers; seven are needed: x,y,z in mm and the "
                    "quaternion w,x,y,z",
                    option, text, n.size()));
  }
  const Quat turn(n[3], n[4], n[5], n[6]);
  constexpr double kRounding = 0.01;  // of a unit length: typed numbers are rounded
  if (!(std::abs(turn.norm() - 1.0) < kRounding)) {
    throw UsageError(
        fmt::format("{}: the quaternion (the last four numbers, w first) has length "
                    "{:.3g}; 1 is required",
                    option, turn.norm()));
  }
  return {turn.normalized(), Vec3(n[0], n[1], n[2])};
}

}  // namespace palmar::cli
