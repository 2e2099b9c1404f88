// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/layered_response.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <sstream>

#include "palmar/contact/response/response.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

constexpr int kStride = LayerKernel::kStride;
constexpr int kColumns = kStride - 2;  // one more spline on either side
constexpr int kRows = LayerKernel::kAlphaEnd * LayerKernel::kStepsPerUnit + 1;
constexpr double kStep = 1.0 / LayerKernel::kStepsPerUnit;
constexpr double kDiedOut = LayerKernel::kRhoEnd - LayerKernel::kAlphaEnd;  // thicknesses
constexpr double kThinnest = 1.0 / 64.0;
constexpr double kMostWave = 18.0;  // 1 - M is below 1e-12 beyond

// Gauss-Legendre nodes and weights on [-1, 1], the positive half of 16 (Abramowitz, Stegun 25.4).
constexpr std::array<double, 8> kNode = {0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
                                         0.6178762444026438, 0.7554044083550030, 0.8656312023878318,
                                         0.9445750230732326, 0.9894009349916499};
constexpr std::array<double, 8> kWeight = {
    0.1894506104550685, 0.1826034150449236, 0.1691565193950025, 0.1495959888165767,
    0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541};

/// Nodes x and weights (without 1 - M) on [0, kMostWave]; panels short enough for waves up to
/// cos(fastest x).
struct Quadrature {
  Eigen::ArrayXd x, w;

  explicit Quadrature(double fastest) {
    const int panels = static_cast<int>(std::ceil(kMostWave * std::max(1.0, fastest / 10.0)));
    const double half = 0.5 * kMostWave / panels;
    x.resize(16L * panels);
    w.resize(16L * panels);
    Eigen::Index n = 0;
    for (int i = 0; i < panels; ++i) {
      const double middle = (2 * i + 1) * half;
      for (int j = 0; j < 16; ++j) {
        const double side = j < 8 ? -1.0 : 1.0;
        const int k = j < 8 ? 7 - j : j - 8;
        x[n] = middle + side * half * kNode[k];
        w[n++] = half * kWeight[k];
      }
    }
  }
};

/// 2 J1(y) / y, the transform of a uniform disc.
double disc_transform(double y) { return y < 1e-4 ? 1.0 - y * y / 8.0 : 2.0 * ::j1(y) / y; }

/// Coefficients of the cubic B-spline through n values at unit steps, in place; the function is
/// even about the first point, and its third difference is kept at the last. c[-1] = c[1] is left
/// to the caller; returns the coefficient one beyond the end.
double spline_coefficients(Eigen::Ref<Eigen::VectorXd> c) {
  const Eigen::Index n = c.size();
  // (c[i-1] + 4 c[i] + c[i+1]) / 6 = f[i]; at the end the coefficient is the value less a sixth of
  // the second difference of values.
  const double end_bend = 2.0 * c[n - 1] - 5.0 * c[n - 2] + 4.0 * c[n - 3] - c[n - 4];
  const double last = c[n - 1];
  Eigen::VectorXd upper(n);
  upper[0] = 0.5;  // 4 c0 + 2 c1 = 6 f0
  c[0] = 1.5 * c[0];
  for (Eigen::Index i = 1; i + 1 < n; ++i) {
    const double pivot = 4.0 - upper[i - 1];
    upper[i] = 1.0 / pivot;
    c[i] = (6.0 * c[i] - c[i - 1]) / pivot;
  }
  c[n - 1] = last - end_bend / 6.0;
  for (Eigen::Index i = n - 2; i >= 0; --i) c[i] -= upper[i] * c[i + 1];
  return 6.0 * last - 4.0 * c[n - 1] - c[n - 2];
}

std::array<double, 4> spline_weights(double t) {
  const double s = 1.0 - t;
  const double t2 = t * t;
  const double s2 = s * s;
  return {s2 * s / 6.0, (4.0 - 3.0 * t2 * (2.0 - t)) / 6.0, (4.0 - 3.0 * s2 * (2.0 - s)) / 6.0,
          t2 * t / 6.0};
}

}  // namespace

LayerKernel::LayerKernel(double poisson) : poisson_(poisson), L_(3.0 - 4.0 * poisson) {
  const Quadrature quadrature(kRhoEnd + kAlphaEnd);
  const Eigen::Index n = quadrature.x.size();
  Eigen::MatrixXd waves(n, kColumns);
  Eigen::MatrixXd discs(kRows, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double x = quadrature.x[i];
    const double w = quadrature.w[i] * lack_of_compliance(x);
    for (int j = 0; j < kColumns; ++j) waves(i, j) = w * ::j0(j * kStep * x);
    for (int j = 0; j < kRows; ++j) discs(j, i) = disc_transform(j * kStep * x);
  }
  using Grid = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Grid grid = Grid::Zero(kRows + 2, kStride);
  grid.block(1, 1, kRows, kColumns) = discs * waves;
  for (int row = 1; row <= kRows; ++row) {
    Eigen::VectorXd line = grid.row(row).segment(1, kColumns);
    grid(row, kColumns + 1) = spline_coefficients(line);
    grid.row(row).segment(1, kColumns) = line.transpose();
    grid(row, 0) = grid(row, 2);
  }
  for (int column = 0; column < kStride; ++column) {
    Eigen::VectorXd line = grid.col(column).segment(1, kRows);
    grid(kRows + 1, column) = spline_coefficients(line);
    grid.col(column).segment(1, kRows) = line;
    grid(0, column) = grid(2, column);
  }
  coefficient_.assign(grid.data(), grid.data() + grid.size());
}

double LayerKernel::lack_of_compliance(double x) const {
  // Written so that nothing cancels: numerator of 1 - M times e^(-2x).
  const double e = std::exp(-2.0 * x);
  const double rest = 1.0 + L_ * L_ + 4.0 * x * x;
  return e * (2.0 * L_ * e + rest + 4.0 * x) / (L_ * (1.0 + e * e) + e * rest);
}

double LayerKernel::integral(double rho, double alpha) const {
  const Quadrature quadrature(rho + alpha);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < quadrature.x.size(); ++i) {
    const double x = quadrature.x[i];
    sum += quadrature.w[i] * lack_of_compliance(x) * disc_transform(alpha * x) * ::j0(rho * x);
  }
  return sum;
}

double LayerKernel::correction(double rho, double alpha) const {
  if (!(alpha < kAlphaEnd) || !(rho < kRhoEnd)) return integral(rho, alpha);
  const double x = rho * kStepsPerUnit;
  const double y = alpha * kStepsPerUnit;
  const int column = static_cast<int>(x);
  const int row = static_cast<int>(y);
  const std::array<double, 4> along = spline_weights(x - column);
  const std::array<double, 4> across = spline_weights(y - row);
  const double* c = coefficient_.data() + static_cast<std::ptrdiff_t>(row) * kStride + column;
  double sum = 0.0;
  for (int i = 0; i < 4; ++i, c += kStride) {
    sum += across[i] * (along[0] * c[0] + along[1] * c[1] + along[2] * c[2] + along[3] * c[3]);
  }
  return sum;
}

std::array<double, LayerKernel::kStride> LayerKernel::row_at(double alpha) const {
  const double y = alpha * kStepsPerUnit;
  const int row = static_cast<int>(y);
  const std::array<double, 4> across = spline_weights(y - row);
  const double* c = coefficient_.data() + static_cast<std::ptrdiff_t>(row) * kStride;
  std::array<double, kStride> along;
  for (int i = 0; i < kStride; ++i) {
    along[i] = across[0] * c[i] + across[1] * c[i + kStride] + across[2] * c[i + 2 * kStride] +
               across[3] * c[i + 3 * kStride];
  }
  return along;
}

const LayerKernel& layer_kernel(double poisson) {
  if (!(poisson >= 0.0 && poisson <= 0.5)) {
    std::ostringstream message;
    message << "layer: Poisson's ratio is " << poisson << "; 0 to 0.5 is required";
    throw UsageError(message.str());
  }
  static std::mutex mutex;
  static std::map<double, std::unique_ptr<const LayerKernel>> kernels;
  const std::scoped_lock lock(mutex);
  std::unique_ptr<const LayerKernel>& kernel = kernels[poisson];
  if (!kernel) kernel = std::make_unique<const LayerKernel>(poisson);
  return *kernel;
}

double half_space_response(double poisson, double r, double a) {
  return 2.0 * (1.0 - poisson) * disc_response(r, a);
}

LayerSource::LayerSource(const LayerKernel& kernel, double a, double h)
    : kernel_(&kernel),
      a_(a),
      h_(std::max(h, kThinnest * a)),
      end_(a + kDiedOut * h_),
      steps_per_mm_(LayerKernel::kStepsPerUnit / h_),
      disc_share_(2.0 * (1.0 - kernel.poisson())),
      share_((1.0 - kernel.poisson()) / (2.0 * std::numbers::pi * h_)),
      is_tabulated_(a / h_ < LayerKernel::kAlphaEnd) {
  if (is_tabulated_) row_ = kernel.row_at(a / h_);
}

double LayerSource::at(double r) const {
  if (!is_tabulated_) return layered_response(*kernel_, r, a_, h_);
  if (r > end_) return 0.0;
  // At the very end rounding may reach past the last interval.
  const double x = r * steps_per_mm_;
  const int i = std::min(static_cast<int>(x), kColumns - 2);
  const std::array<double, 4> w = spline_weights(x - i);
  const double* c = row_.data() + i;
  const double correction = w[0] * c[0] + w[1] * c[1] + w[2] * c[2] + w[3] * c[3];
  return disc_share_ * disc_response(r, a_) - share_ * correction;
}

double layered_response(const LayerKernel& kernel, double r, double a, double h) {
  h = std::max(h, kThinnest * a);
  if (r > a + kDiedOut * h) return 0.0;
  const double half_space = half_space_response(kernel.poisson(), r, a);
  const double share = (1.0 - kernel.poisson()) / (2.0 * std::numbers::pi * h);
  return half_space - share * kernel.correction(r / h, a / h);
}

}  // namespace palmar::contact
