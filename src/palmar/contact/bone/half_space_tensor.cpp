// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/half_space_tensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/contact/response/response.h"
#include "palmar/contact/response/tangential_response.h"

namespace palmar::contact {
namespace {

constexpr std::array<double, 3> kBinomial = {3.0, 3.0, 1.0};  // 1 - (1 - g)^3 = 3 g - 3 g^2 + g^3
constexpr double kFarSpread = 400.0;  // r^2 / a; spread forces are points there within 1e-4

/// exp(-y) I0(y) and exp(-y) I1(y), y >= 0: Abramowitz, Stegun 1964, 9.8.1 to 9.8.4; error below
/// 1e-6.
struct ScaledBessel {
  double i0 = 1.0, i1 = 0.0;
};
ScaledBessel scaled_bessel(double y) {
  if (y < 3.75) {
    const double t = (y / 3.75) * (y / 3.75);
    const double e = std::exp(-y);
    const double i0 =
        1.0 +
        t * (3.5156229 +
             t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813)))));
    const double i1 =
        y *
        (0.5 + t * (0.87890594 +
                    t * (0.51498869 +
                         t * (0.15084934 + t * (0.02658733 + t * (0.00301532 + t * 0.00032411))))));
    return {e * i0, e * i1};
  }
  const double t = 3.75 / y;
  const double i0 =
      0.39894228 +
      t * (0.01328592 +
           t * (0.00225319 +
                t * (-0.00157565 +
                     t * (0.00916281 +
                          t * (-0.02057706 +
                               t * (0.02635537 + t * (-0.01647633 + t * 0.00392377)))))));
  const double i1 =
      0.39894228 +
      t * (-0.03988024 +
           t * (-0.00362018 +
                t * (0.00163801 +
                     t * (-0.01031555 +
                          t * (0.02282967 +
                               t * (-0.02895312 + t * (0.01787654 - t * 0.00420059)))))));
  return {i0 / std::sqrt(y), i1 / std::sqrt(y)};
}

/// normal n n^T + across (I - n n^T) + (along - across) e e^T, e tangential.
Eigen::Matrix3d composed(const Vec3& between, const Vec3& n_i, const Vec3& n_j, double normal,
                         double along, double across) {
  const Vec3 n = (n_i + n_j).squaredNorm() > 1e-6 ? Vec3((n_i + n_j).normalized()) : n_i;
  Eigen::Matrix3d result =
      across * Eigen::Matrix3d::Identity() + (normal - across) * n * n.transpose();
  const Vec3 e = between - between.dot(n) * n;
  if (e.squaredNorm() > 1e-12) {
    result += (along - across) / e.squaredNorm() * e * e.transpose();
  } else {
    // In one place the two tangential directions are alike.
    result += 0.5 * (along - across) * (Eigen::Matrix3d::Identity() - n * n.transpose());
  }
  return result;
}

Eigen::Matrix3d point_tensor(const Vec3& between, double r) {
  const Vec3 e = between / r;
  return (Eigen::Matrix3d::Identity() + e * e.transpose()) / (4.0 * std::numbers::pi * r);
}

}  // namespace

Eigen::Matrix3d disc_tensor(const Vec3& between, double a_i, double a_j, const Vec3& n_i,
                            const Vec3& n_j) {
  const double r = between.norm();
  const double D = 0.5 * (disc_response(r, a_i) + disc_response(r, a_j));
  const double g = 0.5 * (directed_disc_response(r, a_i) + directed_disc_response(r, a_j));
  return composed(between, n_i, n_j, D, 1.5 * D + 0.5 * g, 1.5 * D - 0.5 * g);
}

Eigen::Matrix3d spread_tensor(const Vec3& between, double w_i, double w_j, const Vec3& n_i,
                              const Vec3& n_j) {
  const double r2 = between.squaredNorm();
  if (r2 > kFarSpread * std::max(w_i * w_i, w_j * w_j)) {
    return point_tensor(between, std::sqrt(r2));
  }
  double B = 0.0, T = 0.0;
  for (int m = 1; m <= 3; ++m) {
    for (int n = 1; n <= 3; ++n) {
      const double sign = (m + n) % 2 == 0 ? 1.0 : -1.0;
      const double factor = sign * kBinomial[m - 1] * kBinomial[n - 1];
      const double a = 0.5 * (m * w_i * w_i + n * w_j * w_j);
      const ScaledBessel bessel = scaled_bessel(r2 / (8.0 * a));
      const double root = std::sqrt(std::numbers::pi / a);
      B += factor * 0.5 * root * bessel.i0;
      T += factor * 0.25 * root * (bessel.i0 + bessel.i1);
    }
  }
  return composed(between, n_i, n_j, B, B + T, 2.0 * B - T) / (4.0 * std::numbers::pi);
}

double near_share(double r, double w_i, double w_j) {
  const double x = std::clamp((r / (0.5 * (w_i + w_j)) - 3.0) / 3.0, 0.0, 1.0);
  return 1.0 - x * x * x * (10.0 - x * (15.0 - 6.0 * x));
}

}  // namespace palmar::contact
