// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/solve/lcp.h"

namespace palmar::contact {

struct LemkeOptions {
  std::optional<int> max_pivots;   ///< unset: 100 + 10 m
  double pivot_tolerance = 1e-12;  ///< relative to max |R|; smaller counts as 0
  void check() const;              ///< throws UsageError: field, value, allowed range
};

/// Lemke's complementary pivot method with covering vector e: the solver of Xie 2014, kept as the
/// reference for solve_contact() and as its fallback. Ties in the ratio test are broken
/// lexicographically, so degenerate problems don't cycle. It processes every strictly copositive R
/// (no negative entry and a positive diagonal suffice); for copositive-plus R, ray termination
/// means that the problem has no solution, for other R only that the method found none. Not finding
/// a solution is a status, never an exception. Throws UsageError as ContactProblem::check().
///
/// Source: Cottle, Pang, Stone 1992, sections 4.4 (method) and 4.9 (lexicographic rule).
ContactSolution solve_contact_lemke(const ContactProblem& problem,
                                    const LemkeOptions& options = {});

}  // namespace palmar::contact
