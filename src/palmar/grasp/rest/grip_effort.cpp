// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/grip_effort.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {
namespace {

constexpr double kByWrist = 1.02;  // of the share of fingers alone; more is the wrist's
/// Force that a muscle gains per stretch over its fibres' length, over its force: short-range
/// stiffness (Cui, Perreault, Maas & Sandercock 2008, J Biomech 41:1945-1952).
constexpr double kShortRange = 23.4;
/// The most that a stretched muscle holds above its isometric force: first dorsal interosseous of
/// people after the stretch (Cook & McDonagh 1995, Exp Physiol 80:477-490).
constexpr double kMostEnhanced = 0.3;

int muscle_count() {
  int count = hand::kWristMuscleCount;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    count += static_cast<int>(hand::tendons_of(static_cast<hand::Finger>(f)).size());
  }
  return count;
}

}  // namespace

GripEffort::GripEffort(const hand::Hand& hand, double limit, const hand::Posture& closed,
                       const hand::WristPosture& wrist)
    : muscles_(hand, {.wrist = wrist}),
      closed_(closed),
      limit_(limit),
      at_limit_(Eigen::MatrixXd::Zero(kGripJoints, muscle_count())),
      wrist_at_limit_(Eigen::RowVectorXd::Zero(muscle_count())),
      now_{.activation = Eigen::VectorXd::Zero(muscle_count())} {}

void GripEffort::look(const hand::Posture& posture, const std::array<bool, kGripJoints>& is_loaded,
                      std::vector<ThumbPress> presses, double wrist) {
  is_loaded_ = is_loaded;
  presses_ = std::move(presses);
  wrist_load_ = wrist;
  for (const ThumbPress& press : presses_) {
    for (int j = 0; j < kGripJoints; ++j) {
      if (press.moment[j] != 0.0) is_loaded_[j] = true;
    }
  }
  at_limit_.setZero();
  wrist_at_limit_.setZero();
  given_way_.setZero();
  stretch_stiffness_.setZero();
  Eigen::Index column = 0;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    const auto finger = static_cast<hand::Finger>(f);
    const auto count = static_cast<Eigen::Index>(hand::tendons_of(finger).size());
    const auto first = is_loaded_.begin() + hand::kDigitDofs * f;
    digits_[f].reset();
    if (std::any_of(first, first + hand::kDigitDofs, [](bool is) { return is; })) {
      digits_[f] = muscles_.in(finger, posture);
      stretch(posture, column, *digits_[f]);
      for (Eigen::Index t = 0; t < count; ++t) {
        const auto tendon = static_cast<std::size_t>(t);
        const double strength = limit_ * digits_[f]->strength[tendon];
        for (int k = 0; k < hand::kDigitDofs; ++k) {
          at_limit_(hand::kDigitDofs * f + k, column + t) = strength * digits_[f]->arm[tendon][k];
        }
        wrist_at_limit_[column + t] = strength * digits_[f]->wrist_arm[tendon].x();
      }
    }
    column += count;
  }
  const hand::WristMuscles& motors = muscles_.wrist();
  for (std::size_t i = 0; i < motors.arm.size(); ++i) {
    wrist_at_limit_[column + static_cast<Eigen::Index>(i)] =
        limit_ * motors.strength[i] * motors.arm[i].x();
  }
}

/// Muscles that are stretched where held angles give way hold more.
void GripEffort::stretch(const hand::Posture& posture, Eigen::Index first_muscle,
                         hand::DigitMuscles& digit) {
  const int first = hand::kDigitDofs * index_of(digit.finger);
  Eigen::Vector4d way = Eigen::Vector4d::Zero();
  for (int k = 0; k < hand::kDigitDofs; ++k) {
    if (is_free(first + k)) continue;
    const hand::Dof dof = grip_dof(first + k);
    way[k] = posture[dof] - closed_[dof];
  }
  given_way_.segment<hand::kDigitDofs>(first) = way;
  for (std::size_t t = 0; t < digit.arm.size(); ++t) {
    Eigen::Vector4d arm = Eigen::Map<const Eigen::Vector4d>(digit.arm[t].data());
    const double more = -kShortRange * arm.dot(way) / digit.fibre[t];
    const double rate = limit_ * digit.strength[t] * kShortRange / digit.fibre[t] *
                        now_.activation[first_muscle + static_cast<Eigen::Index>(t)];
    digit.strength[t] *= 1.0 + std::clamp(more, 0.0, kMostEnhanced);
    if (more < -kNoWay || more > kMostEnhanced) continue;
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      if (is_free(first + k)) arm[k] = 0.0;
    }
    stretch_stiffness_.block<hand::kDigitDofs, hand::kDigitDofs>(first, first) +=
        rate * arm * arm.transpose();
  }
}

bool GripEffort::is_judged(int joint) const {
  const auto& digit = digits_[index_of(grip_finger(joint))];
  return digit && is_loaded_[joint] && std::abs(digit->stop[joint % hand::kDigitDofs]) < 2;
}

void GripEffort::add_passive(GripVector& force, GripMatrix& stiffness) const {
  for (int f = 0; f < hand::kFingerCount; ++f) {
    if (!digits_[f]) continue;
    force.segment<hand::kDigitDofs>(hand::kDigitDofs * f) += digits_[f]->passive.moment;
    stiffness.block<hand::kDigitDofs, hand::kDigitDofs>(
        hand::kDigitDofs * f, hand::kDigitDofs * f) += digits_[f]->passive.stiffness;
  }
  stiffness.topLeftCorner<kGripJoints, kGripJoints>() += stretch_stiffness_;
  for (const ThumbPress& press : presses_) {
    force += press.force * press.moment;
    stiffness += press.stiffness * press.moment * press.moment.transpose();
  }
}

GripVector GripEffort::moments() const {
  GripVector result = now_.stops;
  result.head<kGripJoints>() += at_limit_ * now_.activation;
  return result;
}

double GripEffort::strongest() const {
  const Eigen::VectorXd moments = at_limit_ * now_.activation;
  double largest = 1e-9;
  for (int j = 0; j < kGripJoints; ++j) {
    if (is_judged(j)) largest = std::max(largest, std::abs(moments[j]));
  }
  return largest;
}

GripEffort::Step GripEffort::solve(const GripEquations& equations) {
  std::vector<int> held;
  for (int j = 0; j < kGripJoints; ++j) {
    if (!is_free(j) && is_judged(j)) held.push_back(j);
  }
  Eigen::VectorXi stop(static_cast<Eigen::Index>(held.size()));
  for (Eigen::Index i = 0; i < stop.size(); ++i) {
    const int j = held[static_cast<std::size_t>(i)];
    stop[i] = digits_[index_of(grip_finger(j))]->stop[j % hand::kDigitDofs];
  }
  const GripMuscles muscles{.at_limit = at_limit_,
                            .wrist_at_limit = wrist_at_limit_,
                            .wrist_load = wrist_load_,
                            .held = held,
                            .stop = stop,
                            .given_way = given_way_(held)};
  MuscleStep step(equations, muscles);
  step.solve();
  now_.activation = step.activation();
  now_.stops.setZero();
  for (Eigen::Index i = 0; i < stop.size(); ++i) {
    now_.stops[held[static_cast<std::size_t>(i)]] = step.stops()[i];
  }
  return {.way = step.way(), .is_short = step.is_squeeze_short()};
}

GripEffort::Strength GripEffort::strength_of(const GripVector& contact_force) const {
  GripVector moments = contact_force;
  for (const ThumbPress& press : presses_) moments += press.force * press.moment;
  Strength strength;
  strength.load.wrist = wrist_load_;
  std::vector<hand::DigitMuscles> digits;
  for (int f = 0; f < hand::kFingerCount; ++f) {
    for (int k = 0; k < hand::kDigitDofs; ++k) {
      strength.load.digit[f][k] = moments[hand::kDigitDofs * f + k];
    }
    if (digits_[f]) digits.push_back(*digits_[f]);
  }
  const double negligible =
      hand::kNegligibleMoment * moments.head<kGripJoints>().lpNorm<Eigen::Infinity>();
  const hand::MuscleProblem problem =
      hand::problem_of(digits, muscles_.wrist(), strength.load, limit_);
  strength.share = hand::least_strength_share(problem, negligible);
  hand::MuscleProblem fingers = problem;
  const Eigen::Index angles = problem.required.size() - 1;
  fingers.moment_at_strength = problem.moment_at_strength.topRows(angles);
  fingers.required = problem.required.head(angles);
  fingers.stop = problem.stop.head(angles);
  strength.is_by_wrist =
      strength.share > kByWrist * hand::least_strength_share(fingers, negligible);
  return strength;
}

}  // namespace palmar::grasp
