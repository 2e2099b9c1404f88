// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

namespace palmar::contact {

/// Normal displacement of an elastic layer of thickness h bonded to a rigid base (skin over bone,
/// the cover of a product), under a normal force of 1 N without friction, times its shear modulus
/// G. In Hankel space (wave number k, L = 3 - 4 nu)
///
///     G u(k) = (1 - nu) / k  M(k h)  p(k)
///     M(x) = (2 L sinh 2x - 4 x) / (2 L cosh 2x + 1 + L^2 + 4 x^2)
///
/// so for nu = 1/2 M = (sinh x cosh x - x) / (cosh^2 x + x^2), and M -> 1 for a half-space. With
/// rho = r / h, alpha = a / h and the half-space's disc_response() (response.h) the force as
/// uniform pressure on a disc of radius a gives, r from its centre,
///
///     2 (1 - nu) disc_response(r, a)
///         - (1 - nu) / (2 pi h) Int_0^inf (1 - M(x)) 2 J1(alpha x) / (alpha x) J0(rho x) dx.
///
/// The integral is smooth and tabulated. Source: Hayes et al. 1972 (J. Biomechanics 5); Perriot,
/// Barthel 2004 (J. Materials Research 19).

/// The tabulated integral of one Poisson's ratio: a bicubic spline on a grid of rho and alpha.
class LayerKernel {
 public:
  static constexpr int kStepsPerUnit = 10;  ///< of rho and alpha; spline error below 2e-6
  static constexpr int kRhoEnd = 14;
  static constexpr int kAlphaEnd = 4;
  static constexpr int kStride = kRhoEnd * kStepsPerUnit + 3;  ///< coefficients per row

  explicit LayerKernel(double poisson);

  double poisson() const { return poisson_; }
  /// 1 - M(x), x >= 0.
  double lack_of_compliance(double x) const;
  /// The integral above; rho, alpha >= 0.
  double correction(double rho, double alpha) const;
  /// Coefficients along rho for one alpha below kAlphaEnd.
  std::array<double, kStride> row_at(double alpha) const;

 private:
  double integral(double rho, double alpha) const;

  double poisson_;
  double L_;
  std::vector<double> coefficient_;  ///< of the spline; rows alpha, columns rho
};

/// The kernel of one Poisson's ratio, 0 to 0.5: made at the first call (about 10 ms), then kept.
/// Thread-safe. Throws UsageError outside that range.
const LayerKernel& layer_kernel(double poisson);

/// Force of 1 N on a disc of radius a [mm] on a layer of thickness h [mm] (infinite: half-space),
/// seen at the distance r [mm] from its centre; result [1/mm]. Within 1e-4 of the value in the
/// centre for a <= 3 h. With nu near 1/2 it has a shallow negative lobe (the layer bulges) around
/// r = a + h; farther than r = a + 10 h it is zero. Slow (30 us) for a > 4 h; a layer thinner than
/// a / 64 counts as that thick.
double layered_response(const LayerKernel& kernel, double r, double a, double h);

/// layered_response() of one disc seen from many distances: about twice as fast, at a price of 0.2
/// us for the first.
class LayerSource {
 public:
  LayerSource(const LayerKernel& kernel, double a, double h);
  double at(double r) const;  ///< 1/mm; r in mm

 private:
  const LayerKernel* kernel_;
  double a_, h_, end_, steps_per_mm_, disc_share_, share_;
  bool is_tabulated_;
  std::array<double, LayerKernel::kStride> row_;
};

/// The same force on a half-space of any Poisson's ratio: 2 (1 - nu) disc_response().
double half_space_response(double poisson, double r, double a);

}  // namespace palmar::contact
