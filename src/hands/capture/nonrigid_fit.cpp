// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/nonrigid_fit.h"

#include <fmt/format.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/rotation.h"

namespace palmar::capture {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
using Entry = Eigen::Triplet<double>;

/// A pull on a point of the moving surface towards a place.
struct Pull {
  std::array<int, 3> vertex{};
  std::array<double, 3> share{};
  Vec3 place = Vec3::Zero();
  double weight = 0.0;
};

/// A surface that partners are looked for on.
class Partners {
 public:
  Partners(const geometry::TriangleMesh& mesh, const FitSurface& surface)
      : mesh_(mesh), surface_(surface), normal_(geometry::vertex_normals(mesh)), query_(mesh) {}

  struct Found {
    geometry::ClosestPoint foot;
    Vec3 normal;
  };
  std::optional<Found> of(const Vec3& point, const Vec3& normal, int part, double reach,
                          double normals_agree) const {
    const auto foot = query_.closest(point, reach);
    if (!foot) return std::nullopt;
    const Triangle& t = mesh_.triangles[foot->triangle];
    Vec3 n = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c) {
      if (foot->weights[c] > 0.0 && surface_.is_silent[t[c]]) return std::nullopt;
      n += foot->weights[c] * normal_[t[c]];
    }
    n.stableNormalize();
    if (n.dot(normal) < normals_agree) return std::nullopt;
    const auto main =
        std::max_element(foot->weights.begin(), foot->weights.end()) - foot->weights.begin();
    const int other = surface_.part[t[main]];
    if (part != 0 && other != 0 && part != other) return std::nullopt;
    return Found{*foot, n};
  }
  const Vec3& normal(std::size_t vertex) const { return normal_[vertex]; }

 private:
  const geometry::TriangleMesh& mesh_;
  const FitSurface& surface_;
  std::vector<Vec3> normal_;
  geometry::ClosestPointQuery query_;
};

double weight_of(double distance, double scale) {
  const double q = 1.0 + distance * distance / (scale * scale);
  return 1.0 / (q * q);
}

class Fitter {
 public:
  Fitter(const FitSurface& moving, const FitSurface& fixed, const std::vector<FitPin>& pins,
         const NonrigidFitOptions& options)
      : moving_(moving),
        fixed_(fixed),
        options_(options),
        start_(moving.mesh.vertices),
        mesh_(moving.mesh),
        neighbours_(geometry::vertex_neighbours(geometry::build_topology(moving.mesh))),
        on_fixed_(fixed.mesh, fixed) {
    for (const FitPin& pin : pins) {
      pins_.push_back({pin.vertex, pin.share, pin.place, options.pin_weight});
    }
    const auto n = static_cast<Eigen::Index>(start_.size());
    std::vector<Entry> entries;
    for (int v = 0; v < static_cast<int>(start_.size()); ++v) {
      if (neighbours_[v].empty()) continue;
      entries.emplace_back(v, v, -1.0);
      const double share = 1.0 / static_cast<double>(neighbours_[v].size());
      for (const int u : neighbours_[v]) entries.emplace_back(v, u, share);
    }
    laplacian_.resize(n, n);
    laplacian_.setFromTriplets(entries.begin(), entries.end());
    bending_ = laplacian_.transpose() * laplacian_;
    for (std::size_t v = 0; v < start_.size(); ++v) {
      Vec3 l = Vec3::Zero();
      for (const int u : neighbours_[v]) l += start_[u] - start_[v];
      if (!neighbours_[v].empty()) l /= static_cast<double>(neighbours_[v].size());
      coordinate_.push_back(l);
    }
  }

  void round(double stiffness, double reach) {
    const std::vector<Pull> pulls = find_pulls(reach);
    constexpr double kHold = 1e-4;  // keeps parts that nothing pulls from floating
    std::vector<Entry> entries;
    const auto n = static_cast<Eigen::Index>(start_.size());
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, 3);
    for (Eigen::Index v = 0; v < n; ++v) {
      entries.emplace_back(static_cast<int>(v), static_cast<int>(v), kHold);
      right.row(v) = kHold * mesh_.vertices[v].transpose();
    }
    for (const Pull& p : pulls) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (p.share[a] == 0.0) continue;
        right.row(p.vertex[a]) += p.weight * p.share[a] * p.place.transpose();
        for (std::size_t b = 0; b < 3; ++b) {
          if (p.share[b] == 0.0) continue;
          entries.emplace_back(p.vertex[a], p.vertex[b], p.weight * p.share[a] * p.share[b]);
        }
      }
    }
    Eigen::MatrixXd turned(n, 3);
    parallel_for(static_cast<int>(n), [&](int v) { turned.row(v) = turned_coordinate(v); });
    right += stiffness * (laplacian_.transpose() * turned);
    Sparse system(n, n);
    system.setFromTriplets(entries.begin(), entries.end());
    system += stiffness * bending_;
    if (!is_analysed_) solver_.analyzePattern(system);
    is_analysed_ = true;
    solver_.factorize(system);
    if (solver_.info() != Eigen::Success) {
      throw NumericalError("nonrigid fit: the equations have no solution");
    }
    const Eigen::MatrixXd x = solver_.solve(right);
    for (Eigen::Index v = 0; v < n; ++v) {
      mesh_.vertices[v] = x.row(v).transpose();
    }
  }

  const std::vector<Vec3>& vertices() const { return mesh_.vertices; }

 private:
  /// Both ways: every surface has points that are nobody's nearest.
  std::vector<Pull> find_pulls(double reach) const {
    const double scale = 0.5 * reach;
    const Partners on_moving(mesh_, moving_);
    std::vector<Pull> pulls(start_.size() + fixed_.mesh.vertices.size());
    parallel_for(mesh_.vertex_count(), [&](int v) {
      if (moving_.is_silent[v]) return;
      const Vec3& x = mesh_.vertices[v];
      const auto found =
          on_fixed_.of(x, on_moving.normal(v), moving_.part[v], reach, options_.normals_agree);
      if (!found) return;
      pulls[v] = {{v, v, v},
                  {1.0, 0.0, 0.0},
                  x + found->normal.dot(found->foot.point - x) * found->normal,
                  weight_of(found->foot.distance, scale)};
    });
    parallel_for(fixed_.mesh.vertex_count(), [&](int v) {
      if (fixed_.is_silent[v]) return;
      const Vec3& y = fixed_.mesh.vertices[v];
      const Vec3& n = on_fixed_.normal(v);
      const auto found = on_moving.of(y, n, fixed_.part[v], reach, options_.normals_agree);
      if (!found) return;
      const Triangle& t = mesh_.triangles[found->foot.triangle];
      const Vec3& x = found->foot.point;
      constexpr double kShare = 0.5;  // against a vertex of the moving surface
      pulls[start_.size() + static_cast<std::size_t>(v)] = {
          t, found->foot.weights, x + n.dot(y - x) * n,
          kShare * weight_of(found->foot.distance, scale)};
    });
    std::erase_if(pulls, [](const Pull& p) { return p.weight == 0.0; });
    pulls.insert(pulls.end(), pins_.begin(), pins_.end());
    return pulls;
  }

  Eigen::RowVector3d turned_coordinate(std::size_t v) const {
    Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();
    double before = 0.0, after = 0.0;
    for (const int u : neighbours_[v]) {
      const Vec3 p = start_[u] - start_[v];
      const Vec3 x = mesh_.vertices[u] - mesh_.vertices[v];
      cross += x * p.transpose();
      before += p.squaredNorm();
      after += x.squaredNorm();
    }
    if (!(before > 0.0)) return Eigen::RowVector3d::Zero();
    const double size = std::clamp(std::sqrt(after / before), 0.6, 1.6);
    return (size * (geometry::fit_rotation(cross) * coordinate_[v])).transpose();
  }

  const FitSurface& moving_;
  const FitSurface& fixed_;
  NonrigidFitOptions options_;
  std::vector<Vec3> start_;
  geometry::TriangleMesh mesh_;
  std::vector<std::vector<int>> neighbours_;
  Partners on_fixed_;
  std::vector<Pull> pins_;
  Sparse laplacian_, bending_;
  std::vector<Vec3> coordinate_;  ///< L p
  Eigen::SimplicialLLT<Sparse> solver_;
  bool is_analysed_ = false;
};

}  // namespace

void NonrigidFitOptions::check() const {
  const auto require = [](const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
      throw UsageError(
          fmt::format("nonrigid fit: {} is {:g}; {:g} to {:g} is allowed", name, value, low, high));
    }
  };
  require("reach (mm)", reach, 0.01, 1000.0);
  require("last_reach (mm)", last_reach, 0.01, reach);
  require("normals_agree", normals_agree, -1.0, 0.99);
  require("stiffness", stiffness, 1e-6, 1e6);
  require("last_stiffness", last_stiffness, 1e-6, stiffness);
  require("levels", levels, 1, 100);
  require("rounds", rounds, 1, 100);
  require("pin_weight", pin_weight, 0.0, 1e6);
}

std::vector<Vec3> fit_nonrigidly(const FitSurface& moving, const FitSurface& fixed,
                                 const std::vector<FitPin>& pins, const NonrigidFitOptions& options,
                                 const Progress& progress) {
  options.check();
  Fitter fitter(moving, fixed, pins, options);
  const auto falling = [&](double from, double to, int level) {
    if (options.levels == 1) return to;
    return from * std::pow(to / from, static_cast<double>(level) / (options.levels - 1));
  };
  for (int level = 0; level < options.levels; ++level) {
    for (int round = 0; round < options.rounds; ++round) {
      progress.update((level + static_cast<double>(round) / options.rounds) / options.levels,
                      "bending the skin onto the scan");
      fitter.round(falling(options.stiffness, options.last_stiffness, level),
                   falling(options.reach, options.last_reach, level));
    }
  }
  return fitter.vertices();
}

}  // namespace palmar::capture
