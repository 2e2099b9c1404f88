// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/layer_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::capture {
namespace {

/// A ball with a dark shell as an image of square voxels shows it along a ray: signals are averaged
/// over the voxel's width, not blurred by a bell as the fit takes it.
struct ShelledBall {
  double outer = 10.4, thickness = 0.9;              // mm
  double inside = 1.0, shell = 0.05, outside = 0.5;  // signal
  double voxel = 1.2;                                // mm
  double part_below(double r, double edge) const {   // of the voxel at r
    return std::clamp((edge - r) / voxel + 0.5, 0.0, 1.0);
  }
  double signal(double r) const {
    const double in = part_below(r, outer - thickness), in_or_shell = part_below(r, outer);
    return inside * in + shell * (in_or_shell - in) + outside * (1.0 - in_or_shell);
  }
  LayerProfile along(const Vec3& from, const Vec3& normal) const {
    LayerProfile profile;
    profile.first = -4.0;
    profile.blur = voxel / std::sqrt(12.0);
    profile.known = shell;
    for (double s = profile.first; s < 4.0; s += profile.step) {
      profile.value.push_back(signal((from + s * normal).norm()));
    }
    return profile;
  }
};

/// Least and largest distance of the vertices from the middle.
std::pair<double, double> radii(const geometry::TriangleMesh& mesh) {
  double least = 1e9, most = 0.0;
  for (const Vec3& p : mesh.vertices) {
    least = std::min(least, p.norm());
    most = std::max(most, p.norm());
  }
  return {least, most};
}

// An eighth of a voxel.
TEST(FitLayers, FindsBothSidesOfAShellThinnerThanAVoxel) {
  for (const double thickness : {0.5, 0.9, 1.6}) {
    ShelledBall ball;
    ball.thickness = thickness;
    const geometry::TriangleMesh near =
        geometry::make_icosphere(10.0, 3);  // 0.4 mm inside of the outer side
    LayerSearch search;
    const LayerFit fit = fit_layers(near, search, [&](int v, const Vec3& normal) {
      return ball.along(near.vertices[v], normal);
    });
    const auto [least, most] = radii(fit.mesh);
    EXPECT_NEAR(least, 10.4, 0.15) << thickness;
    EXPECT_NEAR(most, 10.4, 0.15) << thickness;
    for (const double found : fit.thickness) EXPECT_NEAR(found, thickness, 0.25);
    EXPECT_LT(fit.residual, 1.0);
  }
}

TEST(FitLayers, SignalsOfInsideAndOutsideMayDifferFromTheExpectedOnes) {
  ShelledBall ball;
  ball.inside = 0.8;
  ball.outside = 0.3;
  const geometry::TriangleMesh near = geometry::make_icosphere(10.0, 3);
  const LayerFit fit = fit_layers(
      near, {}, [&](int v, const Vec3& normal) { return ball.along(near.vertices[v], normal); });
  const auto [least, most] = radii(fit.mesh);
  EXPECT_NEAR(least, 10.4, 0.15);
  EXPECT_NEAR(most, 10.4, 0.15);
}

TEST(FitLayers, VerticesThatDetermineNothingFollowTheirNeighbours) {
  const ShelledBall ball;
  const geometry::TriangleMesh near = geometry::make_icosphere(10.0, 3);
  const LayerFit fit = fit_layers(near, {}, [&](int v, const Vec3& normal) {
    if (v % 5 == 0) return LayerProfile();
    return ball.along(near.vertices[v], normal);
  });
  const auto [least, most] = radii(fit.mesh);
  EXPECT_NEAR(least, 10.4, 0.2);
  EXPECT_NEAR(most, 10.4, 0.2);
}

}  // namespace
}  // namespace palmar::capture
