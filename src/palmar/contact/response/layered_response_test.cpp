// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/response/layered_response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <vector>

#include "palmar/contact/response/response.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

/// M(x) as printed, hyperbolic functions and all.
double printed_m(double nu, double x) {
  if (nu == 0.5) {
    const double s = std::sinh(x);
    const double c = std::cosh(x);
    return (s * c - x) / (c * c + x * x);
  }
  const double L = 3.0 - 4.0 * nu;
  return (2.0 * L * std::sinh(2.0 * x) - 4.0 * x) /
         (2.0 * L * std::cosh(2.0 * x) + 1.0 + L * L + 4.0 * x * x);
}

/// The response by another road: Simpson over M itself up to x = 15, where M is 1 within 1e-10;
/// from there on the half-space, of which the part below 15 is taken off.
double by_quadrature(double nu, double r, double a, double h) {
  constexpr int kIntervals = 4000;
  const double step = 15.0 / kIntervals;
  double layer = 0.0;
  double half_space = 0.0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double x = i * step;
    const double y = a / h * x;
    const double disc = y > 0.0 ? 2.0 * std::cyl_bessel_j(1.0, y) / y : 1.0;
    const double wave = std::cyl_bessel_j(0.0, r / h * x);
    const double weight = (i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * step / 3.0;
    layer += weight * printed_m(nu, x) * disc * wave;
    half_space += weight * disc * wave;
  }
  const double scale = (1.0 - nu) / (2.0 * std::numbers::pi * h);
  return scale * (layer - half_space) + 2.0 * (1.0 - nu) * disc_response(r, a);
}

TEST(LayeredResponse, MeetsTheHankelIntegral) {
  for (const double nu : {0.0, 0.3, 0.45, 0.5}) {
    const LayerKernel& kernel = layer_kernel(nu);
    for (const double a : {0.1, 0.33, 1.05, 2.0, 3.0}) {
      const double centre = layered_response(kernel, 0.0, a, 1.0);
      for (const double r : {0.0, 0.17, 0.5, 1.3, 2.95, 5.0, 9.1}) {
        EXPECT_NEAR(layered_response(kernel, r, a, 1.0), by_quadrature(nu, r, a, 1.0),
                    1e-5 * centre)
            << "nu " << nu << " r " << r << " a " << a;
      }
    }
  }
}

TEST(LayeredResponse, ThickLayerIsAHalfSpace) {
  const LayerKernel& kernel = layer_kernel(0.4);
  for (const double r : {0.0, 0.7, 4.0}) {
    const double half_space = half_space_response(0.4, r, 1.0);
    EXPECT_NEAR(half_space, 1.2 * disc_response(r, 1.0), 1e-15);
    EXPECT_DOUBLE_EQ(layered_response(kernel, r, 1.0, std::numeric_limits<double>::infinity()),
                     half_space);
    EXPECT_NEAR(layered_response(kernel, r, 1.0, 1e5), half_space,
                2e-5 * half_space_response(0.4, 0.0, 1.0));
  }
}

TEST(LayeredResponse, WidePressureSquashesTheLayerLikeAnOedometer) {
  // One-dimensional strain: u = p h (1 - 2 nu) / (2 G (1 - nu)), p = 1 / (pi a^2); both on the
  // table and beyond it.
  const double nu = 0.3;
  for (const double a : {3.5, 20.0}) {
    const double expected = (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)) / (std::numbers::pi * a * a);
    EXPECT_NEAR(layered_response(layer_kernel(nu), 0.0, a, 1.0), expected, 0.01 * expected) << a;
  }
}

TEST(LayeredResponse, IncompressibleLayerKeepsItsVolume) {
  // What is pushed in comes up elsewhere: 2 pi Int u r dr = 0; for other nu it is that of the
  // oedometer, h (1 - 2 nu) / (2 (1 - nu)) per newton.
  for (const double nu : {0.5, 0.2}) {
    const LayerKernel& kernel = layer_kernel(nu);
    const double h = 2.0;
    double volume = 0.0;
    double pushed = 0.0;
    const double step = 0.002;
    for (double r = 0.5 * step; r < 22.0; r += step) {
      const double ring = 2.0 * std::numbers::pi * r * step * layered_response(kernel, r, 1.0, h);
      volume += ring;
      pushed += std::abs(ring);
    }
    EXPECT_NEAR(volume, h * (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)), 2e-3 * pushed) << nu;
  }
}

TEST(LayeredResponse, BulgesBesideTheLoadAndDiesOut) {
  const LayerKernel& kernel = layer_kernel(0.5);
  EXPECT_LT(layered_response(kernel, 2.0, 0.3, 1.5), 0.0);
  EXPECT_EQ(layered_response(kernel, 30.0, 0.3, 1.5), 0.0);
  // No visible step where it is cut off.
  EXPECT_LT(std::abs(layered_response(kernel, 15.2, 0.3, 1.5)),
            1e-5 * layered_response(kernel, 0.0, 0.3, 1.5));
}

TEST(LayeredResponse, ScalesWithLength) {
  const LayerKernel& kernel = layer_kernel(0.45);
  EXPECT_NEAR(layered_response(kernel, 3.0, 1.0, 2.0),
              7.0 * layered_response(kernel, 21.0, 7.0, 14.0), 1e-12);
}

TEST(LayeredResponse, IsContinuousAtTheEndsOfTheTable) {
  const LayerKernel& kernel = layer_kernel(0.5);
  for (const double r : {0.0, 2.0, 5.0}) {
    EXPECT_NEAR(layered_response(kernel, r, 4.0 - 1e-9, 1.0),
                layered_response(kernel, r, 4.0 + 1e-9, 1.0), 5e-7);
  }
  EXPECT_TRUE(std::isfinite(layered_response(kernel, 0.3, 1.0, 1e-9)));
}

TEST(LayeredResponse, SourceGivesTheSame) {
  const LayerKernel& kernel = layer_kernel(0.5);
  for (const double a : {0.2, 3.0, 9.0, 15.99}) {
    const LayerSource source(kernel, a, 4.0);
    for (const double r : {0.0, 0.1, 3.0, 11.0, 40.0, 55.98, 55.99, 60.0}) {
      EXPECT_NEAR(source.at(r), layered_response(kernel, r, a, 4.0), 1e-15) << a << ' ' << r;
    }
  }
}

TEST(LayeredResponse, MatricesOnLatticesArePositiveDefinite) {
  for (const double nu : {0.5, 0.3}) {
    for (const double spacing : {0.4, 1.0, 2.5}) {
      for (const double h : {1.0, 3.0, 20.0}) {
        constexpr int kSide = 14;
        const double a = spacing * std::sqrt(std::sqrt(3.0) / 2.0 / std::numbers::pi);
        const LayerSource source(layer_kernel(nu), a, h);
        Eigen::MatrixXd R(kSide * kSide, kSide * kSide);
        for (int i = 0; i < kSide * kSide; ++i) {
          for (int j = 0; j < kSide * kSide; ++j) {
            const double u = i % kSide - j % kSide;
            const double v = i / kSide - j / kSide;
            R(i, j) = source.at(spacing * std::hypot(u + 0.5 * v, std::sqrt(0.75) * v));
          }
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(R, Eigen::EigenvaluesOnly);
        EXPECT_GT(eigen.eigenvalues().minCoeff(), 1e-4 * R(0, 0))
            << "nu " << nu << " spacing " << spacing << " h " << h;
      }
    }
  }
}

TEST(LayerKernelCache, GivesOneKernelToAllThreads) {
  std::vector<const LayerKernel*> seen(4);
  {
    std::vector<std::jthread> threads;
    for (auto& slot : seen) threads.emplace_back([&slot] { slot = &layer_kernel(0.123); });
  }
  for (const LayerKernel* kernel : seen) EXPECT_EQ(kernel, &layer_kernel(0.123));
  EXPECT_NE(&layer_kernel(0.123), &layer_kernel(0.5));
}

TEST(LayerKernelCache, RefusesImpossibleMaterial) {
  for (const double nu : {-0.1, 0.51, std::nan("")}) {
    EXPECT_THAT([&] { layer_kernel(nu); },
                testing::ThrowsMessage<UsageError>(testing::HasSubstr("0 to 0.5 is required")));
  }
}

}  // namespace
}  // namespace palmar::contact
