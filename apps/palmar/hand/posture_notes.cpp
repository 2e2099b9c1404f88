// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/posture_notes.h"

#include <fmt/format.h>

#include <cmath>

#include "palmar/core/error.h"
#include "text.h"

namespace palmar::cli {

void note_clamped(const CommonOptions& common, const std::string& place,
                  const std::vector<ClampedAngle>& clamped) {
  for (const ClampedAngle& angle : clamped) {
    note(common,
         fmt::format("{}{}{}: {:.1f} deg is outside the range of motion; {:.1f} deg is used", place,
                     place.empty() ? "" : ": ", name_of(angle.dof), degrees(angle.asked),
                     degrees(angle.used)));
  }
}

void note_frame(const CommonOptions& common, const PostureFrame& frame) {
  if (!frame.missing.empty()) {
    std::string names;
    for (const Dof dof : frame.missing) {
      names += (names.empty() ? "" : ", ") + std::string(name_of(dof));
    }
    note(common, fmt::format("{}{}{} of {} angles are not given and stay as in the reference "
                             "posture: {}",
                             frame.name, frame.name.empty() ? "" : ": ", frame.missing.size(),
                             kDofCount, names));
  }
  note_clamped(common, frame.name, frame.clamped);
}

Rigid3 parse_placement(const std::string& option, const std::string& text) {
  const std::vector<double> n = parse_list(option, text);
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
