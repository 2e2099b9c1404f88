// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/posture_notes.h"

#include <fmt/format.h>

#include <numbers>

namespace palmar::workflow {
namespace {

double in_degrees(double angle) { return angle * 180.0 / std::numbers::pi; }

}  // namespace

std::vector<std::string> clamped_notes(const std::string& place,
                                       const std::vector<hand::ClampedAngle>& clamped) {
  std::vector<std::string> notes;
  for (const hand::ClampedAngle& angle : clamped) {
    notes.push_back(
        fmt::format("{}{}{}: {:.1f} deg is outside the range of motion; {:.1f} deg is used", place,
                    place.empty() ? "" : ": ", name_of(angle.dof), in_degrees(angle.asked),
                    in_degrees(angle.used)));
  }
  return notes;
}

std::vector<std::string> frame_notes(const records::PostureFrame& frame) {
  std::vector<std::string> notes;
  if (!frame.missing.empty()) {
    std::string names;
    for (const hand::Dof dof : frame.missing) {
      names += (names.empty() ? "" : ", ") + std::string(name_of(dof));
    }
    notes.push_back(fmt::format(
        "{}{}{} of {} angles are not given and stay as in the reference "
        "posture: {}",
        frame.name, frame.name.empty() ? "" : ": ", frame.missing.size(), hand::kDofCount, names));
  }
  for (std::string& note : clamped_notes(frame.name, frame.clamped)) {
    notes.push_back(std::move(note));
  }
  return notes;
}

}  // namespace palmar::workflow
