// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/contact/friction/friction_balance.h"
#include "palmar/contact/friction/friction_problem.h"

namespace palmar::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

Eigen::Matrix<double, 3, 2> tangent_base(const Vec3& normal) {
  Index least = 0;
  normal.cwiseAbs().minCoeff(&least);
  Eigen::Matrix<double, 3, 2> base;
  base.col(0) = normal.cross(Vec3::Unit(least)).normalized();
  base.col(1) = normal.cross(base.col(0));
  return base;
}

Eigen::Matrix3d cross_matrix(const Vec3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// State of the barrier method: y within the discs and the factor s, in balance.
struct Barrier {
  const FrictionBalance& balance;
  VectorXd direction;  // of the load, unit
  VectorXd y;
  double s = 0.0;
  VectorXd motion;  // multiplier of the balance

  double slack(Index i) const { return 1.0 - y.segment<2>(2 * i).squaredNorm(); }
  double merit(const VectorXd& at, double factor, double tau) const {
    double value = -tau * factor;
    for (Index i = 0; i < balance.patch_count(); ++i) {
      const double room = 1.0 - at.segment<2>(2 * i).squaredNorm();
      if (!(room > 0.0)) return std::numeric_limits<double>::infinity();
      value -= std::log(room);
    }
    return value;
  }
  /// Upper bound of s from the current motion.
  double upper() const {
    const double power = direction.dot(motion);
    if (!(power > 0.0)) return std::numeric_limits<double>::infinity();
    double dissipated = 0.0;
    for (int i = 0; i < balance.patch_count(); ++i) {
      dissipated += (balance.rows(i) * motion).norm();
    }
    return dissipated / power;
  }
  /// One damped Newton step towards the centre for `tau`; its decrement squared, < 0 if stuck.
  double step(double tau);
};

double Barrier::step(double tau) {
  const int m = balance.patch_count();
  const MatrixXd& j = balance.jacobian;
  // Inverse of the Hessian 2 / r I + 4 / r^2 y y^T of -log r, r = 1 - |y|^2, and the gradient 2 y /
  // r.
  MatrixXd inverse_j(j.rows(), j.cols());
  VectorXd inverse_gradient(j.rows());
  for (Index i = 0; i < m; ++i) {
    const Vector2d yi = y.segment<2>(2 * i);
    const double room = slack(i);
    const Eigen::Matrix2d inverse =
        0.5 * room * (Eigen::Matrix2d::Identity() - 2.0 / (2.0 - room) * yi * yi.transpose());
    inverse_j.middleRows<2>(2 * i).noalias() = inverse * j.middleRows<2>(2 * i);
    inverse_gradient.segment<2>(2 * i) = inverse * (2.0 / room * yi);
  }
  const VectorXd miss = j.transpose() * y + s * direction;
  const VectorXd h = miss - j.transpose() * inverse_gradient;
  const Eigen::LDLT<MatrixXd> schur(j.transpose() * inverse_j);
  const VectorXd schur_h = schur.solve(h), schur_w = schur.solve(direction);
  const double curvature = direction.dot(schur_w);
  if (!(curvature > 0.0)) return -1.0;
  const double ds = (tau - direction.dot(schur_h)) / curvature;
  motion = schur_w * ds + schur_h;
  const VectorXd dy = -(inverse_gradient + inverse_j * motion);

  double decrement = 0.0;  // -(gradient of the merit) . step
  double longest = 1.0;    // largest share of the step inside the discs
  for (Index i = 0; i < m; ++i) {
    const Vector2d yi = y.segment<2>(2 * i), di = dy.segment<2>(2 * i);
    decrement -= 2.0 / slack(i) * yi.dot(di);
    const double a = di.squaredNorm(), b = yi.dot(di);
    if (a > 0.0)
      longest = std::min(longest, 0.95 * slack(i) / (b + std::sqrt(b * b + a * slack(i))));
  }
  decrement += tau * ds;
  if (!std::isfinite(decrement)) return -1.0;
  const double now = merit(y, s, tau);
  double share = longest;
  for (int halving = 0; halving < 40; ++halving, share *= 0.5) {
    if (merit(y + share * dy, s + share * ds, tau) <= now - 0.1 * share * decrement) {
      y += share * dy;
      s += share * ds;
      return std::max(decrement, 0.0);
    }
  }
  return -1.0;
}

/// Scaled so that the fastest patch moves by 1 mm.
SmallMotion fastest_by_one(SmallMotion motion, const std::vector<RubbingPatch>& patches) {
  double fastest = 0.0;
  for (const RubbingPatch& patch : patches) {
    fastest = std::max(fastest, motion.at(patch.position).norm());
  }
  if (fastest > 0.0) {
    motion.translation /= fastest;
    motion.rotation /= fastest;
  }
  return motion;
}

}  // namespace

SmallMotion FrictionBalance::motion(const Vector6& generalised, double scale) const {
  return {scale * generalised.head<3>(), scale / length * generalised.tail<3>(), centre};
}

FrictionBalance friction_balance(const std::vector<RubbingPatch>& patches, const Wrench& load) {
  FrictionBalance balance;
  const auto m = static_cast<Index>(patches.size());
  double sum = 0.0;
  for (const RubbingPatch& patch : patches) {
    sum += patch.limit;
    balance.centre += patch.limit * patch.position;
  }
  if (!(sum > 0.0)) return balance;
  balance.unit_force = sum;
  balance.centre /= sum;
  double spread = 0.0;
  for (const RubbingPatch& patch : patches) {
    spread += patch.limit * (patch.position - balance.centre).squaredNorm();
  }
  balance.length = std::sqrt(spread / sum);
  if (!(balance.length > 0.0)) balance.length = 1.0;

  MatrixXd all(2 * m, 6);
  Matrix6 felt = Matrix6::Zero();
  for (Index i = 0; i < m; ++i) {
    const RubbingPatch& patch = patches[i];
    const Eigen::Matrix<double, 3, 2> base = tangent_base(patch.normal);
    balance.tangent.push_back(base);
    Eigen::Matrix<double, 3, 6> velocity;
    velocity << Eigen::Matrix3d::Identity(),
        -cross_matrix(patch.position - balance.centre) / balance.length;
    const Eigen::Matrix<double, 2, 6> row = base.transpose() * velocity;
    felt += patch.limit / sum * row.transpose() * row;
    all.middleRows<2>(2 * i) = patch.limit / sum * row;
  }
  const Eigen::SelfAdjointEigenSolver<Matrix6> eigen(felt);
  Index unfelt = 0;
  while (unfelt < 6 && eigen.eigenvalues()[unfelt] < 1e-10 * eigen.eigenvalues()[5]) ++unfelt;
  balance.base_of_motions = eigen.eigenvectors().rightCols(6 - unfelt);
  balance.jacobian = all * balance.base_of_motions;

  Vector6 w;
  w << load.force, (load.moment - balance.centre.cross(load.force)) / balance.length;
  w /= sum;
  balance.load_size = w.norm();
  balance.load = balance.base_of_motions.transpose() * w;
  balance.unfelt_load = w - balance.base_of_motions * balance.load;
  return balance;
}

double balance_error(const FrictionBalance& balance, const std::vector<RubbingPatch>& patches,
                     const Wrench& load, const std::vector<Vec3>& force) {
  Vec3 f = load.force, moment = load.moment - balance.centre.cross(load.force);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    f += force[i];
    moment += (patches[i].position - balance.centre).cross(force[i]);
  }
  if (!(balance.load_size > 0.0)) return 0.0;
  return std::hypot(f.norm(), moment.norm() / balance.length) /
         (balance.load_size * balance.unit_force);
}

HoldingLimit holding_limit(const std::vector<RubbingPatch>& patches, const Wrench& load) {
  constexpr double kGap = 1e-7;     // relative, between the two bounds
  constexpr double kUnfelt = 1e-9;  // part of the load that counts as none
  HoldingLimit limit;
  limit.force.assign(patches.size(), Vec3::Zero());
  if (load.force.isZero(0.0) && load.moment.isZero(0.0)) {
    limit.has_converged = true;
    limit.factor = limit.upper_factor = std::numeric_limits<double>::infinity();
    return limit;
  }
  const FrictionBalance balance = friction_balance(patches, load);
  if (balance.patch_count() == 0 || balance.unfelt_load.norm() > kUnfelt * balance.load_size) {
    limit.has_converged = true;
    if (balance.patch_count() > 0) {
      limit.slip = fastest_by_one(balance.motion(balance.unfelt_load.normalized(), 1.0), patches);
    }
    return limit;
  }

  const int m = balance.patch_count();
  Barrier barrier{balance, balance.load.normalized(), VectorXd::Zero(2 * Index{m}), 0.0,
                  VectorXd::Zero(balance.load.size())};
  double upper = std::numeric_limits<double>::infinity();
  VectorXd best_motion = barrier.direction;
  for (double tau = m; tau < 1e13 * m; tau *= 8.0) {
    bool is_stuck = false;
    for (int newton = 0; newton < 50; ++newton) {
      const double decrement = barrier.step(tau);
      ++limit.iterations;
      if (barrier.upper() < upper) {
        upper = barrier.upper();
        best_motion = barrier.motion;
      }
      is_stuck = decrement < 0.0;
      if (decrement < 1e-3) break;
    }
    if (is_stuck || upper - barrier.s <= kGap * upper) break;
  }
  limit.factor = std::max(0.0, barrier.s) / balance.load_size;
  limit.upper_factor = upper / balance.load_size;
  limit.has_converged = limit.upper_factor - limit.factor <= 1e-5 * limit.upper_factor;
  for (int i = 0; i < m; ++i) {
    limit.force[i] = patches[i].limit * (balance.tangent[i] * barrier.y.segment<2>(2 * Index{i}));
  }
  limit.slip = fastest_by_one(balance.motion(balance.base_of_motions * best_motion, 1.0), patches);
  return limit;
}

}  // namespace palmar::contact
