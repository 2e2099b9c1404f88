// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/statistics/distributions.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <exception>
#include <string>

#include "palmar/core/error.h"

namespace palmar {
namespace {

namespace bm = boost::math;

/// P(T <= t) with non-centrality d. Beyond what the series of the library reach, where the
/// distribution is all but normal: Johnson & Welch 1940 (Abramowitz & Stegun 26.7.10).
double noncentral_cdf(double t, double df, double d) {
  const bool is_far = std::abs(d) > 35.0 || std::abs(t) > 1e3;
  if (!is_far) {
    try {
      const double p = bm::cdf(bm::non_central_t(df, d), t);
      if (std::isfinite(p)) return p;
    } catch (const std::exception&) {
      // The series didn't converge; the approximation follows.
    }
  }
  const double shift = 1.0 - 1.0 / (4.0 * df);
  return normal_cdf((t * shift - d) / std::sqrt(1.0 + t * t / (2.0 * df)));
}

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
  // P falls with d. Bracket the root about t, then halve until the ends are neighbours: some sixty
  // steps, and no slope is needed.
  double step = 1.0 + 0.1 * std::abs(t);
  double low = t - step;
  double high = t + step;
  while (noncentral_cdf(t, df, low) < p) low -= (step *= 2.0);
  step = 1.0 + 0.1 * std::abs(t);
  while (noncentral_cdf(t, df, high) > p) high += (step *= 2.0);
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (noncentral_cdf(t, df, middle) > p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

void check_level(double level) {
  if (!(level > 0.0 && level < 1.0)) {
    throw UsageError("confidence level " + std::to_string(level) +
                     "; more than 0 and less than 1 is allowed");
  }
}

}  // namespace palmar
