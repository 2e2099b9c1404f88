// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "palmar/contact/response/skin_response.h"
#include "palmar/contact/response/sparse_rows.h"
#include "palmar/contact/solve/block_matrix.h"

namespace palmar::contact {

/// Frictionless contact problem of many coupled skin vertices with sparse symmetric responses:
///
///     s = A p + b >= 0,   p >= 0,   s_i p_i = 0
///
/// A [1/mm] is positive definite; b_i = G_i d_i [MPa mm]. (s_i / G_i is the gap.) Multiplying row i
/// by its own shear modulus G_i has made the matrix of the skin symmetric although each row has
/// its own modulus.
///
/// Block principal pivoting (Judice, Pires 1994) over the contact set; each linear system by
/// conjugate gradients in single precision on a BlockMatrix of the skin's patches, refined in
/// double precision. While the set still changes a coarse solution is enough; the last one is
/// refined until no loaded vertex has a gap above 1e-12 of the largest |b|. Single exchanges (Murty
/// 1974) where block exchanges stall; dense block pivoting and Lemke's method as the last resort.
/// Keeps its memory from call to call.
class ContactSystem {
 public:
  explicit ContactSystem(const SkinPatches& patches) : patches_(&patches) {}

  /// Takes the responses among `vertices` (ascending). With `region` (per vertex of the skin), only
  /// those within one region.
  void assemble(const SkinResponse& response, const std::vector<int>& vertices,
                const std::vector<hand::Region>* region);

  /// Takes a symmetric matrix, whose rows are `vertices` (ascending).
  void assemble(const SparseRows& matrix, const std::vector<int>& vertices);

  /// Adds value to the entries (i, j) and (j, i); i != j. Call end_additions() after the last.
  struct Entry {
    int row = 0, column = 0;
    double value = 0.0;
  };
  /// Adds to A: `diagonal` per row and the symmetric entries off the diagonal (row > column).
  void add(const std::vector<double>& diagonal, const std::vector<Entry>& entries);

  struct Outcome {
    bool is_solved = false;
    int pivots = 0;                  ///< exchanges of the contact set
    int iterations = 0;              ///< of conjugate gradients, all together
    double complementarity = 0;      ///< max |s_i p_i|, recomputed, N MPa mm
    double relative_residual = 0.0;  ///< max |min(s_i / max|b|, p_i / max p)|, recomputed
    ContactFallbacks fallbacks;      ///< of this system
  };
  /// Solves from the guess in_contact and, if it has the right size, the guess `force`; leaves the
  /// contact set, p in `force` [N] and s in `gap` [MPa mm]. Unsolved: both zero. `accuracy`: gaps
  /// that loaded vertices may have in the end, in parts of the largest |b|.
  Outcome solve(const std::vector<double>& b, std::vector<char>& in_contact,
                std::vector<double>& force, std::vector<double>& gap,
                double accuracy = kBestAccuracy);
  static constexpr double kBestAccuracy = 1e-12;

  /// x of A_FF x = right_F on the contact set F, zero elsewhere, to `accuracy` of the largest
  /// |right|. Nothing if A_FF isn't positive definite.
  std::optional<std::vector<double>> solve_on(const std::vector<char>& in_contact,
                                              const std::vector<double>& right,
                                              double accuracy = kBestAccuracy);
  /// The same of several right sides, a column each, at once; as exact as single precision at best.
  std::optional<Eigen::MatrixXd> solve_roughly_on(const std::vector<char>& in_contact,
                                                  const Eigen::MatrixXd& right, double accuracy);
  static constexpr double kSurely = 1e-4;  ///< that exact is solve_roughly_on() always
  /// A x.
  std::vector<double> times(const std::vector<double>& x) const;

  int size() const { return static_cast<int>(begin_.size()) - 1; }
  std::size_t entry_count() const { return column_.size(); }

 private:
  void make_blocks();
  bool set_contact(const std::vector<char>& in_contact);
  BlockMatrix::AddProduct far_on_set() const;
  bool correct(double tolerance, const std::vector<double>& residual, std::vector<double>& x,
               int& iterations);
  void assemble_far(const SkinResponse& response);
  template <typename Force, typename Add>
  void add_far(const std::vector<int>& rows, const Force& force, const Add& add) const;
  void multiply_all(const std::vector<double>& p, std::vector<double>& s) const;
  bool solve_dense(const std::vector<double>& b, std::vector<char>& in_contact,
                   std::vector<double>& force, std::vector<double>& gap, Outcome& outcome);
  void multiply_roughly(const std::vector<double>& p, std::vector<double>& s);
  void find_gap(const std::vector<double>& b, const std::vector<double>& force, bool is_rough,
                std::vector<double>& gap);
  void take_off_forces(const std::vector<char>& in_contact, bool has_gap,
                       std::vector<double>& force, std::vector<double>& gap) const;
  static void measure(const std::vector<double>& b, const std::vector<double>& force,
                      const std::vector<double>& gap, Outcome& outcome);

  const SkinPatches* patches_;
  std::vector<int> vertex_;  // of each row
  std::vector<int> all_rows_;
  std::vector<int> local_;          // per skin vertex: its row, -1 if none
  std::vector<std::size_t> begin_;  // rows of A
  std::vector<int> column_;
  std::vector<float> value_;
  // The far part: clusters around the rows, and the responses between them.
  bool has_far_ = false;
  std::vector<std::size_t> support_begin_;  // per row
  std::vector<int> support_;                // local cluster
  std::vector<float> support_weight_;
  std::vector<std::size_t> far_begin_;
  std::vector<int> far_column_;
  std::vector<float> far_value_;
  std::vector<int> local_cluster_;  // per cluster of the skin
  mutable std::vector<double> cluster_force_, cluster_moved_;
  struct Place {
    int block = 0;   // in the matrix
    int inside = 0;  // the block
  };
  // A as dense blocks, rows ordered by patch; made when first needed.
  bool has_blocks_ = false;
  std::vector<int> by_patch_;       // rows
  std::vector<std::size_t> first_;  // of each block, in by_patch_
  BlockMatrix all_;
  // The contact set, block by block, and A on it.
  std::vector<char> was_set_;
  bool is_definite_ = false;
  std::vector<int> set_;
  std::vector<std::vector<int>> kept_;  // per block of all_: its rows in the set
  std::vector<Place> place_;            // per row of the set
  BlockMatrix matrix_;
  std::vector<float> right_, step_;
};

}  // namespace palmar::contact
