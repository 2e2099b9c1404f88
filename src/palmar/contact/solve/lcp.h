// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

namespace palmar::contact {

/// Frictionless contact of one sub-active skin region with a rigid product.
///
/// Find vertex forces p [N] and gaps s [mm], both of size m, with
///
///     s = R p + d,   s >= 0,   p >= 0,   s_i p_i = 0.
///
/// R(i, j) [mm/N] is how far vertex i retreats from the product under 1 N at vertex j; d [mm] is
/// the signed distance before contact, negative inside the product. The solution exists and is
/// unique for every d if R is a P-matrix (all principal minors positive), as every symmetric
/// positive definite R is. Small displacements, no friction.
///
/// Source: Xie 2014, eq. (3-13), (3-14); Cottle, Pang, Stone 1992, section 3.3.
struct ContactProblem {
  Eigen::MatrixXd response;  ///< R, m x m, mm/N
  Eigen::VectorXd distance;  ///< d, m, mm

  /// Throws UsageError on a non-square R, unequal sizes or an entry that is not finite.
  void check() const;
  /// As check(), without looking through R.
  void check_sizes() const;
};

enum class LcpStatus {
  kSolved,
  kRayTermination,  ///< Lemke's method ended on a ray: no solution if R is copositive-plus
  kPivotLimit,      ///< no solution within the allowed number of pivots
};

struct ContactSolution {
  LcpStatus status = LcpStatus::kPivotLimit;
  Eigen::VectorXd force;               ///< p, m, N; all zero unless solved
  Eigen::VectorXd gap;                 ///< s = R p + d, m, mm, recomputed from the inputs
  int pivots = 0;                      ///< principal pivots: block exchanges or single exchanges
  double complementarity_error = 0.0;  ///< max |s_i p_i|, N mm, recomputed
  double relative_residual = 0.0;  ///< max |min(s_i / max|d|, p_i / max|p|)|, recomputed; no unit
};

struct LcpOptions {
  bool is_symmetric = true;       ///< R is symmetric: Cholesky instead of LU
  int max_fruitless_blocks = 10;  ///< block exchanges without fewer infeasibilities before single
                                  ///< exchanges take over (Judice, Pires 1994 use 10)
  std::optional<int> max_pivots;  ///< unset: 100 + 10 m
  void check() const;             ///< throws UsageError: field, value, allowed range
};

/// Block principal pivoting: exchanges all infeasible variables at once; while that brings no
/// progress, exchanges only the one with the largest index (Murty's rule), which ends after a
/// finite number of pivots for every P-matrix. Two to six pivots are usual for skin contact.
/// Variables within rounding of zero count as feasible; a matrix that is not a P-matrix may end in
/// kPivotLimit, then try Lemke's method. Only the columns of R that come into contact are read; one
/// that is not finite ends in kPivotLimit. Throws UsageError as ContactProblem::check_sizes().
///
/// Source: Judice, Pires 1994 (Computers & Operations Research 21); Kostreva 1978; Murty 1974.
ContactSolution solve_contact(const ContactProblem& problem, const LcpOptions& options = {});

/// Fills gap, complementarity_error and relative_residual of a solution from its force.
void recompute_residual(const ContactProblem& problem, ContactSolution& solution);

}  // namespace palmar::contact
