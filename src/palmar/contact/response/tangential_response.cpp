// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/tangential_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "palmar/contact/response/response.h"

namespace palmar::contact {
namespace {

using std::numbers::pi;

/// 4 pi a times directed_disc_response() inside the disc, k = r / a.
double inside(double k) {
  if (k < 0.02) return 0.25 * k * k;  // the closed form would cancel; next term k^4 / 32
  const double k2 = k * k;
  const double elliptic_k = k < 1.0 ? std::comp_ellint_1(k) : 0.0;  // times 1 - k^2 = 0 at k = 1
  return 4.0 / (3.0 * pi * k2) *
         ((2.0 - k2) * std::comp_ellint_2(k) - 2.0 * (1.0 - k2) * elliptic_k);
}

/// 4 pi r times directed_disc_response() outside, q = a / r; 1 for q = 0. The chords of the disc
/// in the direction phi are 2 a cos(psi) long, sin(phi) = q sin(psi).
double outside(double q) {
  constexpr int kSteps = 256;  // the integrand is smooth for q < 1
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double psi = pi * ((i + 0.5) / kSteps - 0.5);
    const double sine = q * std::sin(psi);
    const double cosine = std::cos(psi);
    sum += cosine * cosine * (1.0 - 2.0 * sine * sine) / std::sqrt(1.0 - sine * sine);
  }
  return 2.0 / kSteps * sum;
}

constexpr std::size_t kSteps = 512;

struct Tables {
  std::array<double, kSteps + 2> in{}, out{};
  Tables() {
    for (std::size_t i = 0; i <= kSteps; ++i) {
      const double x = static_cast<double>(i) / kSteps;
      in[i] = inside(x);
      out[i] = outside(x);
    }
    in[kSteps + 1] = in[kSteps];
    out[kSteps] = in[kSteps];  // the integrand's root vanishes there
    out[kSteps + 1] = out[kSteps];
  }
};

double interpolate(const std::array<double, kSteps + 2>& table, double x) {
  const double place = x * kSteps;
  const auto i = static_cast<std::size_t>(place);
  const double t = place - static_cast<double>(i);
  return table[i] + t * (table[i + 1] - table[i]);
}

}  // namespace

double directed_disc_response(double r, double a) {
  static const Tables tables;
  if (r <= a) return interpolate(tables.in, r / a) / (4.0 * pi * a);
  return interpolate(tables.out, a / r) / (4.0 * pi * r);
}

Eigen::Matrix3d tangential_response(const Vec3& between, double a_i, double a_j) {
  const double r = between.norm();
  const double even = 0.5 * (disc_response(r, a_i) + disc_response(r, a_j));
  const double along = 0.5 * (directed_disc_response(r, a_i) + directed_disc_response(r, a_j));
  Eigen::Matrix3d response = (1.5 * even - 0.5 * along) * Eigen::Matrix3d::Identity();
  if (r > 0.0) response += along / (r * r) * between * between.transpose();
  return response;
}

}  // namespace palmar::contact
