// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/mesh_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <random>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/distance/winding_number.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/geometry/repair/orient.h"

namespace palmar::geometry {
namespace {

std::vector<Vec3> random_points(int count, const Box3& box, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 u;
    for (int k = 0; k < 3; ++k) u[k] = static_cast<double>(generator()) / 4294967296.0;
    points.push_back(box.min() + u.cwiseProduct(box.sizes()));
  }
  return points;
}

Box3 cube(double half) { return Box3(Vec3::Constant(-half), Vec3::Constant(half)); }

std::vector<DistanceSample> sample(const DistanceField& field, const std::vector<Vec3>& points,
                                   double range = std::numeric_limits<double>::infinity()) {
  std::vector<DistanceSample> samples(points.size());
  field.sample(points, range, samples);
  return samples;
}

TriangleMesh capped_cylinder() {
  return make_cylinder({.radius = 20.0, .length = 100.0, .segments = 96, .rings = 40});
}

/// The cylinder cut into `sectors` x 6 patches that share no vertex and are moved by up to
/// `gap` [mm]; optionally without the end at +z; patches in `flipped` turned inside out.
TriangleMesh patched_cylinder(int sectors, double gap, bool has_end,
                              const std::vector<int>& flipped = {}) {
  const TriangleMesh whole = capped_cylinder();
  TriangleMesh mesh;
  std::mt19937 generator(7);
  std::map<int, Vec3> shift;
  std::map<std::pair<int, int>, int> vertex;  // (patch, vertex of the whole)
  for (const Triangle& t : whole.triangles) {
    const Vec3 c = (whole.vertices[t[0]] + whole.vertices[t[1]] + whole.vertices[t[2]]) / 3.0;
    const bool is_end = c.z() > 49.999;
    if (is_end && !has_end) continue;
    const int sector = std::min(
        sectors - 1,
        static_cast<int>((std::atan2(c.y(), c.x()) / (2.0 * std::numbers::pi) + 0.5) * sectors));
    const int band = std::min(5, static_cast<int>((c.z() + 50.0) / 100.0 * 6.0));
    const int patch = std::abs(c.z()) > 49.999 ? (is_end ? -1 : -2) : sector * 6 + band;
    if (!shift.count(patch)) {
      Vec3 s;
      for (int k = 0; k < 3; ++k) s[k] = gap * (generator() / 2147483648.0 - 1.0);
      shift[patch] = s;
    }
    Triangle copy;
    for (int k = 0; k < 3; ++k) {
      const auto [at, is_new] = vertex.try_emplace({patch, t[k]}, mesh.vertex_count());
      if (is_new) mesh.vertices.push_back(whole.vertices[t[k]] + shift[patch]);
      copy[k] = at->second;
    }
    if (std::find(flipped.begin(), flipped.end(), patch) != flipped.end()) {
      std::swap(copy[1], copy[2]);
    }
    mesh.triangles.push_back(copy);
  }
  return mesh;
}

/// Points at which the sign of `field` differs from that of the ideal cylinder, of those farther
/// than 0.1 mm (gaps and chords are below) from its surface.
int wrong_signs(const DistanceField& field, const std::vector<Vec3>& points) {
  const auto ideal = make_cylinder_distance({.radius = 20.0, .length = 100.0});
  const auto truth = sample(*ideal, points), found = sample(field, points);
  int wrong = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::abs(truth[i].distance) < 0.1) continue;
    if ((truth[i].distance < 0.0) != (found[i].distance < 0.0)) ++wrong;
  }
  return wrong;
}

const Box3 kRoundCylinder(Vec3(-30, -30, -60), Vec3(30, 30, 60));

TEST(MeshDistance, EqualsTheClosedFormOfABox) {
  const Vec3 size(40.0, 30.0, 90.0);
  const MeshDistance mesh(make_box(size, 7));
  const auto exact = make_box_distance(size);
  const auto points = random_points(4000, cube(60.0), 1);
  const auto found = sample(mesh, points), truth = sample(*exact, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    // The faces are planes: only rounding is left.
    ASSERT_NEAR(found[i].distance, truth[i].distance, 1e-11) << points[i].transpose();
    ASSERT_NEAR((points[i] - found[i].closest).norm(), std::abs(found[i].distance), 1e-11);
    ASSERT_NEAR(found[i].normal.norm(), 1.0, 1e-12);
  }
}

TEST(MeshDistance, OfAFineSphereIsWithinTheChordalErrorOfTheSphere) {
  const double radius = 25.0;
  const MeshDistance mesh(make_icosphere(radius, 5));
  const auto points = random_points(3000, cube(40.0), 2);
  const auto found = sample(mesh, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double truth = points[i].norm() - radius;
    // Edges of 0.9 mm leave gaps of e^2 / 6 R = 0.006 mm; the mesh lies inside the sphere.
    ASSERT_GT(found[i].distance, truth - 1e-9);
    ASSERT_LT(found[i].distance, truth + 0.012);
    if (points[i].norm() > 5.0) {
      ASSERT_GT(found[i].normal.dot(points[i].normalized()), 0.99);
    }
  }
}

TEST(MeshDistance, AgreesWithTryingEveryTriangle) {
  const TriangleMesh mesh = make_torus(30.0, 9.0, 40, 20);
  const ClosestPointQuery query(mesh);
  for (const Vec3& p : random_points(300, cube(50.0), 3)) {
    double best2 = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.triangles) {
      best2 = std::min(best2, closest_point_on_triangle(p, mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                        mesh.vertices[t[2]])
                                  .squared_distance);
    }
    const auto found = query.closest(p);
    ASSERT_TRUE(found);
    ASSERT_NEAR(found->distance, std::sqrt(best2), 1e-12);
    // A hint, even a bad one, changes nothing.
    const auto hinted = query.closest(p, 1000.0, mesh.triangle_count() / 2);
    ASSERT_EQ(hinted->triangle, found->triangle);
    ASSERT_EQ(hinted->distance, found->distance);
  }
}

TEST(MeshDistance, NormalOnTheSurfaceIsThePseudoNormalOfFaceEdgeAndCorner) {
  const MeshDistance box(make_box(Vec3(20.0, 20.0, 20.0), 2));
  EXPECT_LT((box.at({10.0, 3.0, 2.0}).normal - Vec3::UnitX()).norm(), 1e-9);
  EXPECT_LT((box.at({10.0, 10.0, 2.0}).normal - Vec3(1, 1, 0).normalized()).norm(), 1e-9);
  EXPECT_LT((box.at({10.0, 10.0, 10.0}).normal - Vec3(1, 1, 1).normalized()).norm(), 1e-9);
  EXPECT_NEAR(box.at({10.0, 10.0, 10.0}).distance, 0.0, 1e-12);
}

TEST(MeshDistance, SmoothNormalIsThatOfTheSurfaceThatFacetsStandFor) {
  // Facets of 15 degrees, from 2 mm inside to 1 mm outside: their own normals are up to 7.5 degrees
  // off the round bar's, and jump by 15.
  const MeshDistance field(
      make_cylinder({.radius = 20.0, .length = 100.0, .segments = 24, .rings = 40}));
  double facets = 0.0, smooth = 0.0, jump = 0.0;
  std::optional<Vec3> last;
  for (double angle = 0.0; angle < 2.0; angle += 1e-3) {
    for (const double radius : {18.0, 19.5, 21.0}) {
      const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
      const DistanceSample at = field.at(radius * out + Vec3(0, 0, 1.3));
      const Vec3 normal = field.smooth_normal(at);
      EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
      facets = std::max(facets, std::acos(std::min(1.0, at.normal.dot(out))));
      smooth = std::max(smooth, std::acos(std::min(1.0, normal.dot(out))));
      if (radius == 18.0) {
        if (last) jump = std::max(jump, (normal - *last).norm());
        last = normal;
      }
    }
  }
  constexpr double kDegree = std::numbers::pi / 180.0;
  EXPECT_GT(facets, 7.0 * kDegree);
  EXPECT_LT(smooth, 1.5 * kDegree);
  EXPECT_LT(jump, 2.0 * kDegree);
  // Across an edge nothing is smoothed.
  const MeshDistance box(make_box({20.0, 20.0, 20.0}, 4));
  const DistanceSample near_edge = box.at(Vec3(9.9, 9.0, 0.0));
  EXPECT_LT((box.smooth_normal(near_edge) - Vec3::UnitX()).norm(), 1e-12);
}

TEST(MeshDistance, BeyondTheRangeSaysSideOnly) {
  const MeshDistance sphere(make_icosphere(30.0, 4));
  const auto samples = sample(sphere, {Vec3(0, 0, 45), Vec3(0, 0, 1), Vec3(0, 0, 33)}, 5.0);
  EXPECT_EQ(samples[0].distance, 5.0);
  EXPECT_EQ(samples[0].triangle, -1);
  EXPECT_EQ(samples[1].distance, -5.0);
  EXPECT_EQ(samples[1].triangle, -1);
  EXPECT_NEAR(samples[2].distance, 3.0, 0.05);
  EXPECT_GE(samples[2].triangle, 0);
}

TEST(MeshDistance, RigidMotionChangesNothing) {
  const TriangleMesh mesh = make_torus(30.0, 9.0, 40, 20);
  const Quat turn(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
  const Vec3 shift(500.0, -300.0, 200.0);
  TriangleMesh moved = mesh;
  for (Vec3& x : moved.vertices) x = turn * x + shift;
  const auto points = random_points(500, cube(50.0), 4);
  std::vector<Vec3> moved_points;
  for (const Vec3& p : points) moved_points.push_back(turn * p + shift);
  const auto a = sample(MeshDistance(mesh), points);
  const auto b = sample(MeshDistance(moved), moved_points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_NEAR(a[i].distance, b[i].distance, 1e-9);
    ASSERT_LT((turn * a[i].normal - b[i].normal).norm(), 1e-6);
  }
}

TEST(MeshDistance, SignIsRightOnAWatertightMesh) {
  const MeshDistance field(capped_cylinder());
  EXPECT_TRUE(field.is_closed());
  EXPECT_EQ(wrong_signs(field, random_points(10000, kRoundCylinder, 5)), 0);
}

TEST(MeshDistance, SignIsRightWithUnsharedPatchesAndGaps) {
  const MeshDistance field(patched_cylinder(8, 0.01, true));
  EXPECT_FALSE(field.is_closed());
  EXPECT_EQ(wrong_signs(field, random_points(10000, kRoundCylinder, 6)), 0);
}

TEST(MeshDistance, SignIsRightAwayFromAMissingEnd) {
  const MeshDistance field(patched_cylinder(8, 0.01, false));
  // The winding number closes the open end (radius 20 mm) with a surface that sags inwards; 25 mm
  // below the end, and above it, nothing is doubtful.
  Box3 below(Vec3(-30, -30, -60), Vec3(30, 30, 25)), above(Vec3(-30, -30, 50.2), Vec3(30, 30, 60));
  EXPECT_EQ(wrong_signs(field, random_points(5000, below, 7)), 0);
  EXPECT_EQ(wrong_signs(field, random_points(5000, above, 8)), 0);
}

TEST(MeshDistance, SignIsRightInOverlappingSolids) {
  // Two spheres 20 mm apart that go through each other; nobody united them.
  TriangleMesh mesh = make_icosphere(20.0, 4);
  const int n = mesh.vertex_count();
  const TriangleMesh other = mesh;
  for (Vec3 x : other.vertices) mesh.vertices.push_back(x + Vec3(20.0, 0.0, 0.0));
  for (const Triangle& t : other.triangles) {
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  const auto points = random_points(5000, Box3(Vec3(-25, -25, -25), Vec3(45, 25, 25)), 9);
  const auto found = sample(MeshDistance(mesh), points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double truth = std::min(points[i].norm(), (points[i] - Vec3(20, 0, 0)).norm()) - 20.0;
    if (std::abs(truth) < 0.1) continue;
    ASSERT_EQ(found[i].distance < 0.0, truth < 0.0) << points[i].transpose();
  }
}

TEST(MeshDistance, DoesNotDependOnThreadsOrCompany) {
  const MeshDistance field(patched_cylinder(8, 0.01, false));
  const auto points = random_points(5000, kRoundCylinder, 10);
  const auto many = sample(field, points, 15.0);
  set_thread_count(1);
  const auto one = sample(field, points, 15.0);
  set_thread_count(0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(many[i].distance, one[i].distance);
    ASSERT_EQ(many[i].triangle, one[i].triangle);
  }
  for (std::size_t i = 0; i < points.size(); i += 100) {
    ASSERT_EQ(sample(field, {points[i]}, 15.0)[0].distance, many[i].distance);
  }
}

TEST(MeshDistance, FromEarlierSamplesSaysTheSameAsFromNone) {
  const std::vector<Vec3> points = random_points(3000, kRoundCylinder, 14);
  const std::vector<Vec3> ways = random_points(3000, cube(3.0), 15);
  std::vector<Vec3> moved;
  for (std::size_t i = 0; i < points.size(); ++i) moved.push_back(points[i] + ways[i]);
  for (const TriangleMesh& mesh : {capped_cylinder(), patched_cylinder(8, 0.01, false)}) {
    const MeshDistance field(mesh);
    std::vector<DistanceSample> found = sample(field, points, 9.0);
    field.resample(moved, 12.0, found);
    const std::vector<DistanceSample> truth = sample(field, moved, 12.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_EQ(found[i].distance, truth[i].distance) << moved[i].transpose();
      ASSERT_EQ(found[i].closest, truth[i].closest);
      ASSERT_EQ(found[i].triangle, truth[i].triangle);
    }
  }
}

TEST(MeshDistance, OnTheSurfaceHasNoSide) {
  const MeshDistance box(make_box(Vec3(20.0, 20.0, 20.0), 3));
  for (const double off : {-9e-8, 0.0, 9e-8}) {
    const DistanceSample s = box.at({10.0 + off, 3.1, 2.3});
    EXPECT_NEAR(s.distance, std::abs(off), 1e-14) << off;
    EXPECT_GE(s.distance, 0.0);
    EXPECT_LT((s.normal - Vec3::UnitX()).norm(), 1e-9);
  }
  EXPECT_LT(box.at({10.0 - 2e-7, 3.1, 2.3}).distance, 0.0);
}

TEST(MeshDistance, CopesWithDegenerateTrianglesAndEmptyMeshes) {
  TriangleMesh mesh = make_box(Vec3(20, 20, 20), 1);
  mesh.triangles.push_back({0, 0, 1});
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.triangles.push_back({0, 1, mesh.vertex_count() - 1});
  EXPECT_NEAR(MeshDistance(mesh).at({0, 0, 15}).distance, 5.0, 1e-12);
  EXPECT_NEAR(MeshDistance(mesh).at({0, 0, 8}).distance, -2.0, 1e-12);

  const DistanceSample nothing = MeshDistance(TriangleMesh{}).at({1, 2, 3});
  EXPECT_EQ(nothing.distance, std::numeric_limits<double>::infinity());
  EXPECT_EQ(nothing.triangle, -1);
}

TEST(MeshDistance, NamesAVertexThatIsNotFinite) {
  TriangleMesh mesh = make_box(Vec3(20, 20, 20), 1);
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  try {
    MeshDistance field(mesh);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("vertex 3"));
    EXPECT_THAT(error.what(), testing::HasSubstr("finite"));
  }
}

TEST(ClosestPointOnTriangle, FindsFaceEdgeAndCorner) {
  const Vec3 a(0, 0, 0), b(4, 0, 0), c(0, 3, 0);
  const TrianglePoint face = closest_point_on_triangle({1, 1, 2}, a, b, c);
  EXPECT_LT((face.point - Vec3(1, 1, 0)).norm(), 1e-12);
  EXPECT_NEAR(face.squared_distance, 4.0, 1e-12);
  const TrianglePoint edge = closest_point_on_triangle({2, -1, 0}, a, b, c);
  EXPECT_LT((edge.point - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_EQ(edge.weights[2], 0.0);
  const TrianglePoint corner = closest_point_on_triangle({6, -1, 0}, a, b, c);
  EXPECT_LT((corner.point - b).norm(), 1e-12);
  EXPECT_EQ(corner.weights[1], 1.0);
  // A triangle that is a segment, and one that is a point.
  EXPECT_NEAR(closest_point_on_triangle({2, 1, 0}, a, b, b).squared_distance, 1.0, 1e-12);
  EXPECT_NEAR(closest_point_on_triangle({0, 0, 3}, a, a, a).squared_distance, 9.0, 1e-12);
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideAClosedMesh) {
  const TriangleMesh mesh = make_torus(30.0, 9.0, 60, 30);
  const WindingNumber winding(mesh);
  double worst = 0.0;
  for (const Vec3& p : random_points(3000, cube(42.0), 11)) {
    const double ring = std::hypot(std::hypot(p.x(), p.y()) - 30.0, p.z()) - 9.0;
    if (std::abs(ring) < 0.2) continue;  // chords
    const double truth = ring < 0.0 ? 1.0 : 0.0;
    worst = std::max(worst, std::abs(winding.at(p) - truth));
    ASSERT_EQ(winding.whole_at(p), static_cast<int>(truth));
  }
  EXPECT_LT(worst, 0.02);
}

TEST(WindingNumber, OfADiscIsItsSolidAngle) {
  // Solid angle of a disc of radius a seen from height h on its axis: 2 pi (1 - h / sqrt(h^2+a^2)).
  const TriangleMesh disc = make_lattice_patch(20.0, 0.25);
  const WindingNumber winding(disc);
  for (const double h : {1.0, 5.0, 20.0, 60.0}) {
    const double truth = 0.5 * (1.0 - h / std::hypot(h, 20.0));
    // The rim of the lattice is jagged by a spacing: 1 % of the solid angle.
    EXPECT_NEAR(winding.at({0, 0, -h}), truth, 0.02) << h;
    EXPECT_NEAR(winding.at({0, 0, h}), -truth, 0.02) << h;
  }
}

TEST(WindingNumber, ExpansionAgreesWithTheFullSum) {
  for (const TriangleMesh& mesh :
       {patched_cylinder(8, 0.01, false), make_icosphere(20.0, 3), make_torus(20.0, 12.0, 16, 9)}) {
    const WindingNumber winding(mesh);
    for (const Vec3& p : random_points(300, kRoundCylinder, 12)) {
      ASSERT_NEAR(winding.at(p), exact_winding_number(mesh, p), 0.02);
    }
  }
}

TEST(OrientOutwards, TurnsFlippedPatchesBack) {
  const std::vector<int> flipped = {3, 17, 30, 41};
  const TriangleMesh mesh = patched_cylinder(8, 0.01, false, flipped);
  const auto points = random_points(4000, Box3(Vec3(-30, -30, -60), Vec3(30, 30, 25)), 13);
  EXPECT_GT(wrong_signs(MeshDistance(mesh), points), 20);  // so the repair is needed
  const OrientResult repaired = orient_outwards(mesh);
  EXPECT_EQ(repaired.patches, 49);
  EXPECT_EQ(repaired.flipped_patches, 4);
  EXPECT_EQ(repaired.undecided_patches, 0);
  EXPECT_EQ(wrong_signs(MeshDistance(repaired.mesh), points), 0);
}

TEST(OrientOutwards, LeavesAGoodMeshAlone) {
  const TriangleMesh mesh = make_torus(30.0, 9.0, 40, 20);
  const OrientResult result = orient_outwards(mesh);
  EXPECT_TRUE(result.flipped_triangles.empty());
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
  EXPECT_EQ(result.patches, 1);
}

TEST(OrientOutwards, TurnsAnInvertedSolidAndMendsSingleTriangles) {
  TriangleMesh inverted = make_icosphere(20.0, 2);
  for (Triangle& t : inverted.triangles) std::swap(t[0], t[1]);
  const OrientResult turned = orient_outwards(inverted);
  EXPECT_EQ(turned.flipped_patches, 1);
  EXPECT_EQ(static_cast<int>(turned.flipped_triangles.size()), inverted.triangle_count());
  EXPECT_LT(MeshDistance(turned.mesh).at({0, 0, 15}).distance, 0.0);

  TriangleMesh mixed = make_icosphere(20.0, 2);
  for (const int t : {5, 6, 100}) std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  const OrientResult repaired_mesh = orient_outwards(mixed);
  EXPECT_EQ(repaired_mesh.repaired_patches, 1);
  EXPECT_THAT(repaired_mesh.flipped_triangles, testing::ElementsAre(5, 6, 100));
}

TEST(OrientOutwards, KeepsACavity) {
  TriangleMesh mesh = make_icosphere(20.0, 3);
  const TriangleMesh hole = make_icosphere(10.0, 3);
  const int n = mesh.vertex_count();
  mesh.vertices.insert(mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const Triangle& t : hole.triangles) {
    mesh.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  }
  EXPECT_TRUE(orient_outwards(mesh).flipped_triangles.empty());
  const MeshDistance field(mesh);
  EXPECT_GT(field.at({0, 0, 5}).distance, 0.0);
  EXPECT_LT(field.at({0, 0, 15}).distance, 0.0);
}

TEST(OrientOutwards, SaysThatAMoebiusBandIsOneSided) {
  TriangleMesh band;
  const int n = 40;
  for (int i = 0; i < n; ++i) {
    const double u = 2.0 * std::numbers::pi * i / n;
    for (const double w : {-5.0, 5.0}) {
      const double r = 30.0 + w * std::cos(0.5 * u);
      band.vertices.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(0.5 * u));
    }
  }
  for (int i = 0; i < n; ++i) {
    // After one turn the two rims change places.
    const int a = 2 * i, b = 2 * i + 1;
    const int c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? b + 2 : 0;
    band.triangles.push_back({a, c, b});
    band.triangles.push_back({b, c, d});
  }
  EXPECT_EQ(orient_outwards(band).twisted_patches, 1);
}

}  // namespace
}  // namespace palmar::geometry
