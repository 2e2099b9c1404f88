// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace palmar::contact {
namespace {

using std::numbers::pi;

/// disc_response() of the unit disc from elliptic integrals.
double unit_disc_exact(double rho) {
  if (rho <= 1.0) return std::comp_ellint_2(rho) / (pi * pi);
  const double k = 1.0 / rho;
  return rho * (std::comp_ellint_2(k) - (1.0 - k * k) * std::comp_ellint_1(k)) / (pi * pi);
}

/// Beyond this many radii the series in 1/rho is exact to 1e-6.
constexpr double kTableEnd = 6.0;
constexpr int kSamplesPerRadius = 1024;
constexpr int kTableSize = static_cast<int>(kTableEnd) * kSamplesPerRadius + 2;

const std::array<double, kTableSize>& unit_disc_table() {
  static const std::array<double, kTableSize> table = [] {
    std::array<double, kTableSize> t{};
    for (int i = 0; i < kTableSize; ++i) t[i] = unit_disc_exact(double(i) / kSamplesPerRadius);
    return t;
  }();
  return table;
}

}  // namespace

double point_response(double r) { return 1.0 / (4.0 * pi * std::max(r, kMinDistance)); }

double disc_response(double r, double a) {
  const double rho = r / a;
  if (rho >= kTableEnd) {
    const double k2 = 1.0 / (rho * rho);
    return (1.0 + k2 * (1.0 / 8.0 + k2 * (3.0 / 64.0))) / (4.0 * pi * r);
  }
  const auto& table = unit_disc_table();
  const double x = rho * kSamplesPerRadius;
  const int i = static_cast<int>(x);
  const double t = x - i;
  return (table[i] + t * (table[i + 1] - table[i])) / a;
}

double boussinesq_response(Kernel kernel, double r, double a_i, double a_j) {
  if (kernel == Kernel::kPoint) return point_response(r);
  return 0.5 * (disc_response(r, a_i) + disc_response(r, a_j));
}

double gaussian_response(double r, double b, double c) {
  const double x = (r - b) / c;
  // Below 1e-8 of the bulge; most pairs of a region are this far apart.
  return x * x > 36.0 ? 0.0 : std::exp(-0.5 * x * x);
}

double shear_modulus_at(const hand::StiffeningLaw& law, double d_max) {
  const double share = std::clamp(d_max / law.limit_depth, 0.0, 1.0);
  return law.g0 + (law.g_limit - law.g0) * share;
}

double swelling_height_at(const hand::RegionTissue& tissue, double force) {
  constexpr double kReferenceForce = 1.0;  // N; Xie 2014, Table 3-2
  return tissue.swelling_height * std::min(1.0, force / kReferenceForce);
}

double disc_overlap(double r, double a, double b) {
  const double small = std::min(a, b);
  if (r <= std::abs(a - b)) return pi * small * small;
  if (r >= a + b) return 0.0;
  const double x = (r * r + a * a - b * b) / (2.0 * r);  // chord's distance from the first centre
  const double y = r - x;
  const double half_chord = std::sqrt(std::max(0.0, a * a - x * x));
  return a * a * std::acos(std::clamp(x / a, -1.0, 1.0)) +
         b * b * std::acos(std::clamp(y / b, -1.0, 1.0)) - r * half_chord;
}

}  // namespace palmar::contact
