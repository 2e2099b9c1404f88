// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/solve/contact_system.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "palmar/contact/solve/lcp.h"
#include "palmar/contact/solve/lemke.h"

namespace palmar::contact {
namespace {

constexpr double kFirst = 1e-3;  // by what the first solution on a set lowers the residual
constexpr double kInner = 1e-5;  // by what each further one does; single precision gives as much
constexpr double kUnder = 0.3;   // of the accuracy asked for: errors here are mean squares
constexpr int kMostCorrections = 8;
constexpr double kSinglePrecision = 3e-6;  // of a product, of its largest
constexpr int kMaxFruitless = 8;  // exchanges of blocks without progress before single ones
constexpr int kMostPivots = 400;
constexpr int kMostDense = 3000;  // rows that the last resort can take

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v));
  return most;
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

void ContactSystem::assemble(const SkinResponse& response, const std::vector<int>& vertices,
                             const std::vector<hand::Region>* region) {
  local_.resize(response.begin.size() - 1, -1);
  for (const int v : vertex_) local_[v] = -1;
  vertex_ = vertices;
  for (std::size_t i = 0; i < vertex_.size(); ++i) {
    local_[vertex_[i]] = static_cast<int>(i);
  }
  std::size_t most = 0;
  for (const int v : vertex_) {
    most += response.begin[v + 1] - response.begin[v];
  }
  all_rows_.resize(vertex_.size());
  std::iota(all_rows_.begin(), all_rows_.end(), 0);
  begin_.assign(1, 0);
  column_.resize(most);
  value_.resize(most);
  std::size_t count = 0;
  for (const int v : vertex_) {
    const std::size_t end = response.begin[v + 1];
    for (std::size_t k = response.begin[v]; k < end; ++k) {
      // Written in any case, kept only if the vertex takes part: no branch.
      const int w = response.vertex[k];
      const int row = local_[w];
      column_[count] = row;
      value_[count] = response.response[k];
      const bool is_kept = row >= 0 && (region == nullptr || (*region)[w] == (*region)[v]);
      count += is_kept ? 1 : 0;
    }
    begin_.push_back(count);
  }
  column_.resize(count);
  value_.resize(count);
  has_blocks_ = false;
  assemble_far(response);
}

void ContactSystem::assemble(const SparseRows& matrix, const std::vector<int>& vertices) {
  vertex_ = vertices;
  all_rows_.resize(vertices.size());
  std::iota(all_rows_.begin(), all_rows_.end(), 0);
  begin_ = matrix.begin;
  column_ = matrix.column;
  value_ = matrix.value;
  has_blocks_ = false;
  has_far_ = false;
}

void ContactSystem::assemble_far(const SkinResponse& response) {
  has_far_ = response.has_far();
  if (!has_far_) return;
  local_cluster_.assign(response.cluster_count(), -1);
  std::vector<std::size_t> cluster;  // of each local one
  support_begin_.assign(1, 0);
  support_.clear();
  support_weight_.clear();
  for (const int v : vertex_) {
    for (std::size_t k = response.support_begin[v]; k < response.support_begin[v + 1]; ++k) {
      const auto c = static_cast<std::size_t>(response.support[k]);
      if (local_cluster_[c] < 0) {
        local_cluster_[c] = static_cast<int>(cluster.size());
        cluster.push_back(c);
      }
      support_.push_back(local_cluster_[c]);
      support_weight_.push_back(response.support_weight[k]);
    }
    support_begin_.push_back(support_.size());
  }
  far_begin_.assign(1, 0);
  far_column_.clear();
  far_value_.clear();
  for (const std::size_t c : cluster) {
    for (std::size_t k = response.far.begin[c]; k < response.far.begin[c + 1]; ++k) {
      const int local = local_cluster_[response.far.vertex[k]];
      if (local < 0) continue;
      far_column_.push_back(local);
      far_value_.push_back(response.far.response[k]);
    }
    far_begin_.push_back(far_column_.size());
  }
}

/// Adds the far part: add(row, moved) for each of `rows`, whose forces force(row) shows.
template <typename Force, typename Add>
void ContactSystem::add_far(const std::vector<int>& rows, const Force& force,
                            const Add& add) const {
  const std::size_t clusters = far_begin_.size() - 1;
  cluster_force_.assign(clusters, 0.0);
  cluster_moved_.resize(clusters);
  for (const int row : rows) {
    const double p = force(row);
    if (p == 0.0) continue;
    for (std::size_t k = support_begin_[row]; k < support_begin_[row + 1]; ++k) {
      cluster_force_[support_[k]] += p * static_cast<double>(support_weight_[k]);
    }
  }
  for (std::size_t c = 0; c < clusters; ++c) {
    cluster_moved_[c] =
        row_times(far_column_.data() + far_begin_[c], far_value_.data() + far_begin_[c],
                  far_begin_[c + 1] - far_begin_[c], cluster_force_.data());
  }
  for (const int row : rows) {
    add(row, row_times(support_.data() + support_begin_[row],
                       support_weight_.data() + support_begin_[row],
                       support_begin_[row + 1] - support_begin_[row], cluster_moved_.data()));
  }
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
    rows[entry.row].emplace_back(entry.column, entry.value);
    rows[entry.column].emplace_back(entry.row, entry.value);
  }
  has_blocks_ = false;
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

/// All of A as dense blocks, one per pair of patches that act on each other.
void ContactSystem::make_blocks() {
  const auto m = static_cast<std::size_t>(size());
  by_patch_ = all_rows_;
  const auto patch_of = [&](int row) { return patches_->patch[vertex_[row]]; };
  std::stable_sort(by_patch_.begin(), by_patch_.end(),
                   [&](int a, int b) { return patch_of(a) < patch_of(b); });
  std::vector<Place> place(m);
  std::vector<int> sizes;
  first_.clear();
  for (std::size_t k = 0; k < m; ++k) {
    if (k == 0 || patch_of(by_patch_[k]) != patch_of(by_patch_[k - 1])) {
      sizes.push_back(0);
      first_.push_back(k);
    }
    place[by_patch_[k]] = {static_cast<int>(sizes.size()) - 1, sizes.back()++};
  }
  first_.push_back(m);
  all_.begin(sizes);
  const int blocks = static_cast<int>(sizes.size());
  const auto for_entries = [&](int block, const auto& visit) {
    const std::size_t first = first_[block];
    for (std::size_t s = first; s < first_[block + 1]; ++s) {
      const int i = by_patch_[s];
      for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
        visit(s - first, place[column_[k]], k);
      }
    }
  };
  std::vector<char> is_met(sizes.size());
  for (int block = 0; block < blocks; ++block) {
    is_met.assign(sizes.size(), 0);
    for_entries(block,
                [&](std::size_t, const Place& column, std::size_t) { is_met[column.block] = 1; });
    for (int other = 0; other < blocks; ++other) {
      if (is_met[other]) all_.add_block(block, other);
    }
  }
  all_.allocate();
  std::vector<float*> values(sizes.size(), nullptr);
  for (int block = 0; block < blocks; ++block) {
    for (int other = 0; other < blocks; ++other) {
      values[other] = all_.has_block(block, other) ? all_.values(block, other) : nullptr;
    }
    const std::size_t stride = all_.stride(block);
    for_entries(block, [&](std::size_t i, const Place& column, std::size_t k) {
      values[column.block][static_cast<std::size_t>(column.inside) * stride + i] = value_[k];
    });
  }
}

bool ContactSystem::set_contact(const std::vector<char>& in_contact) {
  if (has_blocks_ && in_contact == was_set_) return is_definite_;
  if (!has_blocks_) make_blocks();
  has_blocks_ = true;
  was_set_ = in_contact;
  const std::size_t blocks = first_.size() - 1;
  kept_.resize(blocks);
  place_.resize(in_contact.size());
  set_.clear();
  int block = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    kept_[b].clear();
    for (std::size_t s = first_[b]; s < first_[b + 1]; ++s) {
      const int row = by_patch_[s];
      if (!in_contact[row]) continue;
      place_[row] = {block, static_cast<int>(kept_[b].size())};
      kept_[b].push_back(static_cast<int>(s - first_[b]));
      set_.push_back(row);
    }
    if (!kept_[b].empty()) ++block;
  }
  matrix_.take_part(all_, kept_);
  is_definite_ = matrix_.factor();
  return is_definite_;
}

bool ContactSystem::correct(double tolerance, const std::vector<double>& residual,
                            std::vector<double>& x, int& iterations) {
  double scale = 0.0;
  for (const int i : set_) {
    scale = std::max(scale, std::abs(residual[i]));
  }
  if (scale == 0.0) return true;
  right_.assign(matrix_.padded_size(), 0.0F);
  const auto at = [&](int i) {
    const Place& place = place_[i];
    return matrix_.row(place.block, place.inside);
  };
  for (const int i : set_) {
    right_[at(i)] = static_cast<float>(-residual[i] / scale);
  }
  if (!matrix_.solve(right_, tolerance, step_, iterations, far_on_set())) return false;
  for (const int i : set_) {
    x[i] += scale * static_cast<double>(step_[at(i)]);
  }
  return true;
}

/// What the far part adds to a product of the set's matrix.
BlockMatrix::AddProduct ContactSystem::far_on_set() const {
  if (!has_far_) return {};
  return [this](const std::vector<float>& from, std::vector<float>& to) {
    const auto at = [&](int i) { return matrix_.row(place_[i].block, place_[i].inside); };
    add_far(
        set_, [&](int row) { return static_cast<double>(from[at(row)]); },
        [&](int row, double moved) { to[at(row)] += static_cast<float>(moved); });
  };
}

void ContactSystem::multiply_all(const std::vector<double>& p, std::vector<double>& s) const {
  const auto m = static_cast<std::size_t>(size());
  s.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    s[i] = row_times(column_.data() + begin_[i], value_.data() + begin_[i],
                     begin_[i + 1] - begin_[i], p.data());
  }
  if (!has_far_) return;
  add_far(
      all_rows_, [&](int row) { return p[row]; }, [&](int row, double moved) { s[row] += moved; });
}

/// A p in single precision, by the blocks: a third of the time.
void ContactSystem::multiply_roughly(const std::vector<double>& p, std::vector<double>& s) {
  std::vector<float>& from = right_;
  from.assign(all_.padded_size(), 0.0F);
  const auto for_rows = [&](const auto& visit) {
    for (std::size_t b = 0; b + 1 < first_.size(); ++b) {
      for (std::size_t k = first_[b]; k < first_[b + 1]; ++k) {
        visit(by_patch_[k], all_.row(static_cast<int>(b), static_cast<int>(k - first_[b])));
      }
    }
  };
  for_rows([&](int row, std::size_t at) { from[at] = static_cast<float>(p[row]); });
  all_.multiply(from, step_);
  s.resize(p.size());
  for_rows([&](int row, std::size_t at) { s[row] = step_[at]; });
}

void ContactSystem::find_gap(const std::vector<double>& b, const std::vector<double>& force,
                             bool is_rough, std::vector<double>& gap) {
  if (is_rough && has_blocks_ && !has_far_) {
    multiply_roughly(force, gap);
  } else {
    multiply_all(force, gap);
  }
  for (std::size_t i = 0; i < gap.size(); ++i) gap[i] += b[i];
}

void ContactSystem::measure(const std::vector<double>& b, const std::vector<double>& force,
                            const std::vector<double>& gap, Outcome& outcome) {
  const double b_scale = std::max(largest(b), 1e-300);
  const double p_scale = std::max(largest(force), 1e-300);
  outcome.complementarity = 0.0;
  outcome.relative_residual = 0.0;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    outcome.complementarity = std::max(outcome.complementarity, std::abs(gap[i] * force[i]));
    outcome.relative_residual = std::max(outcome.relative_residual,
                                         std::abs(std::min(gap[i] / b_scale, force[i] / p_scale)));
  }
}

bool ContactSystem::solve_dense(const std::vector<double>& b, std::vector<char>& in_contact,
                                std::vector<double>& force, std::vector<double>& gap,
                                Outcome& outcome) {
  const int m = size();
  if (m > kMostDense || has_far_) return false;
  ContactProblem problem;
  problem.response = Eigen::MatrixXd::Zero(m, m);
  problem.distance = Eigen::Map<const Eigen::VectorXd>(b.data(), m);
  for (int i = 0; i < m; ++i) {
    for (std::size_t k = begin_[i]; k < begin_[i + 1]; ++k) {
      problem.response(column_[k], i) = value_[k];
    }
  }
  ContactSolution solution = solve_contact(problem);
  outcome.pivots += solution.pivots;
  if (solution.status == LcpStatus::kSolved) {
    ++outcome.fallbacks.dense_solutions;
  } else {
    solution = solve_contact_lemke(problem);
    outcome.pivots += solution.pivots;
    if (solution.status != LcpStatus::kSolved) return false;
    ++outcome.fallbacks.lemke_solutions;
  }
  for (int i = 0; i < m; ++i) {
    force[i] = solution.force[i];
    in_contact[i] = solution.force[i] > 0.0;
  }
  find_gap(b, force, false, gap);
  measure(b, force, gap, outcome);
  return true;
}

/// Sets the forces of rows outside the contact to zero; with `gap`s known, by the columns of those
/// rows alone.
void ContactSystem::take_off_forces(const std::vector<char>& in_contact, bool has_gap,
                                    std::vector<double>& force, std::vector<double>& gap) const {
  for (std::size_t i = 0; i < force.size(); ++i) {
    if (in_contact[i] || force[i] == 0.0) continue;
    for (std::size_t k = begin_[i]; has_gap && k < begin_[i + 1]; ++k) {
      gap[column_[k]] -= static_cast<double>(value_[k]) * force[i];
    }
    force[i] = 0.0;
  }
}

ContactSystem::Outcome ContactSystem::solve(const std::vector<double>& b,
                                            std::vector<char>& in_contact,
                                            std::vector<double>& force, std::vector<double>& gap,
                                            double accuracy) {
  const auto m = static_cast<std::size_t>(size());
  Outcome outcome;
  if (force.size() != m) force.assign(m, 0.0);
  const double b_scale = largest(b);
  int fewest = static_cast<int>(m) + 1;
  int fruitless_left = kMaxFruitless;
  const bool is_rough = accuracy >= kSinglePrecision;
  bool is_exact = false;  // whether every set is to be solved to the end
  std::vector<int> infeasible;
  const auto error_on_set = [&] {
    double most = 0.0;
    for (const int i : set_) most = std::max(most, std::abs(gap[i]));
    return most / b_scale;
  };
  bool is_regular = true;
  bool has_gap = false;  // that of the forces
  while (is_regular && outcome.pivots < kMostPivots) {
    if (!set_contact(in_contact)) {
      ++outcome.fallbacks.refused_matrices;
      break;
    }
    take_off_forces(in_contact, has_gap && !has_far_, force, gap);
    if (!has_gap || has_far_) find_gap(b, force, is_rough, gap);
    has_gap = true;
    double error = error_on_set();
    for (int round = 0;; ++round) {
      if (error > accuracy) {
        // No further than wanted.
        const double share =
            std::max(round == 0 && !is_exact ? kFirst : kInner, kUnder * accuracy / error);
        is_regular = correct(share, gap, force, outcome.iterations);
        if (!is_regular) break;
        find_gap(b, force, is_rough, gap);
        error = error_on_set();
      }
      const bool is_last = error <= accuracy || round == kMostCorrections;
      // What the solution isn't good enough to determine counts as feasible for now.
      const double slack = std::max(10.0 * error, 1e-11);
      const double p_slack = slack * largest(force);
      infeasible.clear();
      for (std::size_t i = 0; i < m; ++i) {
        const bool ok = in_contact[i] ? force[i] >= -p_slack : gap[i] >= -slack * b_scale;
        if (!ok) infeasible.push_back(static_cast<int>(i));
      }
      if (infeasible.empty() ? is_last : (is_last || !is_exact)) break;
    }
    if (!is_regular) {
      ++outcome.fallbacks.gradient_limits;
      break;
    }
    if (infeasible.empty()) {
      outcome.is_solved = true;
      bool is_rounded = false;
      for (double& p : force) {
        is_rounded = is_rounded || p < 0.0;
        p = std::max(p, 0.0);
      }
      if (is_rounded) find_gap(b, force, is_rough, gap);
      measure(b, force, gap, outcome);
      return outcome;
    }
    ++outcome.pivots;
    const int count = static_cast<int>(infeasible.size());
    if (count < fewest) {
      fewest = count;
      fruitless_left = kMaxFruitless;
    } else if (fruitless_left > 0) {
      --fruitless_left;
    } else {
      is_exact = true;
      infeasible = {infeasible.back()};
    }
    for (const int i : infeasible) {
      in_contact[i] = !in_contact[i];
    }
  }
  if (outcome.pivots == kMostPivots) ++outcome.fallbacks.exchange_limits;
  force.assign(m, 0.0);
  gap.assign(m, 0.0);
  outcome.is_solved = solve_dense(b, in_contact, force, gap, outcome);
  return outcome;
}

std::vector<double> ContactSystem::times(const std::vector<double>& x) const {
  std::vector<double> result;
  multiply_all(x, result);
  return result;
}

std::optional<Eigen::MatrixXd> ContactSystem::solve_roughly_on(const std::vector<char>& in_contact,
                                                               const Eigen::MatrixXd& right,
                                                               double accuracy) {
  if (!set_contact(in_contact)) return std::nullopt;
  const auto at = [&](int i) { return matrix_.row(place_[i].block, place_[i].inside); };
  BlockMatrix::Vectors b(static_cast<std::size_t>(right.cols())), x;
  for (std::size_t c = 0; c < b.size(); ++c) {
    b[c].assign(matrix_.padded_size(), 0.0F);
    for (const int i : set_) {
      b[c][at(i)] = static_cast<float>(right(i, static_cast<Eigen::Index>(c)));
    }
  }
  int iterations = 0;
  if (!matrix_.solve(b, std::max(kInner, kUnder * accuracy), x, iterations, far_on_set())) {
    return std::nullopt;
  }
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(right.rows(), right.cols());
  for (std::size_t c = 0; c < b.size(); ++c) {
    for (const int i : set_) {
      result(i, static_cast<Eigen::Index>(c)) = static_cast<double>(x[c][at(i)]);
    }
  }
  return result;
}

std::optional<std::vector<double>> ContactSystem::solve_on(const std::vector<char>& in_contact,
                                                           const std::vector<double>& right,
                                                           double accuracy) {
  if (!set_contact(in_contact)) return std::nullopt;
  const auto m = static_cast<std::size_t>(size());
  std::vector<double> x(m, 0.0);
  std::vector<double> residual(m);
  const double scale = largest(right);
  for (std::size_t i = 0; i < m; ++i) residual[i] = -right[i];
  for (int round = 0; round < kMostCorrections; ++round) {
    int iterations = 0;
    if (!correct(std::max(kInner, kUnder * accuracy), residual, x, iterations)) return std::nullopt;
    if (accuracy >= kSurely) break;
    multiply_all(x, residual);
    double error = 0.0;
    for (const int i : set_) {
      double& r = residual[i];
      r -= right[i];
      error = std::max(error, std::abs(r));
    }
    if (error <= accuracy * scale) break;
  }
  return x;
}

}  // namespace palmar::contact
