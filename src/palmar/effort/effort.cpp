// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/effort/effort.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::effort {
namespace {

void check_range(const char* name, double value, double least, double most, const char* unit) {
  if (value >= least && value <= most) return;
  throw UsageError(std::string("effort: ") + name + " is " + std::to_string(value) + " " + unit +
                   "; " + std::to_string(least) + " to " + std::to_string(most) + " " + unit +
                   " is allowed");
}

/// Of one digit, without what its muscles do.
DigitEffort loaded_digit(const hand::DigitMuscles& digit, const DigitMoments& external,
                         const EffortOptions& options) {
  const std::span<const hand::Tendon> own = hand::tendons_of(digit.finger);
  const std::array<hand::Dof, hand::kDigitDofs> dofs = hand::digit_dofs(digit.finger);
  DigitEffort effort;
  effort.finger = digit.finger;
  effort.contact_force = external.force;
  for (std::size_t t = 0; t < own.size(); ++t) {
    effort.tendons.push_back({.tendon = own[t],
                              .strength = options.strength * digit.strength[t],
                              .moment_arm = digit.arm[t]});
  }
  for (std::size_t k = 0; k < hand::kDigitDofs; ++k) {
    effort.joints[k].dof = dofs[k];
    effort.joints[k].external = external.moment[k];
  }
  return effort;
}

/// A digit's part of a problem that begins at `row` and `column`.
void take_solution(const hand::DigitMuscles& digit, const hand::MuscleProblem& problem,
                   const hand::MuscleSolution& solution, Eigen::Index row, Eigen::Index column,
                   double negligible, DigitEffort& effort) {
  const Eigen::VectorXd muscles =
      problem.moment_at_strength.middleRows(row, hand::kDigitDofs) * solution.activation;
  double missing = 0.0;
  for (Eigen::Index k = 0; k < hand::kDigitDofs; ++k) {
    JointEffort& joint = effort.joints[static_cast<std::size_t>(k)];
    joint.muscles = muscles[k];
    joint.stop = solution.stop[row + k] + digit.passive.moment[k];
    joint.missing = solution.missing[row + k];
    missing = std::max(missing, std::abs(joint.missing));
  }
  for (std::size_t t = 0; t < effort.tendons.size(); ++t) {
    TendonLoad& load = effort.tendons[t];
    load.activation = solution.activation[column + static_cast<Eigen::Index>(t)];
    load.force = load.activation * load.strength;
  }
  effort.status = solution.status == hand::MuscleStatus::kNotConverged ? EffortStatus::kNotConverged
                  : missing <= negligible                              ? EffortStatus::kHeld
                                                                       : EffortStatus::kOverloaded;
  effort.kkt_residual = solution.kkt_residual;
  effort.iterations = solution.iterations;
}

WristEffort wrist_effort(const hand::WristMuscles& wrist, const hand::MuscleProblem& problem,
                         const hand::MuscleSolution& solution, double external, double strength) {
  WristEffort effort;
  effort.external = external;
  const Eigen::Index first = problem.moment_at_strength.cols() - hand::kWristMuscleCount;
  const Eigen::RowVectorXd row = problem.moment_at_strength.bottomRows(1);
  effort.digits = row.head(first).dot(solution.activation.head(first));
  effort.muscles =
      row.tail<hand::kWristMuscleCount>().dot(solution.activation.tail<hand::kWristMuscleCount>());
  effort.missing = solution.missing[solution.missing.size() - 1];
  for (std::size_t i = 0; i < wrist.strength.size(); ++i) {
    effort.strength[i] = strength * wrist.strength[i];
    effort.force[i] =
        effort.strength[i] * solution.activation[first + static_cast<Eigen::Index>(i)];
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
  wrist.check();
}

double WristEffort::activation(hand::WristMuscle muscle) const {
  const double most = strength[palmar::index_of(muscle)];
  return most > 0.0 ? force[palmar::index_of(muscle)] / most : 0.0;
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

std::string plain_name_of(hand::Dof dof) {
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

EffortResult assess_effort(const hand::Hand& hand, const hand::Posture& posture,
                           std::span<const SkinForce> loads, const EffortOptions& options,
                           const hand::HandLoad* at_rest) {
  options.check();
  const hand::HandMuscles muscles(hand, {.tendons = options.tendons,
                                         .specific_tension = options.specific_tension,
                                         .has_passive = at_rest != nullptr,
                                         .stops = {.is_on = options.joint_stops,
                                                   .tight_mcp_flexion = options.tight_mcp_flexion,
                                                   .margin = options.stop_margin},
                                         .wrist = options.wrist});
  std::array<DigitMoments, hand::kFingerCount> external;
  double largest = 0.0;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    external[f] = digit_moments(hand, hand::pose_digit(hand.skeleton, finger, posture), loads);
    if (at_rest != nullptr) external[f].moment = at_rest->digit[f];
    for (const double moment : external[f].moment) largest = std::max(largest, std::abs(moment));
  }
  const double negligible = hand::kNegligibleMoment * largest;
  EffortResult result;
  std::vector<hand::DigitMuscles> loaded;
  hand::HandLoad load;
  if (at_rest != nullptr) load.wrist = at_rest->wrist;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const hand::DigitMuscles digit = muscles.in(static_cast<hand::Finger>(f), posture);
    result.digits[f] = loaded_digit(digit, external[f], options);
    load.digit[f] = external[f].moment;
    result.contact_force += external[f].force;
    const bool is_moved = std::any_of(load.digit[f].begin(), load.digit[f].end(),
                                      [](double moment) { return moment != 0.0; });
    if (external[f].force <= 0.0 && !is_moved) continue;
    result.digits[f].strength_share = hand::least_strength_share(
        hand::problem_of(digit, load.digit[f], options.strength), negligible);
    loaded.push_back(digit);
  }
  if (loaded.empty()) return result;
  // Digits depend on each other through the wrist alone, and forces that don't balance say nothing
  // about it.
  std::vector<std::span<const hand::DigitMuscles>> groups;
  if (at_rest != nullptr) groups.emplace_back(loaded);
  for (std::size_t i = 0; i < loaded.size() && at_rest == nullptr; ++i) {
    groups.emplace_back(&loaded[i], 1);
  }
  hand::MuscleProblem problem;
  hand::MuscleSolution solution;
  for (const std::span<const hand::DigitMuscles>& group : groups) {
    problem =
        at_rest != nullptr
            ? hand::problem_of(group, muscles.wrist(), load, options.strength, options.exponent)
            : hand::problem_of(group[0], load.digit[palmar::index_of(group[0].finger)],
                               options.strength, options.exponent);
    solution = hand::balance_muscles(problem);
    Eigen::Index row = 0, column = 0;
    for (const hand::DigitMuscles& one : group) {
      DigitEffort& digit = result.digits[palmar::index_of(one.finger)];
      take_solution(one, problem, solution, row, column, negligible, digit);
      row += hand::kDigitDofs;
      column += static_cast<Eigen::Index>(digit.tendons.size());
      result.status = std::max(result.status, digit.status);
      for (const TendonLoad& tendon : digit.tendons) result.tendon_force += tendon.force;
      add_message(digit, result.message);
    }
    result.strength_share =
        std::max(result.strength_share, hand::least_strength_share(problem, negligible));
  }
  if (at_rest == nullptr) return result;
  result.wrist = wrist_effort(muscles.wrist(), problem, solution, at_rest->wrist, options.strength);
  const double missing = std::abs(result.wrist->missing);
  if (missing > negligible) {
    result.status = std::max(result.status, EffortStatus::kOverloaded);
    result.message += std::string(result.message.empty() ? "" : "; ") +
                      "wrist flexion: " + rounded(missing) + " N mm missing";
  }
  return result;
}

EffortResult assess_effort(const hand::Hand& hand, const hand::Posture& posture,
                           const contact::ContactResult& contact,
                           const geometry::Rigid3& product_from_hand,
                           const geometry::DistanceField& product, const EffortOptions& options,
                           const contact::FrictionResult* friction, const hand::HandLoad* at_rest) {
  const std::vector<SkinForce> loads = skin_loads(contact, product_from_hand, product, friction);
  EffortResult result = assess_effort(hand, posture, loads, options, at_rest);
  result.with_friction = friction != nullptr && !friction->force.empty();
  return result;
}

}  // namespace palmar::effort
