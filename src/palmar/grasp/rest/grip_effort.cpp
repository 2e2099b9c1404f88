// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/grip_effort.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/core/enum_index.h"

namespace palmar {
namespace {

constexpr double kHeldPrice = 0.01;    // of what is missing, against that of the squeeze
constexpr double kPlacePrice = 0.001;  // of the product's way
// A wrist that can't hold fells the grip: it goes before everything.
constexpr double kWristPrice = 100.0;
constexpr double kByWrist = 1.02;        // of the share of fingers alone; more is the wrist's
constexpr double kMostGivingWay = 0.05;  // rad in one step
constexpr double kNoWay = 1e-6;          // rad
constexpr int kHalvings = 3;
/// Force that a muscle gains per stretch over its fibres' length, over its force: short-range
/// stiffness (Cui, Perreault, Maas & Sandercock 2008, J Biomech 41:1945-1952).
constexpr double kShortRange = 23.4;
/// The most that a stretched muscle holds above its isometric force: first dorsal interosseous of
/// people after the stretch (Cook & McDonagh 1995, Exp Physiol 80:477-490).
constexpr double kMostEnhanced = 0.3;
constexpr int kSweeps = 20;              // over at most nine angles; more changed no step count
constexpr double kWayBeyondReach = 1.1;  // of what all muscles together could add, to ask for all

int muscle_count() {
  int count = kWristMuscleCount;
  for (int f = 0; f < kFingerCount; ++f) {
    count += static_cast<int>(tendons_of(static_cast<Finger>(f)).size());
  }
  return count;
}

/// x with A x = b as far as no |x_i| above `most` is needed: Gauss-Seidel sweeps with each unknown
/// held within its bounds, so that the others know of those that have come to them.
Eigen::VectorXd bounded_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double most) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(b.size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const double rest = b[i] - A.row(i).dot(x) + A(i, i) * x[i];
      x[i] = std::clamp(rest / A(i, i), -most, most);
    }
  }
  return x;
}

}  // namespace

GripEffort::GripEffort(const Hand& hand, double limit, const Posture& closed,
                       const WristPosture& wrist)
    : muscles_(hand, {.wrist = wrist}),
      closed_(closed),
      limit_(limit),
      at_limit_(Eigen::MatrixXd::Zero(kGripJoints, muscle_count())),
      wrist_at_limit_(Eigen::RowVectorXd::Zero(muscle_count())),
      now_{.activation = Eigen::VectorXd::Zero(muscle_count())} {}

void GripEffort::look(const Posture& posture, const std::array<bool, kGripJoints>& is_loaded,
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
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    const auto count = static_cast<Eigen::Index>(tendons_of(finger).size());
    const auto first = is_loaded_.begin() + kDigitDofs * f;
    digits_[f].reset();
    if (std::any_of(first, first + kDigitDofs, [](bool is) { return is; })) {
      digits_[f] = muscles_.in(finger, posture);
      stretch(posture, column, *digits_[f]);
      for (Eigen::Index t = 0; t < count; ++t) {
        const auto tendon = static_cast<std::size_t>(t);
        const double strength = limit_ * digits_[f]->strength[tendon];
        for (int k = 0; k < kDigitDofs; ++k) {
          at_limit_(kDigitDofs * f + k, column + t) = strength * digits_[f]->arm[tendon][k];
        }
        wrist_at_limit_[column + t] = strength * digits_[f]->wrist_arm[tendon].x();
      }
    }
    column += count;
  }
  const WristMuscles& motors = muscles_.wrist();
  for (std::size_t i = 0; i < motors.arm.size(); ++i) {
    wrist_at_limit_[column + static_cast<Eigen::Index>(i)] =
        limit_ * motors.strength[i] * motors.arm[i].x();
  }
}

/// Muscles that are stretched where held angles give way hold more.
void GripEffort::stretch(const Posture& posture, Eigen::Index first_muscle, DigitMuscles& digit) {
  const int first = kDigitDofs * index_of(digit.finger);
  Eigen::Vector4d way = Eigen::Vector4d::Zero();
  for (int k = 0; k < kDigitDofs; ++k) {
    if (is_free(first + k)) continue;
    const Dof dof = grip_dof(first + k);
    way[k] = posture[dof] - closed_[dof];
  }
  given_way_.segment<kDigitDofs>(first) = way;
  for (std::size_t t = 0; t < digit.arm.size(); ++t) {
    Eigen::Vector4d arm = Eigen::Map<const Eigen::Vector4d>(digit.arm[t].data());
    const double more = -kShortRange * arm.dot(way) / digit.fibre[t];
    const double rate = limit_ * digit.strength[t] * kShortRange / digit.fibre[t] *
                        now_.activation[first_muscle + static_cast<Eigen::Index>(t)];
    digit.strength[t] *= 1.0 + std::clamp(more, 0.0, kMostEnhanced);
    if (more < -kNoWay || more > kMostEnhanced) continue;
    for (int k = 0; k < kDigitDofs; ++k) {
      if (is_free(first + k)) arm[k] = 0.0;
    }
    stretch_stiffness_.block<kDigitDofs, kDigitDofs>(first, first) += rate * arm * arm.transpose();
  }
}

bool GripEffort::is_judged(int joint) const {
  const auto& digit = digits_[index_of(grip_finger(joint))];
  return digit && is_loaded_[joint] && std::abs(digit->stop[joint % kDigitDofs]) < 2;
}

void GripEffort::add_passive(GripVector& force, GripMatrix& stiffness) const {
  for (int f = 0; f < kFingerCount; ++f) {
    if (!digits_[f]) continue;
    force.segment<kDigitDofs>(kDigitDofs * f) += digits_[f]->passive.moment;
    stiffness.block<kDigitDofs, kDigitDofs>(kDigitDofs * f, kDigitDofs * f) +=
        digits_[f]->passive.stiffness;
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

GripEffort::Step GripEffort::solve(const std::vector<int>& free, const Eigen::MatrixXd& k,
                                   const GripVector& force, const GripMatrix& stiffness,
                                   const GripVector& squeeze, std::optional<double> missing,
                                   const Vec3* moved_before) {
  std::vector<int> held;
  for (int j = 0; j < kGripJoints; ++j) {
    if (!is_free(j) && is_judged(j)) held.push_back(j);
  }
  const auto free_count = static_cast<Eigen::Index>(free.size());
  const auto held_count = static_cast<Eigen::Index>(held.size());
  const Eigen::Index muscles = at_limit_.cols();
  // What a full activation of each muscle, and the forces as they are, move the free coordinates.
  Eigen::MatrixXd by_muscle = Eigen::MatrixXd::Zero(free_count, muscles);
  for (Eigen::Index i = 0; i < free_count; ++i) {
    const int j = free[static_cast<std::size_t>(i)];
    if (j < kGripJoints) by_muscle.row(i) = at_limit_.row(j);
  }
  const Eigen::PartialPivLU<Eigen::MatrixXd> factor(k);
  by_muscle = factor.solve(by_muscle).eval();
  const Eigen::VectorXd by_force = factor.solve(Eigen::VectorXd(force(free)));
  const Eigen::MatrixXd between = stiffness(held, free);
  const Eigen::VectorXd along = squeeze(free);
  const Eigen::RowVectorXd gain = along.transpose() * by_muscle;

  const Eigen::Index kept = moved_before != nullptr ? 3 : 0;
  // Rows: held angles, the squeeze, the wrist, the product's place.
  const Eigen::Index rows = held_count + 2 + kept;
  MuscleProblem problem{.moment_at_strength = Eigen::MatrixXd(rows, muscles),
                        .required = Eigen::VectorXd(rows),
                        .stop = Eigen::VectorXi::Zero(rows),
                        .exponent = 3,
                        .price = Eigen::VectorXd::Constant(rows, kHeldPrice)};
  problem.moment_at_strength.topRows(held_count) =
      at_limit_(held, Eigen::all) - between * by_muscle;
  for (Eigen::Index i = 0; i < held_count; ++i) {
    const int j = held[static_cast<std::size_t>(i)];
    problem.stop[i] = digits_[index_of(grip_finger(j))]->stop[j % kDigitDofs];
  }
  problem.moment_at_strength.row(held_count) = gain;
  problem.price[held_count] = 1.0;
  problem.moment_at_strength.row(held_count + 1) = wrist_at_limit_;
  problem.price[held_count + 1] = kWristPrice;
  if (kept > 0) {
    // The product's translation is the first of its six coordinates, which come last.
    problem.moment_at_strength.bottomRows(3) = by_muscle.middleRows(free_count - 6, 3);
    problem.price.tail<3>().setConstant(kPlacePrice);
  }
  // Held angles go `giving`; the forces that move the free coordinates change with that.
  const Eigen::MatrixXd follow = factor.solve(Eigen::MatrixXd(stiffness(free, held)));
  Eigen::VectorXd giving = Eigen::VectorXd::Zero(held_count);
  Eigen::VectorXd moved_by_force = by_force;
  const auto balance = [&] {
    moved_by_force = by_force - follow * giving;
    problem.required.head(held_count) =
        between * moved_by_force - Eigen::VectorXd(force(held)) + stiffness(held, held) * giving;
    problem.required[held_count] =
        missing ? *missing - along.dot(moved_by_force) - Eigen::VectorXd(squeeze(held)).dot(giving)
                : kWayBeyondReach * gain.cwiseMax(0.0).sum();
    problem.required[held_count + 1] = -wrist_load_;
    if (kept > 0) {
      problem.required.tail<3>() = -*moved_before - moved_by_force.segment<3>(free_count - 6);
    }
    return balance_muscles(problem);
  };
  // Those that their muscles leave short go so far that these suffice.
  const auto give_way = [&](const Eigen::VectorXd& lacking) {
    std::vector<int> row;
    for (Eigen::Index i = 0; i < held_count; ++i) {
      if (lacking[i] != 0.0) row.push_back(static_cast<int>(i));
    }
    if (row.empty()) return false;
    Eigen::MatrixXd own = Eigen::MatrixXd(stiffness(held, held))(row, row);
    const Eigen::VectorXd least = 0.1 * own.diagonal().array() + 1.0;
    own -= between(row, Eigen::all) * follow(Eigen::all, row);
    own.diagonal() = own.diagonal().cwiseMax(least);
    giving(row) += bounded_solution(own, -lacking(row), kMostGivingWay);
    return true;
  };
  MuscleSolution solution = balance();
  const bool gives_way = give_way(solution.missing.head(held_count));
  if (gives_way) solution = balance();

  // Those that gave way before come back as far as the muscles can bring them.
  Eigen::VectorXd back = Eigen::VectorXd::Zero(held_count);
  for (Eigen::Index i = 0; i < held_count; ++i) {
    back[i] =
        std::clamp(-given_way_[held[static_cast<std::size_t>(i)]], -kMostGivingWay, kMostGivingWay);
  }
  if (!gives_way && !back.isZero(kNoWay)) {
    const MuscleSolution here = solution;
    const Eigen::VectorXi stops = problem.stop;
    for (Eigen::Index i = 0; i < held_count; ++i) {
      if (back[i] * problem.stop[i] > 0.0) problem.stop[i] = 0;  // leaves its stop
    }
    giving = back;
    solution = balance();
    if (give_way(solution.missing.head(held_count))) {
      giving = giving.cwiseMax(back.cwiseMin(0.0)).cwiseMin(back.cwiseMax(0.0));
      back = giving;
      solution = balance();
    }
    double share = 1.0;
    for (int i = 0; i < kHalvings && !solution.missing.head(held_count).isZero(0.0); ++i) {
      share *= 0.5;
      giving = share * back;
      solution = balance();
    }
    if (!solution.missing.head(held_count).isZero(0.0)) {
      giving.setZero();
      problem.stop = stops;
      balance();
      solution = here;
    }
  }

  now_.activation = solution.activation;
  now_.stops.setZero();
  Step step;
  step.is_short = solution.missing[held_count] > 0.0;
  for (Eigen::Index i = 0; i < held_count; ++i) {
    const int j = held[static_cast<std::size_t>(i)];
    now_.stops[j] = solution.stop[i];
    step.way[j] = giving[i];
  }
  const Eigen::VectorXd moved = by_muscle * now_.activation + moved_by_force;
  for (Eigen::Index i = 0; i < free_count; ++i) {
    step.way[free[static_cast<std::size_t>(i)]] = moved[i];
  }
  return step;
}

GripEffort::Strength GripEffort::strength_of(const GripVector& contact_force) const {
  GripVector moments = contact_force;
  for (const ThumbPress& press : presses_) moments += press.force * press.moment;
  Strength strength;
  strength.load.wrist = wrist_load_;
  std::vector<DigitMuscles> digits;
  for (int f = 0; f < kFingerCount; ++f) {
    for (int k = 0; k < kDigitDofs; ++k) {
      strength.load.digit[f][k] = moments[kDigitDofs * f + k];
    }
    if (digits_[f]) digits.push_back(*digits_[f]);
  }
  const double negligible =
      kNegligibleMoment * moments.head<kGripJoints>().lpNorm<Eigen::Infinity>();
  const MuscleProblem problem = problem_of(digits, muscles_.wrist(), strength.load, limit_);
  strength.share = least_strength_share(problem, negligible);
  MuscleProblem fingers = problem;
  const Eigen::Index angles = problem.required.size() - 1;
  fingers.moment_at_strength = problem.moment_at_strength.topRows(angles);
  fingers.required = problem.required.head(angles);
  fingers.stop = problem.stop.head(angles);
  strength.is_by_wrist = strength.share > kByWrist * least_strength_share(fingers, negligible);
  return strength;
}

}  // namespace palmar
