// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/effort.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/effort/muscle_balance.h"

namespace palmar {
namespace {

void check_range(const char* name, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw UsageError(std::string("effort: ") + name + " is " + std::to_string(value) + " " + unit +
                   "; " + std::to_string(least) + " to " + std::to_string(most) + " " + unit +
                   " is allowed");
}

/// How the joint's ligaments can push the angle, see MuscleProblem::stop.
int stop_at(const Skeleton& skeleton, Dof which, const Posture& posture,
            const EffortOptions& options) {
  if (!options.joint_stops) return 0;
  for (const Joint& joint : skeleton.joints) {
    if (joint.dofs.size() != 2 || joint.id == JointId::kThumbCmc) continue;
    // A finger's MCP: flexion and abduction.
    const bool flexes_first = name_of(joint.dofs[0].dof).ends_with("flexion");
    const Dof flexion = joint.dofs[flexes_first ? 0 : 1].dof;
    const Dof abduction = joint.dofs[flexes_first ? 1 : 0].dof;
    if (which == abduction && posture[flexion] >= options.tight_mcp_flexion) return 2;
  }
  const JointDof& dof = skeleton.dof(which);
  if (posture[which] >= dof.upper - options.stop_margin) return -1;
  if (posture[which] <= dof.lower + options.stop_margin) return 1;
  return 0;
}

EffortStatus status_of(MuscleStatus status) {
  if (status == MuscleStatus::kBalanced) return EffortStatus::kHeld;
  return status == MuscleStatus::kOverloaded ? EffortStatus::kOverloaded
                                             : EffortStatus::kNotConverged;
}

DigitEffort effort_of_digit(const Hand& hand, Finger finger, const Posture& posture,
                            std::span<const SkinLoad> loads, const EffortOptions& options) {
  const PosedDigit digit = pose_digit(hand.skeleton, finger, posture);
  const DigitMoments external = digit_moments(hand, digit, loads);
  const std::span<const Tendon> own = tendons_of(finger);

  DigitEffort effort;
  effort.finger = finger;
  effort.contact_force = external.force;
  const auto arms = moment_arms(route_tendons(hand, finger, options.tendons), digit);
  for (std::size_t t = 0; t < own.size(); ++t) {
    effort.tendons.push_back(
        {.tendon = own[t],
         .strength = options.strength * options.specific_tension * cross_section_of(finger, own[t]),
         .moment_arm = arms[t]});
  }
  const auto count = static_cast<Eigen::Index>(own.size());
  MuscleProblem problem{.moment_at_strength = Eigen::MatrixXd(kDigitDofs, count),
                        .required = Eigen::VectorXd(kDigitDofs),
                        .stop = Eigen::VectorXi(kDigitDofs),
                        .exponent = options.exponent};
  for (int k = 0; k < kDigitDofs; ++k) {
    effort.joints[k].dof = digit.dof[k];
    effort.joints[k].external = external.moment[k];
    problem.required[k] = -external.moment[k];
    problem.stop[k] = stop_at(hand.skeleton, digit.dof[k], posture, options);
    for (std::size_t t = 0; t < own.size(); ++t) {
      problem.moment_at_strength(k, static_cast<Eigen::Index>(t)) =
          effort.tendons[t].strength * arms[t][k];
    }
  }
  if (external.force <= 0.0) return effort;

  const MuscleSolution solution = balance_muscles(problem);
  effort.status = status_of(solution.status);
  effort.kkt_residual = solution.kkt_residual;
  effort.iterations = solution.iterations;
  const Eigen::VectorXd muscles = problem.moment_at_strength * solution.activation;
  for (int k = 0; k < kDigitDofs; ++k) {
    JointEffort& joint = effort.joints[k];
    joint.muscles = muscles[k];
    joint.stop = solution.stop[k];
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
  const std::string unjudged =
      digit.finger == Finger::kThumb ? " (one specimen's tendons, no verdict)" : "";
  for (const JointEffort& joint : digit.joints) {
    if (joint.missing == 0.0) continue;
    add(plain_name_of(joint.dof) + ": " + rounded(std::abs(joint.missing)) + " N mm missing" +
        unjudged);
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
                           std::span<const SkinLoad> loads, const EffortOptions& options) {
  options.check();
  EffortResult result;
  for (int f = 0; f < kFingerCount; ++f) {
    DigitEffort& digit = result.digits[f];
    digit = effort_of_digit(hand, static_cast<Finger>(f), posture, loads, options);
    // The thumb's tendons are those of one specimen: good for their order, not for a verdict.
    const bool is_judged = f > 0 || digit.status != EffortStatus::kOverloaded;
    result.status = std::max(result.status, is_judged ? digit.status : EffortStatus::kHeld);
    result.contact_force += digit.contact_force;
    for (const TendonLoad& load : digit.tendons) result.tendon_force += load.force;
    add_message(digit, result.message);
  }
  return result;
}

EffortResult assess_effort(const Hand& hand, const Posture& posture, const ContactResult& contact,
                           const Rigid3& product_from_hand, const DistanceField& product,
                           const EffortOptions& options, const FrictionResult* friction) {
  const std::vector<SkinLoad> loads = skin_loads(contact, product_from_hand, product, friction);
  EffortResult result = assess_effort(hand, posture, loads, options);
  result.with_friction = friction != nullptr && !friction->force.empty();
  return result;
}

}  // namespace palmar
