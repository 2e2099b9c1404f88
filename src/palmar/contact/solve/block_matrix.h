// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace palmar::contact {

/// Symmetric positive definite matrix in single precision, sparse by dense blocks, and its solution
/// by conjugate gradients with the Cholesky factors of the diagonal blocks as preconditioner. Inner
/// solver of ContactSystem, which refines the answer in double precision.
///
/// Vectors have padded_size() entries: each block's rows begin at a multiple of eight, and what
/// lies beyond its last row is zero. All sums run in the same order with and without vector
/// instructions, so the answer doesn't depend on the processor.
class BlockMatrix {
 public:
  /// Begins a matrix with blocks of these sizes on its diagonal; no entries yet. Keeps its memory.
  void begin(const std::vector<int>& block_sizes);
  /// Makes room for the entries between two blocks (in both orders if both are wanted).
  void add_block(int row_block, int column_block);
  /// To be called once after the last add_block(): allocates and clears.
  void allocate();
  /// Makes this the principal part of another matrix: of its block b the rows kept[b] (ascending);
  /// blocks without any are left out. To be factored again.
  void take_part(const BlockMatrix& whole, const std::vector<std::vector<int>>& kept);
  /// Where the values of a block (that has been added) stand: entry (i, j), counted within the
  /// block, at [j * stride(row_block) + i].
  float* values(int row_block, int column_block) {
    return value_.data() + block_[place_[pair(row_block, column_block)]].value;
  }
  std::size_t stride(int row_block) const;
  bool has_block(int row_block, int column_block) const {
    return place_[pair(row_block, column_block)] != kNone;
  }
  /// Factors the diagonal blocks; false if one isn't positive definite.
  bool factor();

  std::size_t padded_size() const { return padded_; }
  /// Where row i of a block stands in a vector.
  std::size_t row(int block, int i) const { return start_[block] + static_cast<std::size_t>(i); }

  /// x with |A x - b| <= tolerance |b|, from x = 0; `iterations` is added to. False if A turns out
  /// not to be positive definite, or after 500 iterations.
  /// With `also`, A is this matrix plus what also(x, y) adds to y, symmetric.
  using AddProduct = std::function<void(const std::vector<float>& x, std::vector<float>& y)>;
  bool solve(const std::vector<float>& b, double tolerance, std::vector<float>& x, int& iterations,
             const AddProduct& also = {});
  /// The same of several b, side by side, so that the matrix is read once for all of them; each x
  /// is what solve() gives for it.
  using Vectors = std::vector<std::vector<float>>;
  bool solve(const Vectors& b, double tolerance, Vectors& x, int& iterations,
             const AddProduct& also = {});
  /// y = A x.
  void multiply(const std::vector<float>& x, std::vector<float>& y) const;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Block {
    int row = 0, column = 0;
    std::size_t value = 0;   // columns one after the other
    std::size_t stride = 0;  // of a column: rows, padded
  };
  void make_room();
  std::size_t pair(int row_block, int column_block) const {
    return static_cast<std::size_t>(row_block) * sizes_.size() + column_block;
  }
  /// Of one solution, step by step.
  struct Gradient {
    std::vector<float> r, z, q, d;
    double goal = 0.0, rz = 0.0;
  };
  void multiply(std::vector<Gradient*>& of) const;      ///< q = A d
  void precondition(std::vector<Gradient*>& of) const;  ///< A z = r, roughly

  std::vector<int> sizes_;
  std::vector<std::size_t> start_;
  std::size_t padded_ = 0;
  std::vector<Block> block_;
  std::vector<std::size_t> place_;  // per pair of blocks: in block_
  std::vector<float> value_;
  std::vector<std::size_t> factor_start_;  // per diagonal block
  std::vector<float> lower_;               // factors by column, diagonal inverted
  std::vector<float> upper_;               // the same by row
  std::vector<Gradient> gradient_;
};

}  // namespace palmar::contact
