// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/closed_spline.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr int kFewestPoles = 8, kMorePoles = 4;
constexpr int kRounds = 4;  // of moving parameters

/// Weights of the four poles from floor(s) - 1 on, of the uniform cubic B-spline, and their
/// derivatives by s.
struct Weights {
  std::array<double, 4> value, slope;
};
Weights weights_at(double t) {
  const double u = 1.0 - t;
  return {{u * u * u / 6.0, (3.0 * t * t * t - 6.0 * t * t + 4.0) / 6.0,
           (-3.0 * t * t * t + 3.0 * t * t + 3.0 * t + 1.0) / 6.0, t * t * t / 6.0},
          {-0.5 * u * u, 1.5 * t * t - 2.0 * t, -1.5 * t * t + t + 0.5, 0.5 * t * t}};
}

struct At {
  Eigen::VectorXd value, slope;
};
At curve_at(const Eigen::MatrixXd& poles, double s) {
  const auto n = static_cast<int>(poles.rows());
  const double floor = std::floor(s);
  const Weights w = weights_at(s - floor);
  At at{Eigen::VectorXd::Zero(poles.cols()), Eigen::VectorXd::Zero(poles.cols())};
  for (int k = 0; k < 4; ++k) {
    const int i = ((static_cast<int>(floor) - 1 + k) % n + n) % n;
    at.value += w.value[static_cast<std::size_t>(k)] * poles.row(i).transpose();
    at.slope += w.slope[static_cast<std::size_t>(k)] * poles.row(i).transpose();
  }
  return at;
}

ClosedSpline fit(const Eigen::MatrixXd& points, int n) {
  const auto m = static_cast<int>(points.rows());
  Eigen::VectorXd s(m);
  double way = 0.0;
  for (int i = 0; i < m; ++i) {
    s[i] = way;
    way += (points.row((i + 1) % m) - points.row(i)).norm();
  }
  s *= n / way;
  ClosedSpline spline;
  for (int round = 0; round <= kRounds; ++round) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, points.cols());
    for (int i = 0; i < m; ++i) {
      const double floor = std::floor(s[i]);
      const Weights w = weights_at(s[i] - floor);
      for (int a = 0; a < 4; ++a) {
        const int row = ((static_cast<int>(floor) - 1 + a) % n + n) % n;
        right.row(row) += w.value[static_cast<std::size_t>(a)] * points.row(i);
        for (int b = 0; b < 4; ++b) {
          const int column = ((static_cast<int>(floor) - 1 + b) % n + n) % n;
          normal(row, column) +=
              w.value[static_cast<std::size_t>(a)] * w.value[static_cast<std::size_t>(b)];
        }
      }
    }
    normal.diagonal().array() += 1e-9 * normal.trace() / n;  // where no point is near a pole
    spline.poles = normal.ldlt().solve(right);
    spline.deviation = 0.0;
    for (int i = 0; i < m; ++i) {
      const At at = curve_at(spline.poles, s[i]);
      const Eigen::VectorXd off = points.row(i).transpose() - at.value;
      spline.deviation = std::max(spline.deviation, off.norm());
      const double steep = at.slope.squaredNorm();
      if (round < kRounds && steep > 0.0) s[i] += std::clamp(off.dot(at.slope) / steep, -0.3, 0.3);
    }
  }
  return spline;
}

}  // namespace

ClosedSpline fit_closed_spline(const Eigen::MatrixXd& points, double tolerance, int most_poles) {
  const auto m = static_cast<int>(points.rows());
  if (m < 4) {
    throw UsageError("closed spline: " + std::to_string(m) +
                     " points; at least 4 points are needed");
  }
  const int most = std::clamp(m / 2, 4, std::max(4, most_poles));
  ClosedSpline spline;
  for (int n = std::min(kFewestPoles, most);; n = std::min(most, n + kMorePoles)) {
    spline = fit(points, n);
    if (spline.deviation <= tolerance || n == most) return spline;
  }
}

}  // namespace palmar::cad
