// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort_fingertip.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <string>

#include "palmar/core/error.h"
#include "palmar/effort/effort.h"

namespace palmar::workflow {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;  // in a radian
constexpr double kRangeSlack = 1e-9;                   // deg; rounding at the ends of a range

void check_tendon(hand::Finger finger, hand::Tendon tendon) {
  const auto own = hand::tendons_of(finger);
  if (std::find(own.begin(), own.end(), tendon) != own.end()) return;
  std::string known;
  for (const hand::Tendon one : own)
    known += (known.empty() ? "" : ", ") + std::string(name_of(one));
  throw UsageError(fmt::format("setting \"tendon\": the {} has no tendon \"{}\"; it has {}",
                               name_of(finger), name_of(tendon), known));
}

void check_angle(hand::Finger finger, hand::Dof dof) {
  for (const DigitAngleName& own : angle_names_of(finger)) {
    if (own.dof == dof) return;
  }
  throw UsageError(fmt::format("setting \"posture\": {} is no angle of the {}",
                               effort::plain_name_of(dof), name_of(finger)));
}

/// The reference posture with that finger's angles.
hand::Posture posture_for(const FingertipRequest& request, const hand::Skeleton& skeleton) {
  hand::Posture posture = hand::reference_posture(skeleton);
  for (const auto& [name, dof] : angle_names_of(request.finger)) {
    const hand::JointDof& range = skeleton.dof(dof);
    posture[dof] = std::clamp(0.0, range.lower, range.upper);
    for (const DigitAngle& given : request.posture) {
      if (given.dof != dof) continue;
      const double angle = kDegrees * given.angle;
      const double lower = kDegrees * range.lower, upper = kDegrees * range.upper;
      if (!(angle >= lower - kRangeSlack && angle <= upper + kRangeSlack)) {
        throw UsageError(fmt::format(
            "setting \"posture\": {} is {:g} deg; the range of {} is {:.1f} to {:.1f} deg", name,
            angle, effort::plain_name_of(dof), lower, upper));
      }
      posture[dof] = given.angle;
    }
  }
  return posture;
}

}  // namespace

std::vector<DigitAngleName> angle_names_of(hand::Finger finger) {
  if (finger == hand::Finger::kThumb) {
    return {{"cmc-flexion", hand::Dof::kThumbCmcFlexion},
            {"cmc-abduction", hand::Dof::kThumbCmcAbduction},
            {"mp", hand::Dof::kThumbMpFlexion},
            {"ip", hand::Dof::kThumbIpFlexion}};
  }
  const auto dof = [&](const char* joint) {
    return *hand::dof_named(fmt::format("{}_{}", name_of(finger), joint));
  };
  return {{"mcp", dof("mcp_flexion")},
          {"abduction", dof("mcp_abduction")},
          {"pip", dof("pip_flexion")},
          {"dip", dof("dip_flexion")}};
}

void FingertipRequest::check() const {
  if (!(force > 0.0) || force > effort::kLargestTendonForce) {
    throw UsageError(fmt::format("setting \"force\" is {:g}; above 0 and at most {:g} N is allowed",
                                 force, effort::kLargestTendonForce));
  }
  for (const hand::Tendon tendon : tendons) check_tendon(finger, tendon);
  for (const DigitAngle& given : posture) check_angle(finger, given.dof);
  model.hood.check();
}

FingertipOutcome fingertip_forces(const FingertipRequest& request) {
  request.check();
  const auto hand = load_hand(request.hand);
  FingertipOutcome outcome;
  outcome.posture = posture_for(request, hand->skeleton);
  const hand::DigitTendons routed = hand::route_tendons(*hand, request.finger, request.model);
  const auto own = hand::tendons_of(request.finger);
  const std::vector<hand::Tendon> loaded =
      request.tendons.empty() ? std::vector<hand::Tendon>(own.begin(), own.end()) : request.tendons;
  for (const hand::Tendon tendon : loaded) {
    outcome.forces.push_back(
        effort::fingertip_force(*hand, routed, outcome.posture, tendon, request.force));
  }
  return outcome;
}

}  // namespace palmar::workflow
