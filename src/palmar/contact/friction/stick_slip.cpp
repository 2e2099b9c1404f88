// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "palmar/contact/friction/friction_balance.h"
#include "palmar/contact/friction/friction_problem.h"
#include "palmar/contact/response/tangential_response.h"
#include "palmar/core/parallel.h"

namespace palmar::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

/// The patches of one body with their energy Q (b_i b_j C_ij), in units of the mean diagonal of C.
struct Body {
  std::vector<int> patch;
  MatrixXd energy;    // 2 n x 2 n
  MatrixXd factor;    // of energy + barrier
  MatrixXd solution;  // of factor solution = [rhs, jacobian]
  bool is_definite = true;
};

std::vector<Body> bodies_of(const std::vector<RubbingPatch>& patches) {
  std::map<int, std::vector<int>> members;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    members[patches[i].body].push_back(static_cast<int>(i));
  }
  std::vector<Body> bodies;
  for (auto& [name, list] : members) bodies.emplace_back().patch = std::move(list);
  return bodies;
}

void fill_energy(const std::vector<RubbingPatch>& patches, const FrictionBalance& balance,
                 Body& body) {
  const auto n = static_cast<Index>(body.patch.size());
  std::vector<Eigen::Matrix<double, 3, 2>> base;  // at rest, with limit and modulus
  for (const int i : body.patch) {
    const RubbingPatch& patch = patches[i];
    base.emplace_back(
        patch.limit / std::sqrt(patch.shear_modulus) *
        (patch.contact_from_rest.conjugate().toRotationMatrix() * balance.tangent[i]));
  }
  body.energy.resize(2 * n, 2 * n);
  for (Index j = 0; j < n; ++j) {
    const RubbingPatch& pj = patches[body.patch[j]];
    for (Index i = j; i < n; ++i) {
      const RubbingPatch& pi = patches[body.patch[i]];
      const Eigen::Matrix2d block = base[i].transpose() *
                                    tangential_response(pi.rest - pj.rest, pi.radius, pj.radius) *
                                    base[j];
      body.energy.block<2, 2>(2 * i, 2 * j) = block;
      body.energy.block<2, 2>(2 * j, 2 * i) = block.transpose();
    }
  }
}

/// Q y.
VectorXd apply_energy(const std::vector<Body>& bodies, const VectorXd& y) {
  VectorXd result(y.size());
  parallel_for(static_cast<int>(bodies.size()), [&](int b) {
    const Body& body = bodies[b];
    const auto n = static_cast<Index>(body.patch.size());
    VectorXd own(2 * n);
    for (Index k = 0; k < n; ++k) own.segment<2>(2 * k) = y.segment<2>(2 * Index{body.patch[k]});
    const VectorXd product = body.energy * own;
    for (Index k = 0; k < n; ++k) {
      result.segment<2>(2 * Index{body.patch[k]}) = product.segment<2>(2 * k);
    }
  });
  return result;
}

/// Unknowns of the interior-point method: y in the discs, their multipliers (> 0), and the motion.
struct State {
  VectorXd y, multiplier, motion;
  VectorXd energy_y;  // Q y
};

class InteriorPoint {
 public:
  InteriorPoint(const FrictionBalance& balance, std::vector<Body>& bodies, State state)
      : balance_(balance), bodies_(bodies), state_(std::move(state)) {}

  /// One step; false where no further progress is possible.
  bool step();
  const State& state() const { return state_; }
  VectorXd elastic_misfit(const State& s) const;
  /// sum of multiplier * slack: twice the energy that the answer may lie above the minimum
  double complementarity(const State& s) const;

 private:
  static double slack(const VectorXd& y, Index i) {
    return 0.5 * (1.0 - y.segment<2>(2 * i).squaredNorm());
  }
  double residual(const State& s, double centre) const;
  bool factorise(const VectorXd& rhs);

  const FrictionBalance& balance_;
  std::vector<Body>& bodies_;
  State state_;
};

VectorXd InteriorPoint::elastic_misfit(const State& s) const {
  VectorXd misfit = s.energy_y + balance_.jacobian * s.motion;
  for (Index i = 0; i < s.multiplier.size(); ++i) {
    misfit.segment<2>(2 * i) += s.multiplier[i] * s.y.segment<2>(2 * i);
  }
  return misfit;
}

double InteriorPoint::complementarity(const State& s) const {
  double sum = 0.0;
  for (Index i = 0; i < s.multiplier.size(); ++i) sum += s.multiplier[i] * slack(s.y, i);
  return sum;
}

double InteriorPoint::residual(const State& s, double centre) const {
  double sum = elastic_misfit(s).squaredNorm() +
               (balance_.jacobian.transpose() * s.y + balance_.load).squaredNorm();
  for (Index i = 0; i < s.multiplier.size(); ++i) {
    const double r = s.multiplier[i] * slack(s.y, i) - centre;
    sum += r * r;
  }
  return std::sqrt(sum);
}

/// Solves (Q + barrier) [a, B] = [rhs, jacobian] body by body into Body::solution.
bool InteriorPoint::factorise(const VectorXd& rhs) {
  parallel_for(static_cast<int>(bodies_.size()), [&](int b) {
    Body& body = bodies_[b];
    const auto n = static_cast<Index>(body.patch.size());
    body.factor = body.energy;
    body.solution.resize(2 * n, 1 + balance_.jacobian.cols());
    for (Index k = 0; k < n; ++k) {
      const Index i = body.patch[k];
      const Vector2d y = state_.y.segment<2>(2 * i);
      const double multiplier = state_.multiplier[i];
      body.factor.block<2, 2>(2 * k, 2 * k) += multiplier * Eigen::Matrix2d::Identity() +
                                               multiplier / slack(state_.y, i) * y * y.transpose();
      body.solution.middleRows<2>(2 * k) << rhs.segment<2>(2 * i),
          balance_.jacobian.middleRows<2>(2 * i);
    }
    const Eigen::LLT<Eigen::Ref<MatrixXd>> cholesky(body.factor);
    body.is_definite = cholesky.info() == Eigen::Success;
    if (body.is_definite) cholesky.solveInPlace(body.solution);
  });
  return std::all_of(bodies_.begin(), bodies_.end(), [](const Body& b) { return b.is_definite; });
}

bool InteriorPoint::step() {
  constexpr double kCentring = 0.1;
  const Index m = state_.multiplier.size();
  const Index k = balance_.jacobian.cols();
  const double centre = kCentring * complementarity(state_) / static_cast<double>(m);
  VectorXd rhs = -(state_.energy_y + balance_.jacobian * state_.motion);
  for (Index i = 0; i < m; ++i) {
    rhs.segment<2>(2 * i) -= centre / slack(state_.y, i) * state_.y.segment<2>(2 * i);
  }
  if (!factorise(rhs)) return false;
  VectorXd free_step(2 * m);
  MatrixXd per_motion(2 * m, k);
  for (const Body& body : bodies_) {
    for (std::size_t p = 0; p < body.patch.size(); ++p) {
      const auto row = static_cast<Index>(2 * p);
      free_step.segment<2>(2 * Index{body.patch[p]}) = body.solution.block<2, 1>(row, 0);
      per_motion.middleRows<2>(2 * Index{body.patch[p]}) = body.solution.block(row, 1, 2, k);
    }
  }
  const MatrixXd& j = balance_.jacobian;
  const VectorXd miss = j.transpose() * state_.y + balance_.load;
  const VectorXd motion_step =
      Eigen::LDLT<MatrixXd>(j.transpose() * per_motion).solve(j.transpose() * free_step + miss);
  const VectorXd y_step = free_step - per_motion * motion_step;
  VectorXd multiplier_step(m);
  double share = 1.0;  // what keeps the multipliers positive and the forces inside the discs
  for (Index i = 0; i < m; ++i) {
    const Vector2d y = state_.y.segment<2>(2 * i), d = y_step.segment<2>(2 * i);
    const double room = slack(state_.y, i);
    multiplier_step[i] = -state_.multiplier[i] + (centre + state_.multiplier[i] * y.dot(d)) / room;
    if (multiplier_step[i] < 0.0) {
      share = std::min(share, -0.99 * state_.multiplier[i] / multiplier_step[i]);
    }
    const double a = d.squaredNorm(), b = y.dot(d);
    if (a > 0.0)
      share = std::min(share, 0.99 * 2.0 * room / (b + std::sqrt(b * b + 2.0 * a * room)));
  }
  if (!std::isfinite(share)) return false;

  const VectorXd energy_step = apply_energy(bodies_, y_step);
  const double now = residual(state_, centre);
  for (int halving = 0; halving < 30; ++halving, share *= 0.5) {
    const State next{state_.y + share * y_step, state_.multiplier + share * multiplier_step,
                     state_.motion + share * motion_step, state_.energy_y + share * energy_step};
    if (residual(next, centre) <= (1.0 - 0.01 * share) * now) {
      state_ = next;
      return true;
    }
  }
  return false;
}

}  // namespace

StickSlip solve_stick_slip(const std::vector<RubbingPatch>& patches, const Wrench& load,
                           const HoldingLimit& limit) {
  constexpr int kMostSteps = 80;
  constexpr double kComplementarity = 1e-8;  // of twice the elastic energy
  constexpr double kMisfit = 1e-7;           // of the displacements
  StickSlip result;
  result.force.assign(patches.size(), Vec3::Zero());
  result.slip.assign(patches.size(), 0.0);
  if (load.force.isZero(0.0) && load.moment.isZero(0.0)) {
    result.has_converged = true;
    return result;
  }
  if (!(limit.factor > 1.0)) return result;

  const FrictionBalance balance = friction_balance(patches, load);
  std::vector<Body> bodies = bodies_of(patches);
  parallel_for(static_cast<int>(bodies.size()),
               [&](int b) { fill_energy(patches, balance, bodies[b]); });
  double unit_energy = 0.0;  // N mm
  for (const Body& body : bodies) unit_energy += body.energy.trace();
  unit_energy /= static_cast<double>(patches.size());
  for (Body& body : bodies) body.energy /= unit_energy;

  const auto m = static_cast<Index>(patches.size());
  State start{VectorXd(2 * m), VectorXd(m), VectorXd::Zero(balance.load.size()), VectorXd()};
  for (Index i = 0; i < m; ++i) {
    start.y.segment<2>(2 * i) =
        balance.tangent[i].transpose() * limit.force[i] / (limit.factor * patches[i].limit);
  }
  start.energy_y = apply_energy(bodies, start.y);
  const double per_patch = start.y.dot(start.energy_y) / static_cast<double>(m);
  for (Index i = 0; i < m; ++i) {
    start.multiplier[i] = 2.0 * per_patch / (1.0 - start.y.segment<2>(2 * i).squaredNorm());
  }
  InteriorPoint method(balance, bodies, std::move(start));
  const auto is_done = [&] {
    const State& s = method.state();
    return method.complementarity(s) <= kComplementarity * s.y.dot(s.energy_y) &&
           method.elastic_misfit(s).norm() <= kMisfit * s.energy_y.norm();
  };
  while (!is_done() && result.iterations < kMostSteps && method.step()) ++result.iterations;
  result.has_converged = is_done();

  const State& s = method.state();
  const VectorXd misfit = method.elastic_misfit(s);
  for (Index i = 0; i < m; ++i) {
    result.force[i] = patches[i].limit * (balance.tangent[i] * s.y.segment<2>(2 * i));
    const double length = unit_energy / patches[i].limit;  // mm per unit of displacement
    result.slip[i] = length * s.multiplier[i] * s.y.segment<2>(2 * i).norm();
    result.elastic_error = std::max(result.elastic_error, length * misfit.segment<2>(2 * i).norm());
  }
  result.motion =
      balance.motion(balance.base_of_motions * s.motion, unit_energy / balance.unit_force);
  result.balance_error = balance_error(balance, patches, load, result.force);
  return result;
}

}  // namespace palmar::contact
