// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palmar::statistics {

/// Distributions that tests and intervals need, from Boost.Math. Tail probabilities keep their
/// digits however small they are (1e-300 is distinguished from 0).

/// P(Z <= z) of the standard normal distribution.
double normal_cdf(double z);
/// z with P(Z <= z) = p, 0 < p < 1.
double normal_quantile(double p);

/// P(|T| >= |t|) of Student's distribution with `df` > 0 degrees of freedom.
double student_two_sided(double t, double df);
/// t with P(T <= t) = p, 0 < p < 1.
double student_quantile(double p, double df);

/// P(F >= f) of Fisher's distribution; f >= 0.
double fisher_upper(double f, double df1, double df2);

/// The non-centrality d with P(T <= t) = p for Student's non-central distribution with `df` degrees
/// of freedom; it falls as p grows. For the interval of an effect size (Steiger & Fouladi 1997).
double noncentrality_at(double t, double df, double p);

/// The probability between the ends of a two-sided interval; throws UsageError unless 0 < level
/// < 1.
void check_level(double level);

}  // namespace palmar::statistics
