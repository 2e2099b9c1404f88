// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/nonrigid_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/self_intersection.h"

namespace palmar::capture {
namespace {

FitSurface surface(geometry::TriangleMesh mesh, int part = 0) {
  FitSurface result;
  result.part.assign(mesh.vertices.size(), part);
  result.is_silent.assign(mesh.vertices.size(), 0);
  result.mesh = std::move(mesh);
  return result;
}

FitSurface joined(const FitSurface& a, const FitSurface& b) {
  FitSurface result = a;
  const int first = a.mesh.vertex_count();
  for (const Vec3& v : b.mesh.vertices) result.mesh.vertices.push_back(v);
  for (const Triangle& t : b.mesh.triangles) {
    result.mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  result.part.insert(result.part.end(), b.part.begin(), b.part.end());
  result.is_silent.insert(result.is_silent.end(), b.is_silent.begin(), b.is_silent.end());
  return result;
}

geometry::TriangleMesh moved(geometry::TriangleMesh mesh, const Vec3& scale, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v = v.cwiseProduct(scale) + by;
  return mesh;
}

TEST(NonrigidFit, BendsABallOntoAnEllipsoid) {
  const Vec3 half_axes(17.0, 14.0, 22.0), middle(2.0, -1.5, 1.0);
  const FitSurface moving = surface(geometry::make_icosphere(15.0, 3));
  const FitSurface fixed = surface(moved(geometry::make_icosphere(1.0, 4), half_axes, middle));
  const std::vector<Vec3> bent = fit_nonrigidly(moving, fixed);
  double worst = 0.0;
  for (const Vec3& v : bent) {
    // First-order distance to the ellipsoid f = 0.
    const Vec3 q = (v - middle).cwiseQuotient(half_axes);
    const double f = q.squaredNorm() - 1.0;
    const Vec3 slope = 2.0 * q.cwiseQuotient(half_axes);
    worst = std::max(worst, std::abs(f) / slope.norm());
  }
  EXPECT_LT(worst, 0.2);  // the last stiffness draws in where the curvature is highest
  const geometry::TriangleMesh result{bent, moving.mesh.triangles};
  EXPECT_TRUE(geometry::find_self_crossings(result).empty());
  const std::vector<double> angles = geometry::smallest_angles(result);
  EXPECT_GT(*std::min_element(angles.begin(), angles.end()), 0.3);  // rad
}

TEST(NonrigidFit, WhatHasNoPartnerFollowsItsSurroundings) {
  const FitSurface moving = surface(geometry::make_icosphere(15.0, 3));
  FitSurface fixed =
      surface(moved(geometry::make_icosphere(15.0, 4), Vec3::Ones(), Vec3(3.0, 0.0, 0.0)));
  const std::vector<Vec3> up = geometry::vertex_normals(fixed.mesh);
  for (std::size_t v = 0; v < up.size(); ++v) {
    if (up[v].z() < 0.8) continue;
    fixed.mesh.vertices[v] += 4.0 * up[v];  // a bump that is no skin
    fixed.is_silent[v] = 1;
  }
  for (const Vec3& v : fit_nonrigidly(moving, fixed)) {
    EXPECT_NEAR((v - Vec3(3.0, 0.0, 0.0)).norm(), 15.0, 0.5);
  }
}

// Two balls whose scans touch in the wrong places: each keeps to its own.
TEST(NonrigidFit, PartsKeepToThemselves) {
  const auto pair = [](int subdivisions, double x) {
    return joined(
        surface(moved(geometry::make_icosphere(8.0, subdivisions), Vec3::Ones(), Vec3(-x, 0, 0)),
                1),
        surface(moved(geometry::make_icosphere(8.0, subdivisions), Vec3::Ones(), Vec3(x, 0, 0)),
                2));
  };
  const FitSurface moving = pair(3, 9.0), fixed = pair(4, 8.1);
  const std::vector<Vec3> bent = fit_nonrigidly(moving, fixed);
  for (std::size_t v = 0; v < bent.size(); ++v) {
    const double side = moving.part[v] == 1 ? -8.1 : 8.1;
    EXPECT_NEAR((bent[v] - Vec3(side, 0, 0)).norm(), 8.0, 0.15);
  }
}

TEST(NonrigidFit, PinsHoldWhereTheShapeDoesNot) {
  const FitSurface moving = surface(geometry::make_icosphere(15.0, 3));
  const FitSurface fixed = surface(geometry::make_icosphere(15.0, 4));
  // A ball may be turned any way: four pins turn it by 0.2 rad about z.
  const Eigen::AngleAxisd turn(0.2, Vec3::UnitZ());
  std::vector<FitPin> pins;
  for (const Vec3& direction :
       {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(-Vec3::UnitX()), Vec3(-Vec3::UnitY())}) {
    int best = 0;
    for (int v = 0; v < moving.mesh.vertex_count(); ++v) {
      const auto& all = moving.mesh.vertices;
      if (direction.dot(all[v]) > direction.dot(all[best])) {
        best = v;
      }
    }
    pins.push_back({{best, best, best}, {1.0, 0.0, 0.0}, turn * moving.mesh.vertices[best]});
  }
  const std::vector<Vec3> bent = fit_nonrigidly(moving, fixed, pins);
  for (const FitPin& pin : pins) {
    EXPECT_LT((bent[pin.vertex[0]] - pin.place).norm(), 0.5);
  }
}

TEST(NonrigidFit, NamesTheOptionThatIsWrong) {
  try {
    fit_nonrigidly({}, {}, {}, {.levels = 0});
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "nonrigid fit: levels is 0; 1 to 100 is allowed");
  }
}

}  // namespace
}  // namespace palmar::capture
