// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/effort.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/core/error.h"

namespace palmar {
namespace {

void check_range(const char* name, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw UsageError(std::string("effort: ") + name + " is " + std::to_string(value) + " " + unit +
                   "; " + std::to_string(least) + " to " + std::to_string(most) + " " + unit +
                   " is allowed");
}

EffortStatus status_of(MuscleStatus status) {
  if (status == MuscleStatus::kBalanced) return EffortStatus::kHeld;
  return status == MuscleStatus::kOverloaded ? EffortStatus::kOverloaded
                                             : EffortStatus::kNotConverged;
}

DigitEffort effort_of_digit(const HandMuscles& hand_muscles, Finger finger, const Posture& posture,
                            const DigitMoments& external, double negligible,
                            const EffortOptions& options) {
  const std::span<const Tendon> own = tendons_of(finger);
  const DigitMuscles digit = hand_muscles.in(finger, posture);
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(finger);

  DigitEffort effort;
  effort.finger = finger;
  effort.contact_force = external.force;
  for (std::size_t t = 0; t < own.size(); ++t) {
    effort.tendons.push_back({.tendon = own[t],
                              .strength = options.strength * digit.strength[t],
                              .moment_arm = digit.arm[t]});
  }
  for (std::size_t k = 0; k < kDigitDofs; ++k) {
    effort.joints[k].dof = dofs[k];
    effort.joints[k].external = external.moment[k];
  }
  if (external.force <= 0.0) return effort;

  const MuscleProblem problem =
      problem_of(digit, external.moment, options.strength, options.exponent);
  const MuscleSolution solution = balance_muscles(problem);
  const bool is_held = is_enough(solution, negligible);
  effort.status = is_held ? EffortStatus::kHeld : status_of(solution.status);
  effort.kkt_residual = solution.kkt_residual;
  effort.iterations = solution.iterations;
  effort.strength_share = least_strength_share(problem, negligible);
  const Eigen::VectorXd muscles = problem.moment_at_strength * solution.activation;
  for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
    JointEffort& joint = effort.joints[static_cast<std::size_t>(k)];
    joint.muscles = muscles[k];
    joint.stop = solution.stop[k] + digit.passive.moment[k];
    joint.missing = solution.missing[k];
  }
  for (std::size_t t = 0; t < own.size(); ++t) {
    TendonLoad& load = effort.tendons[t];
    load.activation = solution.activation[static_cast<Eigen::Index>(t)];
    load.force = load.activation * load.strength;
  }
  return effort;
}

std::string rounded(double value) { return std::to_string(std::llround(value)); }

void add_message(const DigitEffort& digit, std::string& message) {
  const auto add = [&](const std::string& text) {
    message += (message.empty() ? "" : "; ") + text;
  };
  if (digit.status == EffortStatus::kNotConverged) {
    add("the muscles of the " + std::string(name_of(digit.finger)) +
        " found no balance (residual " + std::to_string(digit.kkt_residual) + ")");
  }
  if (digit.status != EffortStatus::kOverloaded) return;
  for (const JointEffort& joint : digit.joints) {
    if (joint.missing == 0.0) continue;
    add(plain_name_of(joint.dof) + ": " + rounded(std::abs(joint.missing)) + " N mm missing");
  }
}

}  // namespace

void EffortOptions::check() const {
  if (exponent != 2 && exponent != 3) {
    throw UsageError("effort: exponent is " + std::to_string(exponent) + "; 2 or 3 is allowed");
  }
  check_range("specific tension", specific_tension, 0.01, 10.0, "MPa");
  check_range("strength", strength, 0.01, 10.0, "times the cadavers'");
  check_range("flexion of tight MCP ligaments", tight_mcp_flexion, 0.0, 10.0, "rad");
  check_range("stop margin", stop_margin, 0.0, 0.5, "rad");
  tendons.hood.check();
}

std::string_view name_of(EffortStatus status) {
  switch (status) {
    case EffortStatus::kNoLoad:
      return "no_load";
    case EffortStatus::kHeld:
      return "held";
    case EffortStatus::kOverloaded:
      return "overloaded";
    case EffortStatus::kNotConverged:
      break;
  }
  return "not_converged";
}

std::string plain_name_of(Dof dof) {
  std::string name(name_of(dof));
  for (char& c : name) c = c == '_' ? ' ' : c;
  for (const std::string joint : {"cmc", "mcp", "pip", "dip", " mp ", " ip "}) {
    const std::size_t at = name.find(joint);
    if (at == std::string::npos) continue;
    for (std::size_t i = at; i < at + joint.size(); ++i) {
      if (name[i] != ' ') name[i] = static_cast<char>(name[i] - 'a' + 'A');
    }
  }
  return name;
}

EffortResult assess_effort(const Hand& hand, const Posture& posture,
                           std::span<const SkinLoad> loads, const EffortOptions& options,
                           const HandLoad* at_rest) {
  options.check();
  const HandMuscles muscles(hand, {.tendons = options.tendons,
                                   .specific_tension = options.specific_tension,
                                   .stops = {.is_on = options.joint_stops,
                                             .tight_mcp_flexion = options.tight_mcp_flexion,
                                             .margin = options.stop_margin},
                                   .has_passive = at_rest != nullptr});
  std::array<DigitMoments, kFingerCount> external;
  double largest = 0.0;
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    external[f] = digit_moments(hand, pose_digit(hand.skeleton, finger, posture), loads);
    if (at_rest != nullptr) external[f].moment = (*at_rest)[f];
    for (const double moment : external[f].moment) largest = std::max(largest, std::abs(moment));
  }
  EffortResult result;
  for (int f = 0; f < kFingerCount; ++f) {
    DigitEffort& digit = result.digits[f];
    digit = effort_of_digit(muscles, static_cast<Finger>(f), posture, external[f],
                            kNegligibleMoment * largest, options);
    result.status = std::max(result.status, digit.status);
    result.contact_force += digit.contact_force;
    result.strength_share = std::max(result.strength_share, digit.strength_share);
    for (const TendonLoad& load : digit.tendons) result.tendon_force += load.force;
    add_message(digit, result.message);
  }
  return result;
}

EffortResult assess_effort(const Hand& hand, const Posture& posture, const ContactResult& contact,
                           const Rigid3& product_from_hand, const DistanceField& product,
                           const EffortOptions& options, const FrictionResult* friction,
                           const HandLoad* at_rest) {
  const std::vector<SkinLoad> loads = skin_loads(contact, product_from_hand, product, friction);
  EffortResult result = assess_effort(hand, posture, loads, options, at_rest);
  result.with_friction = friction != nullptr && !friction->force.empty();
  return result;
}

}  // namespace palmar
