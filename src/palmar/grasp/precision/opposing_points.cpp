// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/opposing_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "palmar/geometry/degrees.h"
#include "palmar/geometry/distance/ray_query.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/grasp/power/grip_axis.h"
#include "palmar/grasp/precision/cost_order.h"

namespace palmar::grasp {
namespace {

constexpr double kCone = 35.0 * geometry::kDegree;  // normals against the line through both points
constexpr double kEdge = 25.0 * geometry::kDegree;  // mean normal against the triangle's
constexpr double kFingerRoom = 7.0;      // mm off the surface that has to be free for a finger
constexpr double kThinnest = 0.2;        // mm
constexpr double kAway = 50.0;           // mm; unit of the cost of being off centre
constexpr double kAwayFromPlace = 20.0;  // mm; the same where a place is asked for
constexpr double kNearPlace = 40.0;      // mm from that where points are looked for
constexpr double kAngleUnit = 20.0 * geometry::kDegree;  // of the cost of slanting normals
constexpr double kWidthUnit = 20.0;                      // mm
constexpr double kPenSlenderness = 4.5;                  // length over breadth
constexpr double kPenBreadth = 32.0;                     // mm; thicker bars are no pens
constexpr double kPenLength = 80.0;                      // mm
constexpr double kPenGrip = 35.0;                        // mm behind the tip ...
constexpr double kPenShare = 0.28;     // ... or this share of the length if that is less
constexpr double kAlike = 0.92;        // ends whose girths differ less look alike
constexpr double kEqualSpread = 0.02;  // relative; axes of spreads that near are no axes
constexpr double kSkewed = 1e-6;       // of a third moment, relative; less has no sign
constexpr double kRound = 0.9;         // breadth over breadth of something round
constexpr double kRollStep = 2.0;      // mm; over which the surface's bend is looked at
constexpr double kRollWeight = 0.5;
constexpr double kMostRolling = 6.0;

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

/// The point r of a mesh, from `centre`, with the largest `size(r)`; the first of those.
template <class Size>
Vec3 largest(const geometry::TriangleMesh& mesh, const Vec3& centre, const Size& size) {
  Vec3 best = Vec3::Zero();
  double most = 0.0;
  for (const Vec3& v : mesh.vertices) {
    const double one = size(Vec3(v - centre));
    if (one <= most * (1.0 + 1e-6)) continue;
    most = one;
    best = v - centre;
  }
  return best;
}

/// Three directions that turn and mirror with a mesh, whatever its symmetry: to the farthest
/// vertex, to the one farthest off that line, to the one farthest off the plane of both.
std::array<Vec3, 3> landmarks(const geometry::TriangleMesh& mesh, const Vec3& centre) {
  std::array<Vec3, 3> result;
  result[0] = largest(mesh, centre, [](const Vec3& r) { return r.norm(); });
  const Vec3 line = result[0].normalized();
  const auto off_line = [&](const Vec3& r) -> Vec3 { return r - line * line.dot(r); };
  result[1] = off_line(largest(mesh, centre, [&](const Vec3& r) { return off_line(r).norm(); }));
  const Vec3 normal = line.cross(result[1]).normalized();
  const Vec3 out = largest(mesh, centre, [&](const Vec3& r) { return std::abs(normal.dot(r)); });
  result[2] = normal * normal.dot(out);
  return result;
}

/// PinchShape::axes.
Eigen::Matrix3d pinch_axes(const geometry::TriangleMesh& mesh, const Vec3& centre) {
  Eigen::Matrix3d axes = principal_frame(mesh).axes;
  const std::vector<double> area = geometry::vertex_areas(mesh);
  const std::array<Vec3, 3> marks = landmarks(mesh, centre);
  const auto moment = [&](const Vec3& axis, int power) {
    double sum = 0.0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      sum += area[v] * std::pow(axis.dot(mesh.vertices[v] - centre), power);
    }
    return sum;
  };
  const Vec3 spread(moment(axes.col(0), 2), moment(axes.col(1), 2), moment(axes.col(2), 2));
  const auto is_equal = [&](int a, int b) {
    return std::abs(spread[a] - spread[b]) < kEqualSpread * spread.maxCoeff();
  };
  const auto aim = [&](int first, int second) {
    // Within the plane of two axes: towards the farthest vertex.
    const Vec3 normal = axes.col(first).cross(axes.col(second));
    const Vec3 flat = marks[0] - normal * normal.dot(marks[0]);
    if (flat.norm() < 1e-3 * marks[0].norm()) return;
    axes.col(first) = flat.normalized();
    axes.col(second) = normal.cross(axes.col(first));
  };
  if (is_equal(0, 1) && is_equal(1, 2)) {
    for (int c = 0; c < 3; ++c) {
      if (marks[static_cast<std::size_t>(c)].norm() > 0.0) {
        axes.col(c) = marks[static_cast<std::size_t>(c)].normalized();
      }
    }
  } else if (is_equal(0, 1)) {
    aim(0, 1);
  } else if (is_equal(1, 2)) {
    aim(1, 2);
  }
  for (int c = 0; c < 3; ++c) {
    const Vec3 axis = axes.col(c);
    const double third = moment(axis, 3), size = std::pow(spread.maxCoeff(), 1.5);
    double sign = std::abs(third) > kSkewed * size ? third : 0.0;
    for (const Vec3& mark : marks) {
      if (sign == 0.0 && std::abs(axis.dot(mark)) > 1e-6 * mark.norm()) sign = axis.dot(mark);
    }
    if (sign < 0.0) axes.col(c) = -axis;
  }
  return axes;
}

/// Radius of the surface (the smaller one) about a point with its normal over half the width
/// between the fingers, inverse: 0 for a flat face, 1 for a ball.
double rolling(const product::Product& product, const Vec3& point, const Vec3& normal,
               const Vec3& towards, double width) {
  const Vec3 t = (towards - normal * normal.dot(towards)).normalized();  // never along the normal
  const Vec3 b = normal.cross(t);
  const Vec3 off = point + kPadOffset * normal;
  Eigen::Matrix2d bend;
  for (int c = 0; c < 2; ++c) {
    const Vec3 step = kRollStep * (c == 0 ? t : b);
    const Vec3 change =
        (product.distance->at(off + step).normal - product.distance->at(off - step).normal) /
        (2.0 * kRollStep);
    bend.col(c) = Eigen::Vector2d(t.dot(change), b.dot(change));
  }
  const double mean = 0.5 * bend.trace();
  const double half = 0.5 * (bend(0, 0) - bend(1, 1)), shear = 0.5 * (bend(0, 1) + bend(1, 0));
  const double most = mean + std::sqrt(half * half + shear * shear);
  if (most < 1e-6) return 0.0;
  const double radius = std::max(0.25, 1.0 / most - kPadOffset);
  return std::min(kMostRolling, 0.5 * width / radius);
}

}  // namespace

std::vector<SurfacePoint> spread_points(const geometry::TriangleMesh& mesh, int count) {
  const double spacing = std::sqrt(geometry::surface_area(mesh) / (0.7 * count));
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

PinchShape pinch_shape(const geometry::TriangleMesh& mesh) {
  PinchShape shape;
  shape.centre = geometry::centre_of_volume(mesh);
  shape.axes = pinch_axes(mesh, shape.centre);
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
  for (int c = 0; c < 3; ++c) {
    const double p = size[(c + 1) % 3], q = size[(c + 2) % 3];
    if (std::min(p, q) > kRound * std::max(p, q)) shape.disc_axes.push_back(shape.axes.col(c));
  }
  if (shape.disc_axes.empty()) shape.disc_axes.push_back(shape.axes.col(2));
  if (!shape.is_pen) return shape;
  // The writing end is the thinner one: mean distance of the skin from the axis over 15 mm.
  std::array<double, 2> girth = {0.0, 0.0};
  std::array<double, 2> weight = {0.0, 0.0};
  const std::vector<double> area = geometry::vertex_areas(mesh);
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

namespace {

// What of a mesh lies near a place: a knob on a board has few of the points that are spread over
// all of it. All if nothing is near.
geometry::TriangleMesh near_part(const geometry::TriangleMesh& mesh, const Vec3& place) {
  geometry::TriangleMesh part;
  part.vertices = mesh.vertices;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 middle = (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3.0;
    if ((middle - place).norm() < kNearPlace) part.triangles.push_back(t);
  }
  return part.triangles.empty() ? mesh : part;
}

}  // namespace

std::vector<OpposingPair> find_opposing_pairs(const product::Product& product,
                                              const PinchShape& shape,
                                              const OpposingOptions& options) {
  const std::vector<SurfacePoint> points = spread_points(
      options.at ? near_part(product.mesh, *options.at) : product.mesh, options.points);
  const double unit = options.at ? kAwayFromPlace : kAway;
  const geometry::RayQuery rays(product.mesh);
  const std::vector<Vec3> normals = geometry::triangle_normals(product.mesh);
  std::vector<Vec3> places = {shape.centre};
  if (options.at) {
    places = {*options.at};
  } else if (!options.places.empty()) {
    places = options.places;
  } else if (shape.is_pen) {
    places.clear();
    const double length = shape.upper.x() - shape.lower.x();
    for (const Vec3& tip : shape.tips) {
      const Vec3 back = (shape.centre - tip).normalized();
      places.push_back(tip + std::min(kPenGrip, kPenShare * length) * back);
    }
  }
  const auto pad_normal = [&](const Vec3& point, const Vec3& normal) -> std::optional<Vec3> {
    const geometry::DistanceSample off = product.distance->at(point + kPadOffset * normal);
    const geometry::DistanceSample room = product.distance->at(point + kFingerRoom * normal);
    if (room.distance < 0.5 * kFingerRoom || off.distance < 0.5 * kPadOffset) return std::nullopt;
    if (angle_between(room.normal, normal) > kEdge) return std::nullopt;
    return off.normal;
  };
  std::vector<OpposingPair> pairs;
  for (const SurfacePoint& start : points) {
    const std::optional<Vec3> normal = pad_normal(start.point, start.normal);
    if (!normal) continue;
    const std::vector<geometry::RayHit> hits = rays.all_hits(start.point, -*normal, kThinnest);
    std::vector<geometry::RayHit> exits;
    for (const geometry::RayHit& hit : hits) {
      if (normals[hit.triangle].dot(-*normal) <= 0.0) continue;
      if (hit.distance > options.widest) break;
      if (exits.size() < 2) exits.push_back(hit);
      exits.back() = hit;
    }
    for (const geometry::RayHit& exit : exits) {
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
      const Vec3 towards = shape.axes.col(std::abs(line.dot(shape.axes.col(0))) < 0.7 ? 0 : 1);
      const double roll = std::max(rolling(product, pair.a, pair.normal_a, towards, pair.width()),
                                   rolling(product, pair.b, pair.normal_b, towards, pair.width()));
      pair.cost = options.central * away * away / (unit * unit) + slant * slant + wide * wide +
                  kRollWeight * roll * roll;
      pairs.push_back(pair);
    }
  }
  sort_by_cost(pairs, kRoundedTie, [](const OpposingPair& pair) { return pair.cost; });
  if (static_cast<int>(pairs.size()) > options.most) {
    pairs.resize(options.most);
  }
  return pairs;
}

}  // namespace palmar::grasp
