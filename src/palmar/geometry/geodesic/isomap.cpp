// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/geodesic/isomap.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"

namespace palmar::geometry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string entry(Index i, Index j) {
  return "isomap: distance between points " + std::to_string(i) + " and " + std::to_string(j);
}

void check_distances(const MatrixXd& distance) {
  if (distance.rows() != distance.cols() || distance.rows() < 1) {
    throw UsageError("isomap: table of distances is " + std::to_string(distance.rows()) + " x " +
                     std::to_string(distance.cols()) +
                     "; a square table of at least one point is required");
  }
  for (Index j = 0; j < distance.cols(); ++j) {
    for (Index i = 0; i <= j; ++i) {
      const double d = distance(i, j);
      if (std::isinf(d) && d > 0.0) {
        throw UsageError(entry(i, j) + " is infinite; a patch in one piece is required");
      }
      if (!(d >= 0.0) || (i == j && d != 0.0)) {
        throw UsageError(entry(i, j) + " is " + std::to_string(d) + " mm; " +
                         (i == j ? "0 mm is required" : "0 mm or more is required"));
      }
      // Distances off a mesh may be rounded apart, no more.
      if (!(std::abs(d - distance(j, i)) <= 1e-9 * (1.0 + d))) {
        throw UsageError(entry(i, j) + " is " + std::to_string(d) + " mm one way and " +
                         std::to_string(distance(j, i)) +
                         " mm the other; a symmetric table is required");
      }
    }
  }
}

/// B = -1/2 J D2 J.
MatrixXd double_centred(const MatrixXd& distance) {
  MatrixXd b = distance.cwiseAbs2();
  const VectorXd row_mean = b.rowwise().mean();
  const Eigen::RowVectorXd column_mean = b.colwise().mean();
  const double mean = row_mean.mean();
  b.colwise() -= row_mean;
  b.rowwise() -= column_mean;
  b.array() += mean;
  b *= -0.5;
  return b;
}

struct TwoEigenpairs {
  Eigen::Vector2d value;  // larger first
  Eigen::MatrixX2d vector;
};

TwoEigenpairs leading_by_full_decomposition(const MatrixXd& b) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(b);
  const Index n = b.rows();
  TwoEigenpairs pairs{Eigen::Vector2d::Zero(), Eigen::MatrixX2d::Zero(n, 2)};
  for (Index k = 0; k < std::min<Index>(2, n); ++k) {
    pairs.value[k] = solver.eigenvalues()[n - 1 - k];
    pairs.vector.col(k) = solver.eigenvectors().col(n - 1 - k);
  }
  return pairs;
}

/// The two algebraically largest eigenpairs by subspace iteration with Rayleigh-Ritz projection
/// (Saad 2011, section 5.3). The block is wider than two, so that the third, smaller directions of
/// a curved patch don't slow it down, and large negative ones don't hide the wanted.
TwoEigenpairs leading_eigenpairs(const MatrixXd& b) {
  constexpr Index kBlock = 8;
  constexpr int kMostSteps = 200;
  constexpr double kTolerance = 1e-12;  // of |B v - lambda v| against the largest eigenvalue
  const Index n = b.rows();
  if (n <= 4 * kBlock) return leading_by_full_decomposition(b);

  MatrixXd q(n, kBlock);
  std::uint64_t state = 1;  // any fixed start with a part along the wanted vectors will do
  for (Index k = 0; k < kBlock; ++k) {
    for (Index i = 0; i < n; ++i) {
      state = state * 6364136223846793005ULL + 1442695040888963407ULL;
      q(i, k) = static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
    }
  }
  const MatrixXd identity = MatrixXd::Identity(n, kBlock);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::HouseholderQR<MatrixXd> qr(q);
    q = qr.householderQ() * identity;
    MatrixXd bq = b * q;
    MatrixXd projected = q.transpose() * bq;
    projected = 0.5 * (projected + projected.transpose()).eval();
    const Eigen::SelfAdjointEigenSolver<MatrixXd> ritz(projected);
    const Eigen::Vector2d value(ritz.eigenvalues()[kBlock - 1], ritz.eigenvalues()[kBlock - 2]);
    Eigen::MatrixXd turn(kBlock, 2);
    turn << ritz.eigenvectors().col(kBlock - 1), ritz.eigenvectors().col(kBlock - 2);
    const Eigen::MatrixX2d vector = q * turn;
    const Eigen::MatrixX2d miss = bq * turn - vector * value.asDiagonal();
    const double largest = ritz.eigenvalues().cwiseAbs().maxCoeff();
    if (miss.colwise().norm().maxCoeff() <= kTolerance * largest) return {value, vector};
    q = std::move(bq);
  }
  return leading_by_full_decomposition(b);
}

/// 1 - R^2 between given and flat distances over all pairs.
double unexplained_variance(const MatrixXd& distance, const Eigen::MatrixX2d& position) {
  const Index n = distance.rows();
  const double pairs = 0.5 * static_cast<double>(n) * static_cast<double>(n - 1);
  double sum_d = 0.0, sum_f = 0.0;
  const auto for_each_pair = [&](const auto& body) {
    for (Index j = 1; j < n; ++j) {
      for (Index i = 0; i < j; ++i) {
        body(distance(i, j), (position.row(i) - position.row(j)).norm());
      }
    }
  };
  for_each_pair([&](double d, double f) {
    sum_d += d;
    sum_f += f;
  });
  const double mean_d = sum_d / pairs, mean_f = sum_f / pairs;
  double dd = 0.0, ff = 0.0, df = 0.0;
  for_each_pair([&](double d, double f) {
    dd += (d - mean_d) * (d - mean_d);
    ff += (f - mean_f) * (f - mean_f);
    df += (d - mean_d) * (f - mean_f);
  });
  // Distances that don't vary leave no variance to explain.
  if (!(dd > 0.0) || !(ff > 0.0)) return 0.0;
  return std::clamp(1.0 - df * df / (dd * ff), 0.0, 1.0);
}

struct Neighbour {
  int place = 0;
  double length = 0.0;  // mm
};

}  // namespace

FlatPatch flatten_by_isomap(const MatrixXd& distance) {
  check_distances(distance);
  const Index n = distance.rows();
  FlatPatch flat;
  flat.position = Eigen::MatrixX2d::Zero(n, 2);
  if (n == 1) return flat;
  const TwoEigenpairs leading = leading_eigenpairs(double_centred(distance));
  for (Index k = 0; k < 2; ++k) {
    // Below rounding of the leading one a direction is noise: the points lie on a line.
    if (!(leading.value[k] > 1e-14 * std::abs(leading.value[0]))) continue;
    flat.position.col(k) = std::sqrt(leading.value[k]) * leading.vector.col(k);
    const double largest = flat.position.col(k).cwiseAbs().maxCoeff();
    for (Index i = 0; i < n; ++i) {
      if (std::abs(flat.position(i, k)) < (1.0 - 1e-6) * largest) continue;
      if (flat.position(i, k) < 0.0) flat.position.col(k) *= -1.0;
      break;
    }
  }
  flat.residual_variance = unexplained_variance(distance, flat.position);
  return flat;
}

MatrixXd edge_path_distances(const TriangleMesh& mesh, std::span<const int> vertices) {
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const int v = vertices[k];
    if (v < 0 || v >= mesh.vertex_count()) {
      throw UsageError("edge paths: vertex " + std::to_string(v) + " is outside the mesh of " +
                       std::to_string(mesh.vertex_count()) + " vertices");
    }
    if (place[v] >= 0) {
      throw UsageError("edge paths: vertex " + std::to_string(v) +
                       " is given twice; once is allowed");
    }
    place[v] = static_cast<int>(k);
  }
  const std::size_t n = vertices.size();
  std::vector<std::vector<Neighbour>> around(n);
  for (const Triangle& t : mesh.triangles) {
    std::array<int, 3> p{};
    for (std::size_t k = 0; k < 3; ++k) p[k] = place[t[k]];
    if (*std::min_element(p.begin(), p.end()) < 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      const double length = (mesh.vertices[t[k]] - mesh.vertices[t[next]]).norm();
      around[p[k]].push_back({p[next], length});
      around[p[next]].push_back({p[k], length});
    }
  }

  constexpr double kFar = std::numeric_limits<double>::infinity();
  MatrixXd distance = MatrixXd::Constant(static_cast<Index>(n), static_cast<Index>(n), kFar);
  parallel_for(static_cast<int>(n), [&](int source) {
    auto from = distance.col(source);
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    from[source] = 0.0;
    front.emplace(0.0, source);
    while (!front.empty()) {
      const auto [d, here] = front.top();
      front.pop();
      if (d > from[here]) continue;
      for (const Neighbour& next : around[here]) {
        const double longer = d + next.length;
        if (longer >= from[next.place]) continue;
        from[next.place] = longer;
        front.emplace(longer, next.place);
      }
    }
  });
  // The two directions add the same lengths in another order.
  distance = (0.5 * (distance + distance.transpose())).eval();
  for (Index j = 0; j < distance.cols(); ++j) {
    for (Index i = 0; i < j; ++i) {
      if (std::isinf(distance(i, j))) {
        throw UsageError("edge paths: no path between vertices " + std::to_string(vertices[i]) +
                         " and " + std::to_string(vertices[j]) +
                         "; a patch in one piece is required");
      }
    }
  }
  return distance;
}

}  // namespace palmar::geometry
