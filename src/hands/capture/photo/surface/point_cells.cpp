// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/point_cells.h"

#include <algorithm>
#include <cmath>

#include "palmar/geometry/degrees.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

constexpr double kCell = 2.0;  // mm

std::uint64_t key_of(const Eigen::Vector3i& cell) {
  constexpr std::uint64_t kBits = 20, kMask = (1U << kBits) - 1;
  std::uint64_t key = 0;
  for (const int c : cell) key = key << kBits | (static_cast<std::uint64_t>(c) & kMask);
  return key;
}

Eigen::Vector3i cell_of(const Vec3& place) {
  return (place / kCell).array().floor().matrix().cast<int>();
}

}  // namespace

PointCells::PointCells(const std::vector<SurfacePoint>& points) {
  for (const SurfacePoint& point : points) {
    PointSupport& sum = sums_[key_of(cell_of(point.position.cast<double>()))];
    sum.points += 1.0;
    sum.views += point.views;
    const auto& s = point.patch;
    Eigen::Matrix3f patch;
    patch << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
    sum.patch += patch.cast<double>();
  }
}

PointSupport PointCells::near(const Vec3& place) const {
  PointSupport mean;
  const Eigen::Vector3i low = cell_of(place - Vec3::Constant(0.5 * kCell));
  for (int n = 0; n < 8; ++n) {
    const auto found = sums_.find(key_of(low + Eigen::Vector3i(n & 1, (n >> 1) & 1, n >> 2)));
    if (found == sums_.end()) continue;
    mean.points += found->second.points;
    mean.views += found->second.views;
    mean.patch += found->second.patch;
  }
  if (mean.points > 0.0) {
    mean.views /= mean.points;
    mean.patch /= mean.points;
  }
  return mean;
}

CameraHeights camera_heights(const std::vector<Vec3>& centres, const Vec3& middle) {
  constexpr double kBeside = 0.05, kApart = 10.0;  // share of the cameras at either end; deg
  std::vector<double> elevation;
  for (const Vec3& centre : centres) {
    elevation.push_back(std::asin((centre - middle).normalized().z()) / geometry::kDegree);
  }
  if (elevation.empty()) return {};
  std::sort(elevation.begin(), elevation.end());
  const auto beside =
      static_cast<std::size_t>(kBeside * static_cast<double>(elevation.size()) + 0.5);
  const double range = elevation[elevation.size() - 1 - beside] - elevation[beside];
  return {.are_one = range < kApart, .usual = statistics::median(elevation)};
}

std::vector<char> measured_vertices(const geometry::TriangleMesh& mesh, const PointCells& cells,
                                    const std::vector<float>& density, const std::vector<int>& seen,
                                    bool is_one_height) {
  constexpr float kSparsely = 0.1F;  // of the usual density
  constexpr int kFewSee = 7;         // photographs a vertex; then two that agree must do
  std::vector<int> usually = seen;
  const bool is_sparse = !usually.empty() && statistics::median(usually) < kFewSee;
  const double least_views = is_sparse ? 2.0 : is_one_height ? 3.0 : 2.75;
  const double share = is_one_height ? 0.45 : 0.4;
  const float least = kSparsely * statistics::median(density);
  std::vector<char> measured(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < measured.size(); ++i) {
    if (density[i] < least || seen[i] < 2) continue;
    const double views = cells.near(mesh.vertices[i]).views;
    measured[i] = views >= std::max(least_views, share * seen[i]) ? 1 : 0;
  }
  return measured;
}

}  // namespace palmar::capture
