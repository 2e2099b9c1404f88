// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/photo/surface/poisson_surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "hands/imaging/iso_surface.h"
#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::capture {
namespace {

constexpr double kRadius = 15.0;  // mm
const Vec3 kCentre(3.0, -2.0, 20.0);

/// Points of a sphere, evenly by the golden angle; those that `keeps` wants.
template <typename Keeps>
std::vector<SurfacePoint> sphere_points(int count, const Keeps& keeps) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / count;
    const double angle = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
    const double r = std::sqrt(1.0 - z * z);
    const Vec3 normal(r * std::cos(angle), r * std::sin(angle), z);
    if (!keeps(normal)) continue;
    points.push_back({(kCentre + kRadius * normal).cast<float>(), normal.cast<float>(), 3});
  }
  return points;
}

/// A bound that holds everything.
imaging::Volume wide_bound() {
  imaging::Volume bound;
  bound.grid.size = {28, 28, 28};
  bound.grid.spacing = Vec3::Constant(1.5);
  bound.grid.origin = kCentre - Vec3::Constant(20.0);
  bound.value.assign(bound.grid.count(), 1.0F);
  return bound;
}

double largest_error(const geometry::TriangleMesh& mesh) {
  double largest = 0.0;
  for (const Vec3& vertex : mesh.vertices) {
    largest = std::max(largest, std::abs((vertex - kCentre).norm() - kRadius));
  }
  return largest;
}

TEST(PoissonField, ASphereComesBackAsOne) {
  const PoissonField field =
      fit_poisson_field(sphere_points(20000, [](const Vec3&) { return true; }), wide_bound());
  ASSERT_TRUE(field.has_converged);
  const geometry::TriangleMesh mesh = imaging::iso_surface(field.field, 0.0);
  const geometry::TopologyReport report = geometry::examine_topology(mesh);
  EXPECT_EQ(report.euler_number, 2);
  EXPECT_TRUE(report.is_closed);
  EXPECT_LT(largest_error(mesh), 0.1);  // mm; an eighth of a cell
  // 20000 points on 4 pi 15^2 mm^2.
  const double density =
      imaging::value_at(field.density, field.density.grid.to_voxel(kCentre + Vec3(0, kRadius, 0)));
  EXPECT_NEAR(density / (20000.0 / (4.0 * std::numbers::pi * kRadius * kRadius)), 1.0, 0.4);
}

TEST(PoissonField, AGapIsClosedSmoothly) {
  // Without the cap of 25 degrees about +z; its flat chord would lie 1.4 mm below the sphere.
  const PoissonField field = fit_poisson_field(
      sphere_points(20000, [](const Vec3& n) { return n.z() < std::cos(0.436); }), wide_bound());
  const geometry::TriangleMesh mesh = imaging::iso_surface(field.field, 0.0);
  EXPECT_EQ(geometry::examine_topology(mesh).euler_number, 2);
  EXPECT_LT(largest_error(mesh), 1.4);
}

TEST(PoissonField, NothingLiesBeyondTheBound) {
  imaging::Volume bound = wide_bound();
  for (int k = 0; k < bound.grid.size[2]; ++k) {
    for (int j = 0; j < bound.grid.size[1]; ++j) {
      for (int i = 0; i < bound.grid.size[0]; ++i) {
        if (bound.grid.to_patient(Vec3(i, j, k)).x() > kCentre.x() + 5.0) {
          bound.value[bound.grid.at(i, j, k)] = 0.0F;
        }
      }
    }
  }
  const PoissonField field =
      fit_poisson_field(sphere_points(20000, [](const Vec3&) { return true; }), bound);
  for (const Vec3& vertex : imaging::iso_surface(field.field, 0.0).vertices) {
    EXPECT_LT(vertex.x(), kCentre.x() + 5.0 + 2.5);  // mm; a voxel of the bound and a cell
  }
}

TEST(PoissonField, RefusesNothing) {
  EXPECT_THROW(fit_poisson_field({}, wide_bound()), InputError);
}

}  // namespace
}  // namespace palmar::capture
