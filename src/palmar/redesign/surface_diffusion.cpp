// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/surface_diffusion.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"

namespace palmar::redesign {
namespace {

// Needles have cotangents without bound; this couples their ends as one all the same.
constexpr double kLargestCotangent = 1e4;

double cotangent(const Vec3& corner, const Vec3& a, const Vec3& b) {
  const Vec3 u = a - corner;
  const Vec3 v = b - corner;
  const double sine = u.cross(v).norm();
  const double cosine = u.dot(v);
  if (std::abs(cosine) >= kLargestCotangent * sine) {
    return std::copysign(kLargestCotangent, cosine);
  }
  return cosine / sine;
}

}  // namespace

struct SurfaceDiffusion::Impl {
  Eigen::VectorXd mass;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
  bool is_identity = false;

  Eigen::MatrixXd smooth(Eigen::MatrixXd values) const {
    const Eigen::RowVectorXd low = values.colwise().minCoeff();
    const Eigen::RowVectorXd high = values.colwise().maxCoeff();
    for (int step = 0; step < 2; ++step) {
      values = factor.solve((mass.asDiagonal() * values).eval()).eval();
    }
    // Obtuse triangles can overshoot a little.
    for (Eigen::Index c = 0; c < values.cols(); ++c) {
      values.col(c) = values.col(c).cwiseMax(low[c]).cwiseMin(high[c]);
    }
    return values;
  }
};

SurfaceDiffusion::SurfaceDiffusion(const geometry::TriangleMesh& mesh, double length) {
  auto impl = std::make_unique<Impl>();
  const int n = mesh.vertex_count();
  impl->is_identity = !(length > 0.0) || n == 0;
  if (!impl->is_identity) {
    const std::vector<double> areas = geometry::vertex_areas(mesh);
    // A vertex without area holds its value; the size of its mass doesn't matter then.
    impl->mass.resize(n);
    for (int v = 0; v < n; ++v) {
      impl->mass[v] = std::max(areas[v], 1e-9);
    }
    std::map<std::pair<int, int>, double> weight;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int a = t[k];
        const int b = t[(k + 1) % 3];
        const int c = t[(k + 2) % 3];
        if (a == b || b == c || c == a) continue;
        const auto at = [&](int v) { return mesh.vertices[v]; };
        weight[{std::min(a, b), std::max(a, b)}] += 0.5 * cotangent(at(c), at(a), at(b));
      }
    }
    const double t = 0.25 * length * length;
    std::vector<Eigen::Triplet<double>> entries;
    for (int v = 0; v < n; ++v) entries.emplace_back(v, v, impl->mass[v]);
    for (const auto& [edge, w] : weight) {
      const auto& [i, j] = edge;
      entries.emplace_back(i, i, t * w);
      entries.emplace_back(j, j, t * w);
      entries.emplace_back(i, j, -t * w);
      entries.emplace_back(j, i, -t * w);
    }
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    impl->factor.compute(matrix);
    if (impl->factor.info() != Eigen::Success) {
      throw NumericalError("smoothing along the surface: the system can't be factorised");
    }
  }
  impl_ = std::move(impl);
}

SurfaceDiffusion::~SurfaceDiffusion() = default;

std::vector<double> SurfaceDiffusion::smooth(const std::vector<double>& values) const {
  if (impl_->is_identity) return values;
  const Eigen::MatrixXd result = impl_->smooth(
      Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  return {result.data(), result.data() + result.size()};
}

std::vector<Vec3> SurfaceDiffusion::smooth(const std::vector<Vec3>& values) const {
  if (impl_->is_identity) return values;
  Eigen::MatrixXd columns(static_cast<Eigen::Index>(values.size()), 3);
  for (std::size_t i = 0; i < values.size(); ++i) {
    columns.row(static_cast<Eigen::Index>(i)) = values[i];
  }
  const Eigen::MatrixXd smoothed = impl_->smooth(std::move(columns));
  std::vector<Vec3> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    result[i] = smoothed.row(static_cast<Eigen::Index>(i));
  }
  return result;
}

}  // namespace palmar::redesign
