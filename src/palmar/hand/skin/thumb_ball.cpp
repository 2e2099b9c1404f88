// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/skin/thumb_ball.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <cstddef>
#include <string>

#include "palmar/core/error.h"

namespace palmar::hand {
namespace {

double kernel(double beta, double squared_distance) { return std::exp(-beta * squared_distance); }

}  // namespace

void ThumbBallOptions::check() const {
  if (!(beta > 0) || !std::isfinite(beta)) {
    throw UsageError("thumb ball: beta is " + std::to_string(beta) + " 1/mm^2; above 0 is needed");
  }
  if (!(reach > 0) || !std::isfinite(reach)) {
    throw UsageError("thumb ball: reach is " + std::to_string(reach) + " mm; above 0 is needed");
  }
}

ThumbBallCorrection fit_thumb_ball(const geometry::TriangleMesh& skin,
                                   const ThumbBallMarkers& markers,
                                   const ThumbBallOptions& options) {
  options.check();
  const std::size_t count = markers.reference.size();
  for (const std::vector<Vec3>& missing : markers.missing) {
    if (missing.size() != count) {
      throw UsageError("thumb ball: " + std::to_string(count) + " markers, but " +
                       std::to_string(missing.size()) + " displacements at a limit posture");
    }
  }
  ThumbBallCorrection correction;
  correction.beta = options.beta;
  correction.marker = markers.reference;
  if (count == 0) return correction;

  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd phi(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index k = 0; k < n; ++k) {
      const Vec3 gap = markers.reference[i] - markers.reference[k];
      phi(i, k) = kernel(options.beta, gap.squaredNorm());
    }
  }
  // A Gaussian kernel matrix of distinct points is positive definite (Micchelli 1986).
  const Eigen::LLT<Eigen::MatrixXd> factor(phi);
  if (factor.info() != Eigen::Success || factor.rcond() < 1e-13) {
    throw NumericalError("thumb ball: two of the " + std::to_string(count) +
                         " markers coincide or are too close for beta = " +
                         std::to_string(options.beta) + " 1/mm^2");
  }
  for (std::size_t limit = 0; limit < 4; ++limit) {
    Eigen::MatrixXd missing(n, 3);
    for (Eigen::Index i = 0; i < n; ++i) {
      missing.row(i) = markers.missing[limit][i].transpose();
    }
    const Eigen::MatrixXd d = factor.solve(missing);
    for (Eigen::Index i = 0; i < n; ++i) {
      correction.coefficient[limit].emplace_back(d.row(i).transpose());
    }
  }
  for (int v = 0; v < skin.vertex_count(); ++v) {
    for (const Vec3& marker : correction.marker) {
      const Vec3 gap = skin.vertices[v] - marker;
      if (gap.squaredNorm() > options.reach * options.reach) continue;
      correction.vertex.push_back(v);
      break;
    }
  }
  return correction;
}

Vec3 thumb_ball_offset(const ThumbBallCorrection& correction, const Vec3& point,
                       const CmcShare& share) {
  const auto& fe = correction.coefficient[share.s_fe >= 0 ? 0 : 1];
  const auto& aa = correction.coefficient[share.s_aa >= 0 ? 2 : 3];
  Vec3 offset = Vec3::Zero();
  for (std::size_t k = 0; k < correction.marker.size(); ++k) {
    const double phi = kernel(correction.beta, (point - correction.marker[k]).squaredNorm());
    offset += phi * (std::abs(share.s_fe) * fe[k] + std::abs(share.s_aa) * aa[k]);
  }
  return offset;
}

}  // namespace palmar::hand
