// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/contact_system.h"

#include <algorithm>
#include <cmath>

#include "palmar/contact/lcp.h"
#include "palmar/contact/lemke.h"

namespace palmar {
namespace {

constexpr double kLast = 1e-12;  // relative residual of the last solution
constexpr double kFirst = 1e-3;  // of a solution whose set is going to change
constexpr int kMostIterations = 2000;
constexpr int kMaxFruitless = 8;  // exchanges of blocks without progress before single ones
constexpr int kMostPivots = 400;
constexpr int kMostDense = 3000;  // rows that the last resort can take

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum[4] = {};
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += a[i + k] * b[i + k];
  }
  for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Sum of value[k] x[column[k]] over a row.
double row_times(const int* column, const float* value, std::size_t count, const double* x) {
  double sum[4] = {};
  std::size_t k = 0;
  for (; k + 4 <= count; k += 4) {
    for (std::size_t c = 0; c < 4; ++c) {
      sum[c] += static_cast<double>(value[k + c]) * x[column[k + c]];
    }
  }
  for (; k < count; ++k) sum[0] += static_cast<double>(value[k]) * x[column[k]];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

}  // namespace

SkinPatches skin_patches(const SkinGeometry& skin, int size) {
  SkinPatches result;
  const int n = skin.vertex_count();
  result.patch.assign(static_cast<std::size_t>(n), -1);
  std::vector<int> front;
  for (int seed = 0; seed < n; ++seed) {
    if (result.patch[static_cast<std::size_t>(seed)] >= 0) continue;
    front.assign(1, seed);
    result.patch[static_cast<std::size_t>(seed)] = result.count;
    for (std::size_t k = 0; k < front.size() && static_cast<int>(front.size()) < size; ++k) {
      for (const int w : skin.neighbours(front[k])) {
        int& patch = result.patch[static_cast<std::size_t>(w)];
        if (patch >= 0 || static_cast<int>(front.size()) >= size) continue;
        patch = result.count;
        front.push_back(w);
      }
    }
    ++result.count;
  }
  return result;
}

void ContactSystem::assemble(const SkinResponse& response, const std::vector<int>& vertices,
                             const std::vector<Region>* region) {
  for (const int v : vertex_) local_[static_cast<std::size_t>(v)] = -1;
  local_.resize(response.begin.size() - 1, -1);
  vertex_ = vertices;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    local_[static_cast<std::size_t>(vertex_[i])] = static_cast<int>(i);
  }
  std::size_t most = 0;
  for (const int v : vertex_) {
    const auto j = static_cast<std::size_t>(v);
    most += response.begin[j + 1] - response.begin[j];
  }
  begin_.assign(1, 0);
  column_.resize(most);
  value_.resize(most);
  std::size_t count = 0;
  for (const int v : vertex_) {
    const auto j = static_cast<std::size_t>(v);
    const std::size_t end = response.begin[j + 1];
    for (std::size_t k = response.begin[j]; k < end; ++k) {
      // Written in any case, kept only if the vertex takes part: no branch.
      const int w = response.vertex[k];
      const int row = local_[static_cast<std::size_t>(w)];
      column_[count] = row;
      value_[count] = response.response[k];
      const bool is_kept =
          row >= 0 && (region == nullptr || (*region)[static_cast<std::size_t>(w)] == (*region)[j]);
      count += is_kept ? 1 : 0;
    }
    begin_.push_back(count);
  }
  column_.resize(count);
  value_.resize(count);
}

void ContactSystem::add(const std::vector<double>& diagonal, const std::vector<Entry>& entries) {
  const auto m = static_cast<std::size_t>(size());
  std::vector<std::vector<std::pair<int, double>>> rows(m);
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      rows[i].emplace_back(column_[k], static_cast<double>(value_[k]));
    }
    rows[i].emplace_back(static_cast<int>(i), diagonal[i]);
  }
  for (const Entry& entry : entries) {
    rows[static_cast<std::size_t>(entry.row)].emplace_back(entry.column, entry.value);
    rows[static_cast<std::size_t>(entry.column)].emplace_back(entry.row, entry.value);
  }
  column_.clear();
  value_.clear();
  begin_.assign(1, 0);
  for (auto& row : rows) {
    std::stable_sort(row.begin(), row.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t k = 0; k < row.size();) {
      double sum = 0.0;
      const int column = row[k].first;
      for (; k < row.size() && row[k].first == column; ++k) sum += row[k].second;
      column_.push_back(column);
      value_.push_back(static_cast<float>(sum));
    }
    begin_.push_back(column_.size());
  }
}

bool ContactSystem::set_contact(const std::vector<char>& in_contact) {
  const int m = size();
  set_.clear();
  place_.assign(static_cast<std::size_t>(m), -1);
  for (int i = 0; i < m; ++i) {
    if (!in_contact[static_cast<std::size_t>(i)]) continue;
    place_[static_cast<std::size_t>(i)] = static_cast<int>(set_.size());
    set_.push_back(i);
  }
  set_begin_.assign(1, 0);
  set_column_.resize(column_.size());
  set_value_.resize(column_.size());
  std::size_t count = 0;
  for (const int i : set_) {
    const std::size_t end = begin_[static_cast<std::size_t>(i) + 1];
    for (std::size_t k = begin_[static_cast<std::size_t>(i)]; k < end; ++k) {
      const int place = place_[static_cast<std::size_t>(column_[k])];
      set_column_[count] = place;
      set_value_[count] = value_[k];
      count += place >= 0 ? 1 : 0;
    }
    set_begin_.push_back(count);
  }

  // Rows of one patch, in ascending order of patch.
  block_row_.resize(set_.size());
  for (std::size_t k = 0; k < set_.size(); ++k) block_row_[k] = static_cast<int>(k);
  const auto patch_of = [&](int place) {
    const int row = set_[static_cast<std::size_t>(place)];
    return patches_->patch[static_cast<std::size_t>(vertex_[static_cast<std::size_t>(row)])];
  };
  std::stable_sort(block_row_.begin(), block_row_.end(),
                   [&](int a, int b) { return patch_of(a) < patch_of(b); });
  block_.clear();
  factor_.clear();
  std::vector<int> inside(set_.size(), -1);
  for (std::size_t first = 0; first < block_row_.size();) {
    std::size_t last = first;
    const int patch = patch_of(block_row_[first]);
    while (last < block_row_.size() && patch_of(block_row_[last]) == patch) ++last;
    const int n = static_cast<int>(last - first);
    block_.push_back({static_cast<int>(first), n, factor_.size()});
    factor_.resize(factor_.size() + static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0.0);
    double* const L = factor_.data() + block_.back().factor;
    for (int i = 0; i < n; ++i) inside[static_cast<std::size_t>(block_row_[first + i])] = i;
    for (int i = 0; i < n; ++i) {
      const auto row = static_cast<std::size_t>(block_row_[first + i]);
      for (std::size_t k = set_begin_[row]; k < set_begin_[row + 1]; ++k) {
        const int j = inside[static_cast<std::size_t>(set_column_[k])];
        if (j >= 0 && j <= i) L[i * n + j] = static_cast<double>(set_value_[k]);
      }
    }
    for (int i = 0; i < n; ++i) inside[static_cast<std::size_t>(block_row_[first + i])] = -1;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) {
        double sum = L[i * n + j];
        for (int k = 0; k < j; ++k) sum -= L[i * n + k] * L[j * n + k];
        L[i * n + j] = sum * L[j * n + j];
      }
      double sum = L[i * n + i];
      for (int k = 0; k < i; ++k) sum -= L[i * n + k] * L[i * n + k];
      if (!(sum > 0.0)) return false;
      L[i * n + i] = 1.0 / std::sqrt(sum);  // the diagonal is inverted
    }
    first = last;
  }
  return true;
}

void ContactSystem::precondition(const std::vector<double>& r, std::vector<double>& z) const {
  double y[256];
  for (const Block& block : block_) {
    const int n = block.size;
    const double* const L = factor_.data() + block.factor;
    const int* const row = block_row_.data() + block.first;
    for (int i = 0; i < n; ++i) {
      double sum = r[static_cast<std::size_t>(row[i])];
      for (int k = 0; k < i; ++k) sum -= L[i * n + k] * y[k];
      y[i] = sum * L[i * n + i];
    }
    for (int i = n - 1; i >= 0; --i) {
      y[i] *= L[i * n + i];
      for (int k = 0; k < i; ++k) y[k] -= L[i * n + k] * y[i];
      z[static_cast<std::size_t>(row[i])] = y[i];
    }
  }
}

bool ContactSystem::conjugate_gradients(double tolerance, int& iterations) {
  const std::size_t n = set_.size();
  const auto multiply = [&](const std::vector<double>& x, std::vector<double>& y) {
    for (std::size_t i = 0; i < n; ++i) {
      y[i] = row_times(set_column_.data() + set_begin_[i], set_value_.data() + set_begin_[i],
                       set_begin_[i + 1] - set_begin_[i], x.data());
    }
  };
  r_.resize(n);
  z_.resize(n);
  q_.resize(n);
  d_.resize(n);
  const double goal = tolerance * std::sqrt(dot(right_, right_));
  multiply(x_, q_);
  for (std::size_t i = 0; i < n; ++i) r_[i] = right_[i] - q_[i];
  if (std::sqrt(dot(r_, r_)) <= goal) return true;
  precondition(r_, z_);
  d_ = z_;
  double rz = dot(r_, z_);
  for (int k = 0; k < kMostIterations; ++k) {
    ++iterations;
    multiply(d_, q_);
    const double curvature = dot(d_, q_);
    if (!(curvature > 0.0)) return false;
    const double step = rz / curvature;
    for (std::size_t i = 0; i < n; ++i) {
      x_[i] += step * d_[i];
      r_[i] -= step * q_[i];
    }
    if (std::sqrt(dot(r_, r_)) <= goal) return true;
    precondition(r_, z_);
    const double next = dot(r_, z_);
    const double share = next / rz;
    rz = next;
    for (std::size_t i = 0; i < n; ++i) d_[i] = z_[i] + share * d_[i];
  }
  return false;
}

void ContactSystem::multiply_all(const std::vector<double>& p, std::vector<double>& s) const {
  const auto m = static_cast<std::size_t>(size());
  s.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    s[i] = row_times(column_.data() + begin_[i], value_.data() + begin_[i],
                     begin_[i + 1] - begin_[i], p.data());
  }
}

void ContactSystem::measure(const std::vector<double>& b, const std::vector<double>& force,
                            std::vector<double>& gap, Outcome& outcome) const {
  multiply_all(force, gap);
  const double b_scale = std::max(largest(b), 1e-300);
  const double p_scale = std::max(largest(force), 1e-300);
  outcome.complementarity = 0.0;
  outcome.relative_residual = 0.0;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    gap[i] += b[i];
    outcome.complementarity = std::max(outcome.complementarity, std::abs(gap[i] * force[i]));
    outcome.relative_residual = std::max(outcome.relative_residual,
                                         std::abs(std::min(gap[i] / b_scale, force[i] / p_scale)));
  }
}

bool ContactSystem::solve_dense(const std::vector<double>& b, std::vector<char>& in_contact,
                                std::vector<double>& force, std::vector<double>& gap,
                                Outcome& outcome) const {
  const int m = size();
  if (m > kMostDense) return false;
  ContactProblem problem;
  problem.response = Eigen::MatrixXd::Zero(m, m);
  problem.distance = Eigen::Map<const Eigen::VectorXd>(b.data(), m);
  for (int i = 0; i < m; ++i) {
    for (std::size_t k = begin_[static_cast<std::size_t>(i)];
         k < begin_[static_cast<std::size_t>(i) + 1]; ++k) {
      problem.response(column_[k], i) = value_[k];
    }
  }
  ContactSolution solution = solve_contact(problem);
  if (solution.status != LcpStatus::kSolved) solution = solve_contact_lemke(problem);
  outcome.pivots += solution.pivots;
  if (solution.status != LcpStatus::kSolved) return false;
  for (int i = 0; i < m; ++i) {
    force[static_cast<std::size_t>(i)] = solution.force[i];
    in_contact[static_cast<std::size_t>(i)] = solution.force[i] > 0.0;
  }
  measure(b, force, gap, outcome);
  return true;
}

ContactSystem::Outcome ContactSystem::solve(const std::vector<double>& b,
                                            std::vector<char>& in_contact,
                                            std::vector<double>& force, std::vector<double>& gap) {
  const auto m = static_cast<std::size_t>(size());
  Outcome outcome;
  force.assign(m, 0.0);
  gap.assign(b.begin(), b.end());
  const double b_scale = largest(b);
  int fewest = static_cast<int>(m) + 1;
  int fruitless_left = kMaxFruitless;
  double tolerance = kFirst;
  bool is_new_set = true;
  std::vector<int> infeasible;
  while (outcome.pivots < kMostPivots) {
    if (is_new_set) {
      if (!set_contact(in_contact)) break;
      right_.resize(set_.size());
      x_.resize(set_.size());
      for (std::size_t k = 0; k < set_.size(); ++k) {
        right_[k] = -b[static_cast<std::size_t>(set_[k])];
        x_[k] = force[static_cast<std::size_t>(set_[k])];
      }
    }
    if (!conjugate_gradients(tolerance, outcome.iterations)) break;
    force.assign(m, 0.0);
    for (std::size_t k = 0; k < set_.size(); ++k) {
      force[static_cast<std::size_t>(set_[k])] = x_[k];
    }
    multiply_all(force, gap);
    const double slack = std::max(10.0 * tolerance, 1e-11);
    const double p_slack = slack * largest(force);
    infeasible.clear();
    for (std::size_t i = 0; i < m; ++i) {
      gap[i] += b[i];
      const bool ok = in_contact[i] ? force[i] >= -p_slack : gap[i] >= -slack * b_scale;
      if (!ok) infeasible.push_back(static_cast<int>(i));
    }
    if (infeasible.empty()) {
      if (tolerance <= kLast) {
        outcome.is_solved = true;
        for (double& p : force) p = std::max(p, 0.0);  // rounding
        measure(b, force, gap, outcome);
        return outcome;
      }
      tolerance = kLast;
      is_new_set = false;
      continue;
    }
    ++outcome.pivots;
    is_new_set = true;
    const int count = static_cast<int>(infeasible.size());
    if (count < fewest) {
      fewest = count;
      fruitless_left = kMaxFruitless;
    } else if (fruitless_left > 0) {
      --fruitless_left;
    } else {
      tolerance = kLast;
      infeasible = {infeasible.back()};
    }
    for (const int i : infeasible) {
      in_contact[static_cast<std::size_t>(i)] = !in_contact[static_cast<std::size_t>(i)];
    }
    // A vertex that has let go starts from no force, as does one that has come to touch.
    for (const int i : infeasible) force[static_cast<std::size_t>(i)] = 0.0;
  }
  outcome.is_solved = solve_dense(b, in_contact, force, gap, outcome);
  if (!outcome.is_solved) {
    force.assign(m, 0.0);
    gap.assign(m, 0.0);
  }
  return outcome;
}

std::optional<std::vector<double>> ContactSystem::solve_on(const std::vector<char>& in_contact,
                                                           const std::vector<double>& right) {
  if (!set_contact(in_contact)) return std::nullopt;
  right_.resize(set_.size());
  x_.assign(set_.size(), 0.0);
  for (std::size_t k = 0; k < set_.size(); ++k) {
    right_[k] = right[static_cast<std::size_t>(set_[k])];
  }
  int iterations = 0;
  if (!conjugate_gradients(kLast, iterations)) return std::nullopt;
  std::vector<double> x(static_cast<std::size_t>(size()), 0.0);
  for (std::size_t k = 0; k < set_.size(); ++k) x[static_cast<std::size_t>(set_[k])] = x_[k];
  return x;
}

}  // namespace palmar
