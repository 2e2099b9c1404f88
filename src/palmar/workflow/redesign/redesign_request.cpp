// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/redesign_request.h"

#include <fmt/format.h>

#include "palmar/core/error.h"

namespace palmar::workflow {

std::string name_of(RedesignPosture posture) {
  return posture == RedesignPosture::kKept ? "kept" : "new";
}

RedesignPosture redesign_posture(const std::string& name) {
  for (const RedesignPosture posture : {RedesignPosture::kKept, RedesignPosture::kNew}) {
    if (name == name_of(posture)) return posture;
  }
  throw UsageError("setting \"posture\" is \"" + name + "\"; kept or new is allowed");
}

void require_setting(bool holds, const char* field, double value, const char* allowed) {
  if (holds) return;
  throw UsageError(fmt::format("setting \"{}\" is {:g}; {} is allowed", field, value, allowed));
}

void RedesignRequest::check() const {
  if (product.empty()) {
    throw UsageError(
        "setting \"product\" is empty; a file or \"made: KIND PARAMETER=VALUE\" is required");
  }
  if (out.empty()) throw UsageError("setting \"out\" is empty; a folder is required");
  if (populations.empty()) {
    throw UsageError("setting \"populations\" is empty; one or more are required");
  }
  grasp::GraspSettings how;
  how.placement.at = at;
  how.placement.axis = axis;
  how.holding = holding;
  how.check();
  constexpr int kMostHands = 100'000;
  if (hands < 1 || hands > kMostHands) {
    throw UsageError(
        fmt::format("setting \"hands\" is {}; 1 to {} are allowed", hands, kMostHands));
  }
  constexpr double kMostForce = 500.0;  // N; about the strongest grip measured
  if (!(grip_force >= 0.0 && grip_force <= kMostForce)) {
    throw UsageError(
        fmt::format("setting \"grip force\" is {:g} N; 0 (the usual one) to {:g} N are allowed",
                    grip_force, kMostForce));
  }
  if (grip_force > 0.0 && posture == RedesignPosture::kKept) {
    throw UsageError(
        "setting \"grip force\": in a kept posture the shape decides the force; setting "
        "\"posture\" "
        "new goes with it");
  }
}

}  // namespace palmar::workflow
