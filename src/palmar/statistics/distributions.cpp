// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/distributions.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "palmar/core/error.h"

namespace palmar::statistics {
namespace {

namespace bm = boost::math;

/// Double precision throughout, in an integrand that is called a thousand times for an interval.
using DoubleOnly = bm::policies::policy<bm::policies::promote_double<false>>;

double quick_normal_cdf(double z) {
  return bm::cdf(bm::normal_distribution<double, DoubleOnly>(), z);
}

/// P(T <= t) of Student's t with any non-centrality d, t >= 0: the mean of P(Z <= t s - d) over
/// s = sqrt(chi2 / df), which is integrated where that probability is neither 0 nor 1 to double
/// precision; above, it is 1. The series of boost's non_central_t end at a non-centrality of
/// about 38.
class NoncentralT {
 public:
  NoncentralT(double t, double df)
      : t_(t),
        df_(df),
        chi_squared_(df),
        lowest_(std::sqrt(bm::quantile(chi_squared_, kRare) / df)),
        highest_(std::sqrt(bm::quantile(bm::complement(chi_squared_, kRare)) / df)),
        log_scale_(std::log(2.0) + 0.5 * df * std::log(0.5 * df) - std::lgamma(0.5 * df)) {}

  double cdf(double d) const {
    if (t_ == 0.0) return normal_cdf(-d);
    constexpr double kFar = 9.0;  // P(Z > 9) is 1e-19
    const double low = std::clamp((d - kFar) / t_, lowest_, highest_);
    const double high = std::clamp((d + kFar) / t_, lowest_, highest_);
    const double above = bm::cdf(bm::complement(chi_squared_, df_ * high * high));
    if (!(low < high)) return above;
    const auto weighted = [&](double s) {
      return quick_normal_cdf(t_ * s - d) *
             std::exp(log_scale_ + (df_ - 1.0) * std::log(s) - 0.5 * df_ * s * s);
    };
    return above +
           bm::quadrature::gauss_kronrod<double, 31>::integrate(weighted, low, high, 12, 1e-12);
  }

 private:
  static constexpr double kRare =
      1e-18;  ///< s is below lowest_, and above highest_, with this probability
  double t_, df_;
  bm::chi_squared chi_squared_;
  double lowest_, highest_;
  double log_scale_;  ///< of the density of s
};

}  // namespace

double normal_cdf(double z) { return bm::cdf(bm::normal(), z); }

double normal_quantile(double p) { return bm::quantile(bm::normal(), p); }

double student_two_sided(double t, double df) {
  return 2.0 * bm::cdf(bm::complement(bm::students_t(df), std::abs(t)));
}

double student_quantile(double p, double df) { return bm::quantile(bm::students_t(df), p); }

double fisher_upper(double f, double df1, double df2) {
  return bm::cdf(bm::complement(bm::fisher_f(df1, df2), f));
}

double noncentrality_at(double t, double df, double p) {
  if (t < 0.0) return -noncentrality_at(-t, df, 1.0 - p);
  const NoncentralT law(t, df);
  // P falls with d. Bracket the root about t first.
  double step = 1.0 + 0.1 * t;
  double low = t - step;
  double high = t + step;
  while (law.cdf(low) < p) low -= (step *= 2.0);
  step = 1.0 + 0.1 * t;
  while (law.cdf(high) > p) high += (step *= 2.0);
  std::uintmax_t steps = 200;
  const auto root = bm::tools::toms748_solve([&](double d) { return law.cdf(d) - p; }, low, high,
                                             bm::tools::eps_tolerance<double>(50), steps);
  return 0.5 * (root.first + root.second);
}

void check_level(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw UsageError("confidence level " + std::to_string(level) +
                     "; more than 0 and less than 1 is allowed");
  }
}

}  // namespace palmar::statistics
