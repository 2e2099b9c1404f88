// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/muscle_step.h"

#include <algorithm>

namespace palmar::grasp {
namespace {

constexpr double kHeldPrice = 0.01;    // of what is missing, against that of the squeeze
constexpr double kPlacePrice = 0.001;  // of the product's way
// A wrist that can't hold fells the grip: it goes before everything.
constexpr double kWristPrice = 100.0;
constexpr double kMostGivingWay = 0.05;  // rad in one step
constexpr int kHalvings = 3;
constexpr int kSweeps = 20;              // over at most nine angles; more changed no step count
constexpr double kWayBeyondReach = 1.1;  // of what all muscles together could add, to ask for all

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

MuscleStep::MuscleStep(const GripEquations& equations, const GripMuscles& muscles)
    : equations_(equations),
      muscles_(muscles),
      free_count_(static_cast<Eigen::Index>(equations.free.size())),
      held_count_(static_cast<Eigen::Index>(muscles.held.size())),
      factor_(equations.k),
      by_muscle_(Eigen::MatrixXd::Zero(free_count_, muscles.at_limit.cols())),
      between_(equations.stiffness(muscles.held, equations.free)),
      giving_(Eigen::VectorXd::Zero(held_count_)) {
  for (Eigen::Index i = 0; i < free_count_; ++i) {
    const int j = equations.free[static_cast<std::size_t>(i)];
    if (j < kGripJoints) by_muscle_.row(i) = muscles.at_limit.row(j);
  }
  by_muscle_ = factor_.solve(by_muscle_).eval();
  by_force_ = factor_.solve(Eigen::VectorXd(equations.force(equations.free)));
  follow_ = factor_.solve(Eigen::MatrixXd(equations.stiffness(equations.free, muscles.held)));

  const Eigen::Index kept = equations.moved != nullptr ? 3 : 0;
  const Eigen::Index rows = held_count_ + 2 + kept;
  problem_ = {.moment_at_strength = Eigen::MatrixXd(rows, muscles.at_limit.cols()),
              .required = Eigen::VectorXd(rows),
              .stop = Eigen::VectorXi::Zero(rows),
              .exponent = 3,
              .price = Eigen::VectorXd::Constant(rows, kHeldPrice)};
  problem_.moment_at_strength.topRows(held_count_) =
      muscles.at_limit(muscles.held, Eigen::all) - between_ * by_muscle_;
  problem_.stop.head(held_count_) = muscles.stop;
  problem_.moment_at_strength.row(held_count_) =
      Eigen::VectorXd(equations.squeeze(equations.free)).transpose() * by_muscle_;
  problem_.price[held_count_] = 1.0;
  problem_.moment_at_strength.row(held_count_ + 1) = muscles.wrist_at_limit;
  problem_.price[held_count_ + 1] = kWristPrice;
  if (kept > 0) {
    // The product's translation is the first of its six coordinates.
    problem_.moment_at_strength.bottomRows(3) = by_muscle_.middleRows(free_count_ - 6, 3);
    problem_.price.tail<3>().setConstant(kPlacePrice);
  }
}

/// Asks the muscles with the held angles going their way; the forces that move the free coordinates
/// change with that.
void MuscleStep::balance() {
  const GripEquations& e = equations_;
  const std::vector<int>& held = muscles_.held;
  moved_by_force_ = by_force_ - follow_ * giving_;
  problem_.required.head(held_count_) = between_ * moved_by_force_ -
                                        Eigen::VectorXd(e.force(held)) +
                                        e.stiffness(held, held) * giving_;
  problem_.required[held_count_] =
      e.missing
          ? *e.missing - Eigen::VectorXd(e.squeeze(e.free)).dot(moved_by_force_) -
                Eigen::VectorXd(e.squeeze(held)).dot(giving_)
          : kWayBeyondReach * problem_.moment_at_strength.row(held_count_).cwiseMax(0.0).sum();
  problem_.required[held_count_ + 1] = -muscles_.wrist_load;
  if (e.moved != nullptr) {
    problem_.required.tail<3>() = -*e.moved - moved_by_force_.segment<3>(free_count_ - 6);
  }
  solution_ = hand::balance_muscles(problem_);
}

/// Held angles that their muscles leave short go so far that these suffice. False if there are
/// none.
bool MuscleStep::give_way() {
  const auto lacking = solution_.missing.head(held_count_);
  std::vector<int> row;
  for (Eigen::Index i = 0; i < held_count_; ++i) {
    if (lacking[i] != 0.0) row.push_back(static_cast<int>(i));
  }
  if (row.empty()) return false;
  const std::vector<int>& held = muscles_.held;
  Eigen::MatrixXd own = Eigen::MatrixXd(equations_.stiffness(held, held))(row, row);
  const Eigen::VectorXd least = 0.1 * own.diagonal().array() + 1.0;
  own -= between_(row, Eigen::all) * follow_(Eigen::all, row);
  own.diagonal() = own.diagonal().cwiseMax(least);
  giving_(row) += bounded_solution(own, -lacking(row), kMostGivingWay);
  return true;
}

/// Held angles go `back`, or the part of that way on which their muscles bring them; if there is
/// none, the step stays as it was.
void MuscleStep::come_back(Eigen::VectorXd back) {
  const hand::MuscleSolution here = solution_;
  for (Eigen::Index i = 0; i < held_count_; ++i) {
    if (back[i] * problem_.stop[i] > 0.0) problem_.stop[i] = 0;  // leaves its stop
  }
  giving_ = back;
  balance();
  if (give_way()) {
    giving_ = giving_.cwiseMax(back.cwiseMin(0.0)).cwiseMin(back.cwiseMax(0.0));
    back = giving_;
    balance();
  }
  double share = 1.0;
  for (int i = 0; i < kHalvings && !is_held(); ++i) {
    share *= 0.5;
    giving_ = share * back;
    balance();
  }
  if (is_held()) return;
  giving_.setZero();
  moved_by_force_ = by_force_;
  solution_ = here;
}

void MuscleStep::solve() {
  balance();
  if (give_way()) {
    balance();
    return;
  }
  const Eigen::VectorXd back =
      (-muscles_.given_way).cwiseMax(-kMostGivingWay).cwiseMin(kMostGivingWay);
  if (!back.isZero(kNoWay)) come_back(back);
}

GripVector MuscleStep::way() const {
  GripVector way = GripVector::Zero();
  for (Eigen::Index i = 0; i < held_count_; ++i) {
    way[muscles_.held[static_cast<std::size_t>(i)]] = giving_[i];
  }
  const Eigen::VectorXd moved = by_muscle_ * solution_.activation + moved_by_force_;
  for (Eigen::Index i = 0; i < free_count_; ++i) {
    way[equations_.free[static_cast<std::size_t>(i)]] = moved[i];
  }
  return way;
}

}  // namespace palmar::grasp
