// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/surface_markers.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "hands/imaging/connected_parts.h"

namespace palmar::capture {
namespace {

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Visits the voxels within `reach` [mm] of a point: index and position in the patient frame.
template <typename Visit>
void each_voxel_near(const imaging::VolumeGrid& grid, const Vec3& point, double reach,
                     const Visit& visit) {
  const Vec3 voxel = grid.to_voxel(point);
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto e = static_cast<Eigen::Index>(a);
    low[a] = std::max(0, static_cast<int>(std::ceil(voxel[e] - reach / grid.spacing[e])));
    high[a] = std::min(grid.size[a] - 1,
                       static_cast<int>(std::floor(voxel[e] + reach / grid.spacing[e])));
  }
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        const Vec3 place = grid.to_patient(Vec3(i, j, k));
        if ((place - point).norm() <= reach) visit(grid.at(i, j, k), place);
      }
    }
  }
}

/// Gauss-Newton with damping on the centre and the brightness.
Vec3 fitted_centre(const imaging::Volume& image, const imaging::VoxelMask& body, const Vec3& start,
                   double bright, double radius) {
  const double blur = 0.5 * std::cbrt(image.grid.spacing.prod());
  Eigen::Vector4d x(start.x(), start.y(), start.z(), bright);
  for (int iteration = 0; iteration < 12; ++iteration) {
    Eigen::Matrix4d normal = Eigen::Matrix4d::Identity() * 1e-6;
    Eigen::Vector4d right = Eigen::Vector4d::Zero();
    const Vec3 centre = x.head<3>();
    each_voxel_near(image.grid, centre, radius + 1.6, [&](std::size_t v, const Vec3& place) {
      if (body[v] != 0) return;
      const Vec3 from = place - centre;
      const double r = std::max(from.norm(), 1e-6), z = (radius - r) / blur;
      const double share = normal_distribution(z);
      const double slope = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::acos(-1.0)) / blur;
      Eigen::Vector4d gradient;
      gradient.head<3>() = x[3] * slope / r * from / bright;
      gradient[3] = share / bright;
      const double residual = (static_cast<double>(image.value[v]) - x[3] * share) / bright;
      normal += gradient * gradient.transpose();
      right += gradient * residual;
    });
    const Eigen::Vector4d step = normal.ldlt().solve(right);
    if (!step.allFinite()) break;
    const double length = step.head<3>().norm();
    x += length > 0.5 ? Eigen::Vector4d(step * (0.5 / length)) : step;
    if (length < 1e-3) break;
  }
  const Vec3 centre = x.head<3>();
  return (centre - start).norm() < radius ? centre : start;
}

}  // namespace

SurfaceMarkers find_surface_markers(const imaging::Volume& image, const imaging::VoxelMask& tissue,
                                    double least, double diameter) {
  const imaging::VolumeGrid& grid = image.grid;
  const double radius = 0.5 * diameter;
  SurfaceMarkers markers;
  markers.mask.assign(tissue.size(), 0);
  const imaging::VoxelMask body =
      imaging::opened(grid, tissue, 1.2 * radius + 0.3 * grid.spacing.maxCoeff());
  imaging::VoxelMask thin(tissue.size());
  for (std::size_t v = 0; v < thin.size(); ++v) {
    thin[v] =
        tissue[v] != 0 && body[v] == 0 && static_cast<double>(image.value[v]) > 0.5 * least ? 1 : 0;
  }
  const imaging::ConnectedParts parts = imaging::connected_parts(grid, thin);
  struct Moments {
    double sum = 0.0, squares = 0.0, brightest = 0.0;
    Vec3 first = Vec3::Zero();
  };
  std::vector<Moments> moments(parts.count());
  for (int k = 0; k < grid.size[2]; ++k) {
    for (int j = 0; j < grid.size[1]; ++j) {
      for (int i = 0; i < grid.size[0]; ++i) {
        const std::size_t v = grid.at(i, j, k);
        if (parts.part[v] < 0) continue;
        Moments& m = moments[parts.part[v]];
        const Vec3 place = grid.to_patient(Vec3(i, j, k));
        const auto value = static_cast<double>(image.value[v]);
        m.sum += value;
        m.first += value * place;
        m.squares += value * place.squaredNorm();
        m.brightest = std::max(m.brightest, value);
      }
    }
  }
  const double ball = 4.0 / 3.0 * std::acos(-1.0) * radius * radius * radius;
  for (int p = 0; p < parts.count(); ++p) {
    const Moments& m = moments[p];
    if (m.brightest < least) continue;
    const double volume = m.sum / m.brightest * grid.spacing.prod();
    const Vec3 middle = m.first / m.sum;
    const double spread = std::sqrt(std::max(0.0, m.squares / m.sum - middle.squaredNorm()));
    // Of a ball: sqrt(3/5) of its radius.
    const double expected = std::sqrt(0.6) * radius;
    if (volume < ball / 2.2 || volume > ball * 1.6) continue;
    if (spread < expected / 1.6 || spread > expected * 1.6) continue;
    const Vec3 centre = fitted_centre(image, body, middle, m.brightest, radius);
    markers.centre.push_back(centre);
    each_voxel_near(grid, centre, radius + 1.2, [&](std::size_t v, const Vec3&) {
      if (body[v] == 0) markers.mask[v] = 1;
    });
  }
  return markers;
}

}  // namespace palmar::capture
