// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/smooth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

double radial_noise(const TriangleMesh& mesh, double radius) {
  double squares = 0.0;
  for (const Vec3& v : mesh.vertices) squares += std::pow(v.norm() - radius, 2);
  return std::sqrt(squares / static_cast<double>(mesh.vertices.size()));
}

TEST(SmoothTaubin, TakesOutNoiseAndKeepsTheVolume) {
  TriangleMesh mesh = make_icosphere(20.0, 4);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.3, 0.3);
  for (Vec3& v : mesh.vertices) v += noise(random) * v.normalized();
  const TriangleMesh result = smooth_taubin(mesh);
  EXPECT_LT(radial_noise(result, 20.0), 0.4 * radial_noise(mesh, 20.0));
  EXPECT_NEAR(signed_volume(result) / signed_volume(mesh), 1.0, 5e-3);
  EXPECT_EQ(result.triangles, mesh.triangles);
}

TEST(SmoothTaubin, MultipliesAWaveByTheTransferFunction) {
  // On a closed ring of n edges (the border of a fan, which follows itself alone) the wave
  // cos(2 pi m i / n) has L = -k with k = 1 - cos(2 pi m / n).
  const int n = 24, m = 5, rounds = 4;
  TriangleMesh mesh;
  const double pi = std::acos(-1.0);
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * pi * i / n;
    mesh.vertices.emplace_back(std::cos(angle), std::sin(angle), std::cos(m * angle));
  }
  mesh.vertices.push_back(Vec3::Zero());
  for (int i = 0; i < n; ++i) mesh.triangles.push_back({i, (i + 1) % n, n});
  const TaubinOptions options{.rounds = rounds, .lambda = 0.6, .pass_band = 0.2};
  const double mu = 1.0 / (0.2 - 1.0 / 0.6), k = 1.0 - std::cos(2.0 * pi * m / n);
  const double gain = std::pow((1.0 - 0.6 * k) * (1.0 - mu * k), rounds);
  const TriangleMesh result = smooth_taubin(mesh, options);
  for (size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    EXPECT_NEAR(result.vertices[i].z(), gain * mesh.vertices[i].z(), 1e-12);
  }
}

TEST(SmoothTangentially, BringsADisturbedLatticeBackWithoutLeavingThePlane) {
  TriangleMesh mesh = make_lattice_patch(10.0, 1.0);
  const std::vector<Vec3> regular = mesh.vertices;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  std::vector<bool> is_border(mesh.vertices.size(), false);
  for (const auto& [a, b] : boundary_edges(build_topology(mesh))) {
    is_border[a] = is_border[b] = true;
  }
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_border[v]) mesh.vertices[v] += Vec3(noise(random), noise(random), 0.0);
  }
  // With its border held, the lattice is the only rest position.
  const TriangleMesh result = smooth_tangentially(mesh, {.rounds = 1500});
  for (size_t v = 0; v < mesh.vertices.size(); ++v) {
    EXPECT_EQ(result.vertices[v].z(), 0.0);
    EXPECT_NEAR((result.vertices[v] - regular[v]).norm(), 0.0, 1e-6);
    if (is_border[v]) {
      EXPECT_EQ(result.vertices[v], mesh.vertices[v]);
    }
  }
}

TEST(SmoothTangentially, KeepsTheVolumeOfASphere) {
  const TriangleMesh mesh = make_icosphere(20.0, 4);
  const TriangleMesh result = smooth_tangentially(mesh, {.rounds = 10});
  EXPECT_NEAR(signed_volume(result) / signed_volume(mesh), 1.0, 1e-3);
}

TEST(Smoothing, LeavesEmptyMeshesAndZeroRoundsAlone) {
  EXPECT_EQ(smooth_taubin({}).vertex_count(), 0);
  EXPECT_EQ(smooth_tangentially({}).vertex_count(), 0);
  const TriangleMesh mesh = make_box({1, 2, 3});
  EXPECT_EQ(smooth_taubin(mesh, {.rounds = 0}).vertices, mesh.vertices);
  EXPECT_EQ(smooth_tangentially(mesh, {.rounds = 0}).vertices, mesh.vertices);
}

TEST(Smoothing, NamesTheOptionThatIsOutOfRange) {
  try {
    smooth_taubin({}, {.lambda = 1.0});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "Taubin smoothing: lambda is 1; allowed is above 0 and below 1");
  }
  EXPECT_THROW(smooth_taubin({}, {.rounds = -1}), UsageError);
  EXPECT_THROW(smooth_taubin({}, {.pass_band = std::nan("")}), UsageError);
  EXPECT_THROW(smooth_tangentially({}, {.step = 0.0}), UsageError);
  EXPECT_NO_THROW(smooth_tangentially({}, {.step = 1.0}));
}

}  // namespace
}  // namespace palmar::geometry
