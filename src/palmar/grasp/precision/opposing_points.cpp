// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/opposing_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/grip_axis.h"

namespace palmar {
namespace {

constexpr int kPoints = 300;
constexpr double kCone = 35.0 * kDegree;  // normals against the line through both points
constexpr double kEdge = 25.0 * kDegree;  // mean normal against the triangle's
constexpr double kPadOffset = 3.0;        // mm off the surface, where its distance is smooth
constexpr double kFingerRoom = 7.0;       // mm off the surface that has to be free for a finger
constexpr double kThinnest = 0.2;         // mm
constexpr double kAway = 50.0;            // mm; unit of the cost of being off centre
constexpr double kAngleUnit = 20.0 * kDegree;  // of the cost of slanting normals
constexpr double kWidthUnit = 20.0;            // mm
constexpr double kPenSlenderness = 4.5;        // length over breadth
constexpr double kPenBreadth = 32.0;           // mm; thicker bars are no pens
constexpr double kPenLength = 80.0;            // mm
constexpr double kPenGrip = 35.0;              // mm behind the tip ...
constexpr double kPenShare = 0.28;             // ... or this share of the length if that is less
constexpr double kAlike = 0.92;                // ends whose girths differ less look alike

void add_points(const std::array<Vec3, 3>& c, double longest, int depth, const Vec3& normal,
                std::vector<SurfacePoint>& points) {
  const double edge = std::max({(c[1] - c[0]).norm(), (c[2] - c[1]).norm(), (c[0] - c[2]).norm()});
  if (edge <= longest || depth == 0) {
    // Not quite the centre: rays from there would meet edges on the other side of regular meshes.
    points.push_back({0.37 * c[0] + 0.34 * c[1] + 0.29 * c[2], normal});
    return;
  }
  const Vec3 ab = 0.5 * (c[0] + c[1]), bc = 0.5 * (c[1] + c[2]), ca = 0.5 * (c[2] + c[0]);
  add_points({c[0], ab, ca}, longest, depth - 1, normal, points);
  add_points({c[1], bc, ab}, longest, depth - 1, normal, points);
  add_points({c[2], ca, bc}, longest, depth - 1, normal, points);
  add_points({ab, bc, ca}, longest, depth - 1, normal, points);
}

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

std::vector<SurfacePoint> spread_points(const TriangleMesh& mesh, int count) {
  const double spacing = std::sqrt(surface_area(mesh) / (0.7 * count));
  std::vector<SurfacePoint> all;
  for (Triangle t : mesh.triangles) {
    const auto at = [&](int v) -> const Vec3& { return mesh.vertices[v]; };
    const Vec3 normal = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
    if (normal.norm() < 1e-12) continue;
    // A mirrored mesh has its corners in another order.
    std::sort(t.begin(), t.end());
    add_points({at(t[0]), at(t[1]), at(t[2])}, 0.6 * spacing, 7, normal.normalized(), all);
  }
  std::vector<SurfacePoint> chosen;
  for (const SurfacePoint& one : all) {
    const bool is_free = std::none_of(chosen.begin(), chosen.end(), [&](const SurfacePoint& other) {
      return (other.point - one.point).squaredNorm() < spacing * spacing &&
             other.normal.dot(one.normal) > 0.5;
    });
    if (is_free) chosen.push_back(one);
  }
  return chosen;
}

PinchShape pinch_shape(const TriangleMesh& mesh) {
  PinchShape shape;
  shape.centre = centre_of_volume(mesh);
  shape.axes = principal_frame(mesh).axes;
  shape.lower.setConstant(1e9);
  shape.upper.setConstant(-1e9);
  for (const Vec3& v : mesh.vertices) {
    const Vec3 local = shape.axes.transpose() * (v - shape.centre);
    shape.lower = shape.lower.cwiseMin(local);
    shape.upper = shape.upper.cwiseMax(local);
  }
  const Vec3 size = shape.upper - shape.lower;
  const double breadth = std::max(size.y(), size.z());
  shape.is_pen =
      size.x() > kPenLength && breadth < kPenBreadth && size.x() > kPenSlenderness * breadth;
  if (!shape.is_pen) return shape;
  // The writing end is the thinner one: mean distance of the skin from the axis over 15 mm.
  std::array<double, 2> girth = {0.0, 0.0};
  std::array<double, 2> weight = {0.0, 0.0};
  const std::vector<double> area = vertex_areas(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3 local = shape.axes.transpose() * (mesh.vertices[v] - shape.centre);
    const double from_lower = local.x() - shape.lower.x(), from_upper = shape.upper.x() - local.x();
    const std::size_t end = from_lower < from_upper ? 0 : 1;
    if (std::min(from_lower, from_upper) > 15.0) continue;
    girth[end] += area[v] * local.tail<2>().norm();
    weight[end] += area[v];
  }
  for (std::size_t end = 0; end < 2; ++end) girth[end] /= std::max(weight[end], 1e-9);
  const bool is_alike = std::min(girth[0], girth[1]) > kAlike * std::max(girth[0], girth[1]);
  const Vec3 low = shape.centre + shape.axes.col(0) * shape.lower.x();
  const Vec3 high = shape.centre + shape.axes.col(0) * shape.upper.x();
  if (is_alike || girth[0] < girth[1]) shape.tips.push_back(low);
  if (is_alike || girth[1] < girth[0]) shape.tips.push_back(high);
  return shape;
}

std::vector<OpposingPair> find_opposing_pairs(const Product& product, const PinchShape& shape,
                                              const OpposingOptions& options) {
  const std::vector<SurfacePoint> points = spread_points(product.mesh, kPoints);
  const RayQuery rays(product.mesh);
  const std::vector<Vec3> normals = triangle_normals(product.mesh);
  std::vector<Vec3> places = {shape.centre};
  if (options.at) {
    places = {*options.at};
  } else if (shape.is_pen) {
    places.clear();
    const double length = shape.upper.x() - shape.lower.x();
    for (const Vec3& tip : shape.tips) {
      const Vec3 back = (shape.centre - tip).normalized();
      places.push_back(tip + std::min(kPenGrip, kPenShare * length) * back);
    }
  }
  const auto pad_normal = [&](const Vec3& point, const Vec3& normal) -> std::optional<Vec3> {
    const DistanceSample off = product.distance->at(point + kPadOffset * normal);
    const DistanceSample room = product.distance->at(point + kFingerRoom * normal);
    if (room.distance < 0.5 * kFingerRoom || off.distance < 0.5 * kPadOffset) return std::nullopt;
    if (angle_between(room.normal, normal) > kEdge) return std::nullopt;
    return off.normal;
  };
  std::vector<OpposingPair> pairs;
  for (const SurfacePoint& start : points) {
    const std::optional<Vec3> normal = pad_normal(start.point, start.normal);
    if (!normal) continue;
    const std::vector<RayHit> hits = rays.all_hits(start.point, -*normal, kThinnest);
    std::vector<RayHit> exits;
    for (const RayHit& hit : hits) {
      if (normals[hit.triangle].dot(-*normal) <= 0.0) continue;
      if (hit.distance > options.widest) break;
      if (exits.size() < 2) exits.push_back(hit);
      exits.back() = hit;
    }
    for (const RayHit& exit : exits) {
      OpposingPair pair;
      pair.a = start.point;
      pair.b = start.point - exit.distance * *normal;
      pair.normal_a = *normal;
      const std::optional<Vec3> behind = pad_normal(pair.b, normals[exit.triangle]);
      if (!behind) continue;
      pair.normal_b = *behind;
      const Vec3 line = (pair.a - pair.b).normalized();
      pair.angle =
          std::max(angle_between(pair.normal_a, line), angle_between(pair.normal_b, -line));
      if (pair.angle > kCone) continue;
      double away = 1e9;
      for (const Vec3& place : places) away = std::min(away, (pair.middle() - place).norm());
      const double wide = std::max(0.0, pair.width() - options.comfortable) / kWidthUnit;
      const double slant = pair.angle / kAngleUnit;
      pair.cost = options.central * away * away / (kAway * kAway) + slant * slant + wide * wide;
      pairs.push_back(pair);
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const OpposingPair& p, const OpposingPair& q) {
    // Rounded, so that a turned product with equal costs keeps its order.
    return std::llround(1e6 * p.cost) < std::llround(1e6 * q.cost);
  });
  if (static_cast<int>(pairs.size()) > options.most) {
    pairs.resize(options.most);
  }
  return pairs;
}

}  // namespace palmar
