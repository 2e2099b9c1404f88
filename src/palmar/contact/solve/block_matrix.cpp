// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/block_matrix.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/processor.h"

namespace palmar::contact {
namespace {

constexpr int kMostIterations = 500;
constexpr std::size_t kPad = 8;

std::size_t padded(std::size_t n) { return (n + kPad - 1) / kPad * kPad; }

// The three loops that take the time. Each is written once and compiled twice: for the processor at
// hand and for any other. No sum is split, so both give the same bits.
#if defined(__x86_64__) && defined(__GNUC__)
#define PALMAR_ALWAYS_INLINE inline __attribute__((always_inline))
#else
#define PALMAR_ALWAYS_INLINE inline
#endif

/// y += B x for a block of `columns` columns of `rows` (a multiple of eight) entries.
PALMAR_ALWAYS_INLINE void add_product_body(const float* B, std::size_t rows, std::size_t columns,
                                           const float* x, float* y) {
  std::size_t j = 0;
  for (; j + 4 <= columns; j += 4) {
    const float* const b = B + j * rows;
    const float x0 = x[j], x1 = x[j + 1], x2 = x[j + 2], x3 = x[j + 3];
    for (std::size_t i = 0; i < rows; ++i) {
      y[i] += (b[i] * x0 + b[i + rows] * x1) + (b[i + 2 * rows] * x2 + b[i + 3 * rows] * x3);
    }
  }
  for (; j < columns; ++j) {
    const float* const b = B + j * rows;
    for (std::size_t i = 0; i < rows; ++i) y[i] += b[i] * x[j];
  }
}

/// y -= x b on n entries.
PALMAR_ALWAYS_INLINE void subtract_body(const float* b, std::size_t n, float x, float* y) {
  for (std::size_t i = 0; i < n; ++i) y[i] -= b[i] * x;
}

/// Both triangular solutions of one block; y in place.
PALMAR_ALWAYS_INLINE void substitute_body(const float* lower, const float* upper, std::size_t n,
                                          std::size_t stride, float* y) {
  for (std::size_t j = 0; j < n; ++j) {
    y[j] *= lower[j * stride + j];
    subtract_body(lower + j * stride + j + 1, n - j - 1, y[j], y + j + 1);
  }
  for (std::size_t i = n; i-- > 0;) {
    y[i] *= upper[i * stride + i];
    subtract_body(upper + i * stride, i, y[i], y);
  }
}

PALMAR_AVX2 void add_product_avx2(const float* B, std::size_t rows, std::size_t columns,
                                  const float* x, float* y) {
  add_product_body(B, rows, columns, x, y);
}
PALMAR_AVX2 void substitute_avx2(const float* lower, const float* upper, std::size_t n,
                                 std::size_t stride, float* y) {
  substitute_body(lower, upper, n, stride, y);
}
void add_product_any(const float* B, std::size_t rows, std::size_t columns, const float* x,
                     float* y) {
  add_product_body(B, rows, columns, x, y);
}
void substitute_any(const float* lower, const float* upper, std::size_t n, std::size_t stride,
                    float* y) {
  substitute_body(lower, upper, n, stride, y);
}

double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum[kPad] = {};
  for (std::size_t i = 0; i < a.size(); i += kPad) {
    for (std::size_t k = 0; k < kPad; ++k) {
      sum[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
    }
  }
  return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + ((sum[4] + sum[5]) + (sum[6] + sum[7]));
}

}  // namespace

void BlockMatrix::begin(const std::vector<int>& block_sizes) {
  sizes_ = block_sizes;
  start_.clear();
  padded_ = 0;
  for (const int n : sizes_) {
    start_.push_back(padded_);
    padded_ += padded(n);
  }
  block_.clear();
  place_.assign(sizes_.size() * sizes_.size(), kNone);
}

void BlockMatrix::add_block(int row_block, int column_block) {
  place_[pair(row_block, column_block)] = block_.size();
  block_.push_back({row_block, column_block, 0, 0});
}

void BlockMatrix::allocate() {
  make_room();
  std::fill(value_.begin(), value_.end(), 0.0F);
}

void BlockMatrix::make_room() {
  std::size_t size = 0;
  for (Block& block : block_) {
    block.value = size;
    block.stride = stride(block.row);
    size += block.stride * static_cast<std::size_t>(sizes_[block.column]);
  }
  value_.resize(size);
}

void BlockMatrix::take_part(const BlockMatrix& whole, const std::vector<std::vector<int>>& kept) {
  std::vector<int> sizes;
  std::vector<int> number(kept.size(), -1);  // in this matrix
  for (std::size_t b = 0; b < kept.size(); ++b) {
    if (kept[b].empty()) continue;
    number[b] = static_cast<int>(sizes.size());
    sizes.push_back(static_cast<int>(kept[b].size()));
  }
  begin(sizes);
  for (const Block& block : whole.block_) {
    const int row = number[block.row];
    const int column = number[block.column];
    if (row >= 0 && column >= 0) add_block(row, column);
  }
  make_room();
  std::size_t next = 0;  // blocks come in the same order
  for (const Block& from : whole.block_) {
    const std::vector<int>& rows = kept[from.row];
    const std::vector<int>& columns = kept[from.column];
    if (rows.empty() || columns.empty()) continue;
    const Block& to = block_[next++];
    float* target = value_.data() + to.value;
    const bool has_all_rows = rows.size() == static_cast<std::size_t>(whole.sizes_[from.row]);
    for (const int j : columns) {
      const float* const source =
          whole.value_.data() + from.value + static_cast<std::size_t>(j) * from.stride;
      if (has_all_rows) {
        target = std::copy(source, source + from.stride, target);
        continue;
      }
      for (std::size_t i = 0; i < rows.size(); ++i) target[i] = source[rows[i]];
      for (std::size_t i = rows.size(); i < to.stride; ++i) target[i] = 0.0F;
      target += to.stride;
    }
  }
}

std::size_t BlockMatrix::stride(int row_block) const { return padded(sizes_[row_block]); }

bool BlockMatrix::factor() {
  factor_start_.clear();
  std::size_t size = 0;
  for (const int n : sizes_) {
    factor_start_.push_back(size);
    size += static_cast<std::size_t>(n) * padded(n);
  }
  lower_.assign(size, 0.0F);
  upper_.assign(size, 0.0F);
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    const auto n = static_cast<std::size_t>(sizes_[b]);
    const std::size_t stride = padded(n);
    const Block& block = block_[place_[b * sizes_.size() + b]];
    float* const L = lower_.data() + factor_start_[b];
    float* const U = upper_.data() + factor_start_[b];
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = j; i < n; ++i) {
        L[j * stride + i] = value_[block.value + j * block.stride + i];
      }
    }
    for (std::size_t j = 0; j < n; ++j) {
      float* const column = L + j * stride;
      if (!(column[j] > 0.0F)) return false;
      const float inverse = 1.0F / std::sqrt(column[j]);
      for (std::size_t i = j + 1; i < n; ++i) column[i] *= inverse;
      column[j] = inverse;
      for (std::size_t k = j + 1; k < n; ++k) {
        subtract_body(column + k, n - k, column[k], L + k * stride + k);
      }
    }
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = j; i < n; ++i) U[i * stride + j] = L[j * stride + i];
    }
  }
  return true;
}

void BlockMatrix::multiply(const std::vector<float>& x, std::vector<float>& y) const {
  y.assign(padded_, 0.0F);
  const auto add_product = has_avx2() ? add_product_avx2 : add_product_any;
  for (const Block& block : block_) {
    add_product(value_.data() + block.value, block.stride, sizes_[block.column],
                x.data() + start_[block.column], y.data() + start_[block.row]);
  }
}

void BlockMatrix::multiply(std::vector<Gradient*>& of) const {
  for (Gradient* g : of) g->q.assign(padded_, 0.0F);
  const auto add_product = has_avx2() ? add_product_avx2 : add_product_any;
  for (const Block& block : block_) {
    for (Gradient* g : of) {
      add_product(value_.data() + block.value, block.stride, sizes_[block.column],
                  g->d.data() + start_[block.column], g->q.data() + start_[block.row]);
    }
  }
}

void BlockMatrix::precondition(std::vector<Gradient*>& of) const {
  const auto substitute = has_avx2() ? substitute_avx2 : substitute_any;
  for (Gradient* g : of) g->z = g->r;
  for (std::size_t b = 0; b < sizes_.size(); ++b) {
    const auto n = static_cast<std::size_t>(sizes_[b]);
    for (Gradient* g : of) {
      substitute(lower_.data() + factor_start_[b], upper_.data() + factor_start_[b], n, padded(n),
                 g->z.data() + start_[b]);
    }
  }
}

bool BlockMatrix::solve(const std::vector<float>& b, double tolerance, std::vector<float>& x,
                        int& iterations, const AddProduct& also) {
  Vectors all{b}, found{std::move(x)};
  const bool is_solved = solve(all, tolerance, found, iterations, also);
  x = std::move(found.front());
  return is_solved;
}

bool BlockMatrix::solve(const Vectors& b, double tolerance, Vectors& x, int& iterations,
                        const AddProduct& also) {
  x.resize(b.size());
  gradient_.resize(std::max(gradient_.size(), b.size()));
  std::vector<Gradient*> open;
  for (std::size_t k = 0; k < b.size(); ++k) {
    x[k].assign(padded_, 0.0F);
    Gradient& g = gradient_[k];
    g.r = b[k];
    g.goal = tolerance * std::sqrt(dot(b[k], b[k]));
    if (g.goal > 0.0) open.push_back(&g);
    if (!(g.goal >= 0.0)) return false;
  }
  precondition(open);
  for (Gradient* g : open) {
    g->d = g->z;
    g->rz = dot(g->r, g->z);
  }
  for (int k = 0; k < kMostIterations && !open.empty(); ++k) {
    iterations += static_cast<int>(open.size());
    multiply(open);
    std::size_t left = 0;
    for (Gradient* g : open) {
      if (also) also(g->d, g->q);
      const double curvature = dot(g->d, g->q);
      if (!(curvature > 0.0)) return false;
      const auto step = static_cast<float>(g->rz / curvature);
      std::vector<float>& own = x[static_cast<std::size_t>(g - gradient_.data())];
      for (std::size_t i = 0; i < padded_; ++i) {
        own[i] += step * g->d[i];
        g->r[i] -= step * g->q[i];
      }
      if (std::sqrt(dot(g->r, g->r)) > g->goal) open[left++] = g;
    }
    open.resize(left);
    precondition(open);
    for (Gradient* g : open) {
      const double next = dot(g->r, g->z);
      const auto share = static_cast<float>(next / g->rz);
      g->rz = next;
      for (std::size_t i = 0; i < padded_; ++i) g->d[i] = g->z[i] + share * g->d[i];
    }
  }
  return open.empty();
}

}  // namespace palmar::contact
