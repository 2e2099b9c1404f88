// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/registration/icp.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <atomic>
#include <cmath>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/random.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/primitive_meshes.h"

namespace palmar::geometry {
namespace {

/// About the shape of a phalanx: 44 mm long, waisted, flat on one side, a broad base and a head of
/// two condyles. `flatness` 0 makes it a surface of revolution.
TriangleMesh phalanx(double flatness, int subdivisions = 4) {
  TriangleMesh mesh = make_icosphere(1.0, subdivisions);
  for (Vec3& v : mesh.vertices) {
    const double y = v.y();
    const double waist = 1.0 - 0.35 * std::exp(-4.0 * y * y) + (y < 0 ? 0.25 * y * y : 0.0);
    const double condyles = y > 0.0 ? flatness * 0.25 * y * y * v.x() * v.x() : 0.0;
    const double flat = v.z() > 0.0 ? 1.0 - 0.5 * flatness : 1.0 - 0.15 * flatness;
    v = Vec3(7.0 * waist * v.x(), 22.0 * y + 8.0 * condyles, 7.0 * waist * flat * v.z());
  }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Rigid3& motion) {
  for (Vec3& v : mesh.vertices) v = motion * v;
  return mesh;
}

TriangleMesh with_noise(TriangleMesh mesh, double sd, std::uint64_t seed) {
  RandomStream random(seed, 0);
  for (Vec3& v : mesh.vertices) v += sd * Vec3(random.normal(), random.normal(), random.normal());
  return mesh;
}

/// The part of a mesh whose triangles' centres have v . direction < offset.
TriangleMesh part_of(const TriangleMesh& mesh, const Vec3& direction, double offset) {
  TriangleMesh part = mesh;
  part.triangles.clear();
  for (const Triangle& t : mesh.triangles) {
    Vec3 middle = Vec3::Zero();
    for (const int v : t) middle += mesh.vertices[v] / 3.0;
    if (middle.dot(direction) < offset) part.triangles.push_back(t);
  }
  return part;
}

Rigid3 some_motion() {
  return Rigid3{Quat(Eigen::AngleAxisd(35.0 * kDegree, Vec3(0.4, -0.3, 0.85).normalized())),
                Vec3(12.0, -7.0, 20.0)};
}

double turn_between(const Rigid3& a, const Rigid3& b) {
  return a.rotation.angularDistance(b.rotation) / kDegree;
}

/// Largest distance between where two motions put the vertices, mm.
double farthest(const TriangleMesh& mesh, const Rigid3& a, const Rigid3& b) {
  double most = 0.0;
  for (const Vec3& v : mesh.vertices) most = std::max(most, (a * v - b * v).norm());
  return most;
}

TEST(RegisterRigidly, FindsTheMotionOfASurfaceExactly) {
  const TriangleMesh bone = phalanx(1.0);
  const Rigid3 truth = some_motion();
  const IcpResult result = register_rigidly(bone, moved(bone, truth));
  EXPECT_TRUE(result.has_converged);
  EXPECT_LT(farthest(bone, result.fixed_from_moving, truth), 1e-3);  // mm; ten times the tolerance
  EXPECT_LT(result.mean, 1e-3);
  EXPECT_GT(result.overlap, 0.99);
  EXPECT_GT(result.conditioning, 1e-3);
}

TEST(RegisterRigidly, RecoversFromAStartTurnedBySixtyDegreesAboutAnyAxis) {
  // Every direction of a lattice on the sphere; about its own long axis the bone is nearly a
  // surface of revolution.
  const TriangleMesh bone = phalanx(0.5, 3);
  const TriangleMesh other = phalanx(0.5, 4);  // cut into other triangles
  const Rigid3 truth = some_motion();
  const TriangleMesh fixed = moved(other, truth);
  for (int k = 0; k < 7; ++k) {
    const double z = 1.0 - (k + 0.5) / 3.5, phi = 2.399963 * k;
    const Vec3 axis(std::sqrt(1.0 - z * z) * std::cos(phi), z,
                    std::sqrt(1.0 - z * z) * std::sin(phi));
    const Rigid3 wrong = truth * Rigid3::about_axis(axis, Vec3(0.0, -22.0, 0.0), 60.0 * kDegree);
    const IcpResult result = register_rigidly(bone, fixed, wrong);
    EXPECT_LT(turn_between(result.fixed_from_moving, truth), 1.0) << "axis " << axis.transpose();
    EXPECT_LT(farthest(bone, result.fixed_from_moving, truth), 0.2) << "axis " << axis.transpose();
  }
  for (const double sign : {-1.0, 1.0}) {
    const Rigid3 wrong =
        truth * Rigid3::about_axis(Vec3::UnitY(), Vec3::Zero(), sign * 60.0 * kDegree);
    EXPECT_LT(turn_between(register_rigidly(bone, fixed, wrong).fixed_from_moving, truth), 1.0);
  }
}

/// Standard deviation of the least certain turn if every vertex of both surfaces errs by `sd`
/// along its normal, independently: the lower bound of Cramer and Rao, rad.
double least_turn_error(const TriangleMesh& mesh, double sd) {
  const std::vector<Vec3> normal = vertex_normals(mesh);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < normal.size(); ++i) {
    const Vec3 lever = mesh.vertices[i].cross(normal[i]);
    information += lever * lever.transpose() / (2.0 * sd * sd);
  }
  return std::sqrt(1.0 /
                   Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()[0]);
}

TEST(RegisterRigidly, NoiseOfTheVerticesAveragesOut) {
  constexpr double kNoise = 0.3;  // mm
  const TriangleMesh bone = phalanx(1.0, 3);
  const Rigid3 truth = some_motion();
  const double bound = least_turn_error(bone, kNoise) / kDegree;
  ASSERT_LT(bound, 1.2);
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const TriangleMesh seen = with_noise(bone, kNoise, seed);
    const TriangleMesh fixed = with_noise(moved(phalanx(1.0, 4), truth), kNoise, seed + 10);
    const IcpResult result = register_rigidly(seen, fixed);
    EXPECT_LT(turn_between(result.fixed_from_moving, truth), 3.0 * bound);
    EXPECT_LT((result.fixed_from_moving * Vec3::Zero() - truth * Vec3::Zero()).norm(), 0.25);
    // Two surfaces with normal errors of 0.3 mm each (less between vertices) stand
    // 0.3 sqrt(2) sqrt(2 / pi) = 0.34 mm apart at most.
    EXPECT_LT(result.mean, 0.34);
    EXPECT_GT(result.mean, 0.1);
  }
}

TEST(RegisterRigidly, HoldsWithPartsMissingOnEitherSide) {
  const TriangleMesh bone = phalanx(1.0);
  const Rigid3 truth = some_motion();
  const Vec3 across = Vec3(0.2, 1.0, 0.1).normalized();
  // About 40 % of the area lies beyond this plane.
  const TriangleMesh part = part_of(bone, across, 3.5);
  ASSERT_NEAR(surface_area(part) / surface_area(bone), 0.6, 0.05);
  const IcpResult onto_part = register_rigidly(bone, moved(part, truth));
  EXPECT_LT(farthest(bone, onto_part.fixed_from_moving, truth), 0.01);
  EXPECT_LT(onto_part.overlap, 0.75);
  EXPECT_GT(onto_part.mean, 0.5);
  const IcpResult of_part = register_rigidly(part, moved(bone, truth));
  EXPECT_LT(farthest(bone, of_part.fixed_from_moving, truth), 0.01);
  EXPECT_GT(of_part.overlap, 0.99);
}

TEST(RegisterRigidly, ConditioningReportsWhatTheShapeDoesNotHold) {
  const TriangleMesh ball = make_icosphere(10.0, 4);
  const Rigid3 truth = some_motion();
  const IcpResult result = register_rigidly(ball, moved(ball, truth));
  EXPECT_LT(result.conditioning, 1e-4);
  EXPECT_LT(result.mean, 0.02);  // mm; half the sagitta of a facet
  EXPECT_LT((result.fixed_from_moving * Vec3::Zero() - truth * Vec3::Zero()).norm(), 0.02);
  EXPECT_LT(register_rigidly(phalanx(0.0), phalanx(0.0)).conditioning, 1e-4);
  EXPECT_GT(register_rigidly(phalanx(1.0), phalanx(1.0)).conditioning, 1e-3);
}

TEST(RegisterRigidly, ASurfaceTurnedInsideOutHasNoPartners) {
  const TriangleMesh bone = phalanx(1.0, 3);
  TriangleMesh flipped = bone;
  for (Triangle& t : flipped.triangles) std::swap(t[1], t[2]);
  const IcpResult result = register_rigidly(bone, flipped);
  // A few vertices face some other side; of the surface itself it is more than 0.99 (above).
  EXPECT_LT(result.overlap, 0.4);
}

TEST(RegisterRigidly, SameInputGivesTheSameBytes) {
  const TriangleMesh bone = phalanx(1.0, 3);
  const TriangleMesh fixed = with_noise(moved(bone, some_motion()), 0.2, 5);
  const IcpResult a = register_rigidly(bone, fixed), b = register_rigidly(bone, fixed);
  EXPECT_EQ(a.fixed_from_moving.translation, b.fixed_from_moving.translation);
  EXPECT_EQ(a.fixed_from_moving.rotation.coeffs(), b.fixed_from_moving.rotation.coeffs());
  EXPECT_EQ(a.mean, b.mean);
}

TEST(RegisterRigidly, SaysWhatIsWrong) {
  const TriangleMesh bone = phalanx(1.0, 2);
  const auto message = [&](const auto& call) -> std::string {
    try {
      call();
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message([&] { register_rigidly({}, bone); }),
            "registration: the moving surface has no area (0 triangles); a surface is required");
  EXPECT_NE(message([&] { register_rigidly(bone, {}); }).find("the fixed surface"),
            std::string::npos);
  EXPECT_NE(message([&] {
              register_rigidly(bone, bone, {}, {.trim = 1.0});
            }).find("trim is 1.000000; 0 to 0.9"),
            std::string::npos);
  const std::atomic<bool> cancel{true};
  EXPECT_THROW(register_rigidly(bone, bone, {}, {}, {.report = {}, .cancel = &cancel}), Cancelled);
}

}  // namespace
}  // namespace palmar::geometry
