// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/hand_muscles.h"

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar::hand {
namespace {

// mm, in the order of tendons_of(): FDP, FDS, EDC (index to little finger's of Lee et al. 2015),
// lumbricals and interossei, the little finger's abductor (Jacobson et al. 1992). They change the
// force of the hand's own muscles by some percent at most.
constexpr double kFingerFibres[4][6] = {{74.9, 83.5, 70.0, 55.4, 31.7, 25.0},
                                        {83.5, 74.9, 72.4, 55.5, 25.1, 25.8},
                                        {79.8, 73.6, 62.6, 56.2, 25.0, 25.8},
                                        {74.9, 51.5, 65.0, 50.1, 23.6, 46.2}};
// FPL, EPL, EPB, APL: Lee et al. 2015; FPB, APB, OPP, ADP: Jacobson et al. 1992.
constexpr double kThumbFibres[8] = {55.2, 41.5, 41.6, 35.5, 34.0, 54.0, 67.5, 71.3};
// People's thumbs over what the tendons of the one specimen give at the cross-sections of others:
// 104 N flexing the proximal phalanx (Li, Harkness 2004) over 37 N. See docs/method/strength.md.
constexpr double kThumbScale = 2.8;
constexpr std::array<double, kDigitDofs> kFingerFunction = {
    45.0 * geometry::kDegree, 0.0, 45.0 * geometry::kDegree, 25.0 * geometry::kDegree};

Posture position_of_function(const Skeleton& skeleton, Finger finger) {
  Posture posture = reference_posture(skeleton);
  const std::array<Dof, kDigitDofs> dofs = digit_dofs(finger);
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    if (!is_flexion(dofs[k])) continue;
    if (finger != Finger::kThumb) {
      posture[dofs[k]] = kFingerFunction[k];
    } else if (k > 0) {
      const JointDof& dof = skeleton.dof(dofs[k]);
      posture[dofs[k]] = 0.5 * (dof.lower + dof.upper);
    }
  }
  return posture;
}

double fibres_of(Finger finger, std::size_t tendon) {
  return finger == Finger::kThumb ? kThumbFibres[tendon]
                                  : kFingerFibres[static_cast<int>(finger) - 1][tendon];
}

}  // namespace

HandMuscles::HandMuscles(const Hand& hand, const MuscleModel& model)
    : hand_(&hand),
      has_passive_(model.has_passive),
      ligaments_(model.ligaments),
      stops_(model.stops),
      wrist_(wrist_muscles(hand, model.wrist, model.specific_tension)) {
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const PosedDigit digit =
        pose_digit(hand.skeleton, finger, position_of_function(hand.skeleton, finger));
    DigitTendons tendons = route_tendons(hand, finger, model.tendons);
    const std::span<const Tendon> names = tendons_of(finger);
    for (std::size_t t = 0; t < names.size(); ++t) {
      Muscle muscle;
      muscle.best_length = fibres_of(finger, t);
      const double scale = finger == Finger::kThumb ? kThumbScale : 1.0;
      muscle.force = model.specific_tension * cross_section_of(finger, names[t]) * scale;
      const WristVector arm = wrist_arm(hand, finger, names[t]);
      muscle.wrist_arm = arm / scale;
      muscle.wrist_stretch = wrist_stretch(arm, model.wrist);
      muscle.best_path = path_length(tendons.path[t], digit);
      muscle.path = std::move(tendons.path[t]);
      muscles_[f].push_back(std::move(muscle));
    }
  }
}

DigitMuscles HandMuscles::in(Finger finger, const Posture& posture) const {
  const PosedDigit digit = pose_digit(hand_->skeleton, finger, posture);
  DigitMuscles result;
  result.finger = finger;
  for (const Muscle& muscle : muscles_[index_of(finger)]) {
    const double stretch =
        path_length(muscle.path, digit) - muscle.best_path + muscle.wrist_stretch;
    result.strength.push_back(muscle.force * force_length(stretch, muscle.best_length));
    result.fibre.push_back(muscle.best_length);
    result.arm.push_back(moment_arms(muscle.path, digit));
    result.wrist_arm.push_back(muscle.wrist_arm);
  }
  if (has_passive_) {
    result.passive = passive_moments(hand_->skeleton, finger, posture, ligaments_);
    return result;
  }
  for (std::size_t k = 0; k < kDigitDofs; ++k) {
    result.stop[k] = stop_of(hand_->skeleton, digit.dof[k], posture, stops_);
  }
  return result;
}

MuscleProblem problem_of(const DigitMuscles& muscles, const DigitLoad& load, double strength,
                         int exponent) {
  const auto count = static_cast<Eigen::Index>(muscles.arm.size());
  MuscleProblem problem{.moment_at_strength = Eigen::MatrixXd(kDigitDofs, count),
                        .required = Eigen::VectorXd(kDigitDofs),
                        .stop = Eigen::VectorXi(kDigitDofs),
                        .exponent = exponent};
  for (Eigen::Index k = 0; k < kDigitDofs; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    problem.required[k] = -load[axis] - muscles.passive.moment[k];
    problem.stop[k] = load[axis] == 0.0 ? 2 : muscles.stop[axis];
    for (Eigen::Index t = 0; t < count; ++t) {
      const auto tendon = static_cast<std::size_t>(t);
      problem.moment_at_strength(k, t) =
          strength * muscles.strength[tendon] * muscles.arm[tendon][axis];
    }
  }
  return problem;
}

MuscleProblem problem_of(std::span<const DigitMuscles> digits, const WristMuscles& wrist,
                         const HandLoad& load, double strength, int exponent) {
  Eigen::Index columns = kWristMuscleCount;
  for (const DigitMuscles& digit : digits) columns += static_cast<Eigen::Index>(digit.arm.size());
  const Eigen::Index angles = kDigitDofs * static_cast<Eigen::Index>(digits.size());
  const Eigen::Index rows = angles + 1;
  MuscleProblem problem{.moment_at_strength = Eigen::MatrixXd::Zero(rows, columns),
                        .required = Eigen::VectorXd(rows),
                        .stop = Eigen::VectorXi::Zero(rows),
                        .exponent = exponent};
  Eigen::Index row = 0, column = 0;
  for (const DigitMuscles& digit : digits) {
    const MuscleProblem own =
        problem_of(digit, load.digit[index_of(digit.finger)], strength, exponent);
    const Eigen::Index count = own.moment_at_strength.cols();
    problem.moment_at_strength.block(row, column, kDigitDofs, count) = own.moment_at_strength;
    problem.required.segment(row, kDigitDofs) = own.required;
    problem.stop.segment(row, kDigitDofs) = own.stop;
    for (Eigen::Index t = 0; t < count; ++t) {
      const auto tendon = static_cast<std::size_t>(t);
      problem.moment_at_strength(angles, column + t) =
          strength * digit.strength[tendon] * digit.wrist_arm[tendon].x();
    }
    row += kDigitDofs;
    column += count;
  }
  for (std::size_t i = 0; i < wrist.arm.size(); ++i) {
    problem.moment_at_strength(angles, column + static_cast<Eigen::Index>(i)) =
        strength * wrist.strength[i] * wrist.arm[i].x();
  }
  problem.required[angles] = -load.wrist;
  return problem;
}

}  // namespace palmar::hand
