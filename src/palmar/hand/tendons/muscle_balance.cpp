// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/muscle_balance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMaxIterations = 100;
constexpr double kTolerance = 1e-10;
constexpr double kMissingPrice = 1e4;  // per scaled moment; muscles cost about n / lever
constexpr double kStopCost = 1e-9;     // makes the moment of two stops unique
constexpr int kBothWays = 2;
constexpr double kLeastMissing = 1e-6;  // of the largest moment; less is rounding
constexpr double kLargestResidual = 1e-6;

/// min phi(x) so that A x = b, 0 <= x <= u; x = activations, stops, missing up, missing down.
/// Moments are over each axis' capacity, then over the largest one, activations likewise: the
/// problem looks the same for a feather and a hammer.
struct Program {
  MatrixXd a;
  VectorXd b;
  VectorXd upper;
  VectorXd price;  // of what is missing, up and down
  int muscles = 0, stops = 0, axes = 0;
  int exponent = 3;

  Eigen::Index size() const { return a.cols(); }
  VectorXd gradient(const VectorXd& x) const {
    VectorXd g = VectorXd::Zero(size());
    g.tail(2 * axes) = price;
    for (int i = 0; i < muscles; ++i) g[i] = exponent * std::pow(x[i], exponent - 1);
    for (int i = muscles; i < muscles + stops; ++i) g[i] = kStopCost * x[i];
    return g;
  }
  VectorXd curvature(const VectorXd& x) const {
    VectorXd h = VectorXd::Zero(size());
    for (int i = 0; i < muscles; ++i) {
      h[i] = exponent * (exponent - 1) * std::pow(x[i], exponent - 2);
    }
    for (int i = muscles; i < muscles + stops; ++i) h[i] = kStopCost;
    return h;
  }
};

struct Iterate {
  VectorXd x, y, z, w;  ///< z for x >= 0, w for x <= u
};

/// Largest step that keeps v + t dv positive, at most 1.
double step_to_boundary(const VectorXd& v, const VectorXd& dv, const VectorXd& used) {
  double step = 1.0;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (used[i] != 0.0 && dv[i] < 0.0) step = std::min(step, -v[i] / dv[i]);
  }
  return step;
}

class InteriorPoint {
 public:
  explicit InteriorPoint(const Program& program) : p_(program) {
    const Eigen::Index n = p_.size();
    bounded_ = VectorXd::Zero(n);
    everywhere_ = VectorXd::Ones(n);
    for (Eigen::Index i = 0; i < n; ++i) bounded_[i] = std::isfinite(p_.upper[i]) ? 1.0 : 0.0;
    at_.x = VectorXd::Ones(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (bounded_[i] != 0.0) at_.x[i] = std::min(1.0, 0.5 * p_.upper[i]);
    }
    at_.y = VectorXd::Zero(p_.axes);
    at_.z = p_.gradient(at_.x).cwiseMax(1.0);
    at_.w = bounded_;
  }

  int run() {
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      if (has_converged() || !take_step()) return iteration;
    }
    return kMaxIterations;
  }
  const Iterate& at() const { return at_; }

 private:
  VectorXd room() const {  // u - x; 1 where there is no bound
    VectorXd r = VectorXd::Ones(p_.size());
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      if (bounded_[i] != 0.0) r[i] = p_.upper[i] - at_.x[i];
    }
    return r;
  }
  double gap() const {
    const VectorXd r = room();
    return (at_.x.dot(at_.z) + (r.array() * at_.w.array() * bounded_.array()).sum()) /
           (static_cast<double>(p_.size()) + bounded_.sum());
  }
  VectorXd dual_residual() const {
    return p_.gradient(at_.x) - p_.a.transpose() * at_.y - at_.z + at_.w;
  }
  bool has_converged() const {
    const double price = std::max(1.0, at_.y.lpNorm<Eigen::Infinity>());
    return (p_.a * at_.x - p_.b).lpNorm<Eigen::Infinity>() < kTolerance &&
           dual_residual().lpNorm<Eigen::Infinity>() < kTolerance * price &&
           gap() < 1e-4 * kTolerance * price;
  }

  /// Whether there is a step: near the ends of double's range equations may have no finite
  /// solution; then the iterate stays, and the conditions say how good it is.
  bool take_step() {
    const VectorXd r = room();
    const VectorXd rd = dual_residual(), rp = p_.a * at_.x - p_.b;
    const VectorXd diagonal = p_.curvature(at_.x).array() + at_.z.array() / at_.x.array() +
                              bounded_.array() * at_.w.array() / r.array();
    const VectorXd inverse = diagonal.cwiseInverse();
    const MatrixXd normal = p_.a * inverse.asDiagonal() * p_.a.transpose();
    const Eigen::LDLT<MatrixXd> factor(normal);

    // Solves for complementarity targets x z = target_x, (u - x) w = target_u.
    const auto direction = [&](const VectorXd& target_x, const VectorXd& target_u) {
      Iterate d;
      const VectorXd rhs = -rd.array() + target_x.array() / at_.x.array() - at_.z.array() -
                           bounded_.array() * (target_u.array() / r.array() - at_.w.array());
      d.y = factor.solve(-rp - p_.a * (inverse.asDiagonal() * rhs));
      d.x = inverse.asDiagonal() * (rhs + p_.a.transpose() * d.y);
      d.z = (target_x.array() - at_.z.array() * d.x.array()) / at_.x.array() - at_.z.array();
      d.w = bounded_.array() *
            ((target_u.array() + at_.w.array() * d.x.array()) / r.array() - at_.w.array());
      return d;
    };
    const auto lengths = [&](const Iterate& d) {
      const double primal =
          std::min(step_to_boundary(at_.x, d.x, everywhere_), step_to_boundary(r, -d.x, bounded_));
      const double dual = std::min(step_to_boundary(at_.z, d.z, everywhere_),
                                   step_to_boundary(at_.w, d.w, bounded_));
      return std::min(primal, dual);
    };

    const VectorXd none = VectorXd::Zero(p_.size());
    const Iterate affine = direction(none, none);
    const double t = lengths(affine);
    const double mu = gap();
    const double after =
        ((at_.x + t * affine.x).dot(at_.z + t * affine.z) +
         ((r - t * affine.x).array() * (at_.w + t * affine.w).array() * bounded_.array()).sum()) /
        (static_cast<double>(p_.size()) + bounded_.sum());
    const double target = mu * std::pow(std::max(0.0, after / mu), 3);
    const VectorXd target_x = target - affine.x.array() * affine.z.array();
    const VectorXd target_u = target + affine.x.array() * affine.w.array();
    Iterate d = direction(target_x, target_u);
    double step = lengths(d);
    if (step < 0.1 || mu > 0.7 * last_gap_) {
      // The corrector overshoots or goes in circles: plain steps back towards the central path.
      constexpr double kCentring = 0.5;
      d = direction(VectorXd::Constant(p_.size(), kCentring * mu), kCentring * mu * bounded_);
      step = lengths(d);
    }
    last_gap_ = mu;
    if (!d.x.allFinite() || !d.y.allFinite() || !d.z.allFinite() || !d.w.allFinite()) return false;
    step = std::min(1.0, 0.995 * step);
    at_.x += step * d.x;
    at_.y += step * d.y;
    at_.z += step * d.z;
    at_.w += step * d.w;
    return true;
  }

  const Program& p_;
  VectorXd bounded_, everywhere_;
  Iterate at_;
  double last_gap_ = std::numeric_limits<double>::infinity();
};

/// Violation of the optimality conditions of the muscles, whatever the solver said.
double kkt_residual(const Program& p, const VectorXd& x, const VectorXd& y) {
  double worst = (p.a * x - p.b).lpNorm<Eigen::Infinity>();
  const VectorXd g = p.gradient(x);
  const VectorXd reduced = g - p.a.transpose() * y;
  const double scale = std::max(1.0, g.head(p.muscles).lpNorm<Eigen::Infinity>());
  for (int i = 0; i < p.muscles; ++i) {
    // 0 where the gradient vanishes or points out of the bound that x stands at.
    const double moved = std::clamp(x[i] - reduced[i] / scale, 0.0, p.upper[i]);
    worst = std::max(worst, std::abs(x[i] - moved));
  }
  return worst;
}

void check(const MuscleProblem& problem) {
  const Eigen::Index axes = problem.moment_at_strength.rows();
  if (problem.exponent != 2 && problem.exponent != 3) {
    throw UsageError("muscle balance: exponent is " + std::to_string(problem.exponent) +
                     "; 2 or 3 is allowed");
  }
  if (problem.required.size() != axes || problem.stop.size() != axes ||
      (problem.price.size() != 0 && problem.price.size() != axes)) {
    throw UsageError("muscle balance: " + std::to_string(problem.required.size()) + " moments, " +
                     std::to_string(problem.stop.size()) + " stops and " +
                     std::to_string(problem.price.size()) + " prices for " + std::to_string(axes) +
                     " axes");
  }
  if (!problem.moment_at_strength.allFinite() || !problem.required.allFinite()) {
    throw UsageError("muscle balance: a moment is not finite");
  }
}

}  // namespace

MuscleSolution balance_muscles(const MuscleProblem& problem) {
  check(problem);
  const MatrixXd& moments = problem.moment_at_strength;
  const int axes = static_cast<int>(moments.rows()), muscles = static_cast<int>(moments.cols());
  MuscleSolution solution;
  solution.activation = VectorXd::Zero(muscles);
  solution.stop = VectorXd::Zero(axes);
  solution.missing = VectorXd::Zero(axes);

  VectorXd capacity = moments.cwiseAbs().rowwise().sum();
  for (int k = 0; k < axes; ++k) {
    if (capacity[k] <= 0.0) capacity[k] = 1.0;  // N mm; no muscle acts here
  }
  const VectorXd scaled = problem.required.cwiseQuotient(capacity);
  const double largest = scaled.lpNorm<Eigen::Infinity>();
  if (largest == 0.0) {
    solution.status = MuscleStatus::kBalanced;
    return solution;
  }
  const double load = std::min(1.0, largest);

  Program program;
  program.axes = axes;
  program.muscles = muscles;
  program.exponent = problem.exponent;
  program.stops = static_cast<int>((problem.stop.array() != 0).count() +
                                   (problem.stop.array() == kBothWays).count());
  const int n = muscles + program.stops + 2 * axes;
  program.a = MatrixXd::Zero(axes, n);
  program.a.leftCols(muscles) = capacity.cwiseInverse().asDiagonal() * moments;
  for (int k = 0, column = muscles; k < axes; ++k) {
    if (problem.stop[k] == 0) continue;
    program.a(k, column++) = problem.stop[k] == -1 ? -1.0 : 1.0;
    if (problem.stop[k] == kBothWays) program.a(k, column++) = -1.0;
  }
  program.a.middleCols(n - 2 * axes, axes).setIdentity();
  program.a.rightCols(axes) = -MatrixXd::Identity(axes, axes);
  program.b = scaled / load;
  program.upper = VectorXd::Constant(n, std::numeric_limits<double>::infinity());
  program.upper.head(muscles).setConstant(1.0 / load);
  program.price = VectorXd::Constant(2 * axes, kMissingPrice);
  if (problem.price.size() == axes) {
    program.price.head(axes).array() *= problem.price.array();
    program.price.tail(axes).array() *= problem.price.array();
  }

  InteriorPoint method(program);
  solution.iterations = method.run();
  VectorXd x = method.at().x;
  for (int i = 0; i < muscles; ++i) {
    if (moments.col(i).isZero(0.0)) x[i] = 0.0;  // moves nothing here
  }
  solution.kkt_residual = kkt_residual(program, x, method.at().y);

  constexpr double kNothing = 1e-9;
  for (int i = 0; i < muscles; ++i) {
    solution.activation[i] = x[i] < kNothing ? 0.0 : std::min(1.0, load * x[i]);
  }
  for (int k = 0, column = muscles; k < axes; ++k) {
    if (problem.stop[k] == 0) continue;
    double moment = problem.stop[k] == -1 ? -x[column] : x[column];
    ++column;
    if (problem.stop[k] == kBothWays) moment -= x[column++];
    if (std::abs(moment) > kNothing) solution.stop[k] = load * capacity[k] * moment;
  }
  bool is_missing = false;
  for (int k = 0; k < axes; ++k) {
    const double missing = x[n - 2 * axes + k] - x[n - axes + k];
    if (std::abs(missing) < kLeastMissing) continue;
    is_missing = true;
    solution.missing[k] = load * capacity[k] * missing;
  }
  solution.status = is_missing ? MuscleStatus::kOverloaded : MuscleStatus::kBalanced;
  if (!(solution.kkt_residual < kLargestResidual)) solution.status = MuscleStatus::kNotConverged;
  return solution;
}

bool is_enough(const MuscleSolution& solution, double negligible) {
  return solution.status != MuscleStatus::kNotConverged &&
         solution.missing.lpNorm<Eigen::Infinity>() <= negligible;
}

double least_strength_share(const MuscleProblem& problem, double negligible) {
  constexpr double kStrongest = 64.0;
  constexpr int kHalvings = 7;
  const auto with = [&](double share) {
    MuscleProblem scaled = problem;
    scaled.moment_at_strength *= share;
    const MuscleSolution solution = balance_muscles(scaled);
    return std::pair(is_enough(solution, negligible), solution.activation.maxCoeff() * share);
  };
  double low = 0.0, high = 1.0;
  for (;;) {
    const auto [can, used] = with(high);
    if (can) {
      high = std::min(high, used);
      break;
    }
    if (high >= kStrongest) return std::numeric_limits<double>::infinity();
    low = high;
    high *= 2.0;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (middle > 0.0 && with(middle).first ? high : low) = middle;
  }
  return high;
}

}  // namespace palmar::hand
