// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parts/part_outline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "palmar/geometry/convex_hull.h"
#include "palmar/geometry/mesh/section.h"

namespace palmar::product {
namespace {

using Point2 = Eigen::Vector2d;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

Point2 centroid(const std::vector<Point2>& polygon) {
  const Point2 base = polygon.front();
  double sum = 0.0;
  Point2 moment = Point2::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 a = polygon[i] - base, b = polygon[(i + 1) % polygon.size()] - base;
    const double c = cross(a, b);
    sum += c;
    moment += c * (a + b) / 3.0;
  }
  return sum == 0.0 ? base : Point2(base + moment / sum);
}

}  // namespace

PlaneFrame::PlaneFrame(const Vec3& through, const Vec3& unit_normal)
    : centre(through),
      u(unit_normal.unitOrthogonal()),
      v(unit_normal.cross(u)),
      normal(unit_normal) {}

double twice_area(const std::vector<Point2>& polygon) {
  double sum = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += cross(polygon[i] - polygon[0], polygon[(i + 1) % polygon.size()] - polygon[0]);
  }
  return sum;
}

bool holds(const std::vector<Point2>& polygon, const Point2& point) {
  bool is_in = false;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    const double x = a.x() + (point.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
    if (x > point.x()) is_in = !is_in;
  }
  return is_in;
}

double distance_to(const std::vector<Point2>& polygon, const Point2& p) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 a = polygon[i], ab = polygon[(i + 1) % polygon.size()] - a;
    const double squared = ab.squaredNorm();
    const double t = squared > 0.0 ? std::clamp((p - a).dot(ab) / squared, 0.0, 1.0) : 0.0;
    least = std::min(least, (p - a - t * ab).norm());
  }
  return least;
}

std::optional<OutlineMeasures> measure_hull(const PlaneFrame& plane,
                                            const std::vector<Point2>& points) {
  const std::vector<Point2> hull = geometry::convex_hull(points);
  if (hull.size() < 3) return {};
  OutlineMeasures m;
  m.centre = plane.lift(centroid(hull));
  m.area = 0.5 * twice_area(hull);
  m.thickness = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 edge = hull[(i + 1) % hull.size()] - hull[i];
    const double length = edge.norm();
    m.girth += length;
    if (length == 0.0) continue;
    const Point2 along = edge / length;
    double across = 0.0, low = 0.0, high = 0.0;
    for (const Point2& p : hull) {
      across = std::max(across, cross(along, p - hull[i]));
      low = std::min(low, along.dot(p - hull[i]));
      high = std::max(high, along.dot(p - hull[i]));
    }
    if (across < m.thickness) {
      m.thickness = across;
      m.width = high - low;
      m.wide = along.x() * plane.u + along.y() * plane.v;
    }
  }
  return m;
}

std::optional<OutlineMeasures> outline_at(const geometry::TriangleMesh& mesh, const Vec3& point,
                                          const Vec3& axis, const OutlineReach& reach) {
  constexpr double kAlike = 4.0;  // areas; what is larger is what a handle stands beside
  const PlaneFrame plane(point, axis);
  struct Outline {
    std::vector<Point2> polygon;
    double area = 0.0;
  };
  std::vector<Outline> outlines;
  std::optional<std::size_t> chosen;
  double nearest = reach.reach;
  bool is_holding = false;
  for (const geometry::SectionCurve& curve : geometry::plane_section(mesh, point, axis)) {
    if (curve.point.size() < 3) continue;
    Outline outline;
    outline.polygon.reserve(curve.point.size());
    for (const Vec3& p : curve.point) outline.polygon.push_back(plane.project(p));
    outline.area = 0.5 * twice_area(outline.polygon);
    if (outline.area <= 0.0) continue;  // the inner wall of something hollow
    bool is_better = false;
    if (holds(outline.polygon, Point2::Zero())) {
      is_better = !is_holding || outline.area >= outlines[*chosen].area;
      is_holding = true;
    } else if (!is_holding) {
      const double d = distance_to(outline.polygon, Point2::Zero());
      is_better = d <= nearest;
      if (is_better) nearest = d;
    }
    outlines.push_back(std::move(outline));
    if (is_better) chosen = outlines.size() - 1;
  }
  if (!chosen) return {};
  const Outline& own = outlines[*chosen];
  std::vector<Point2> points = own.polygon;
  double area = own.area;
  Point2 moment = own.area * centroid(own.polygon);
  for (std::size_t k = 0; k < outlines.size() && reach.gap > 0.0; ++k) {
    const Outline& other = outlines[k];
    if (k == *chosen || other.area > kAlike * own.area) continue;
    double apart = std::numeric_limits<double>::infinity();
    for (const Point2& p : other.polygon) apart = std::min(apart, distance_to(own.polygon, p));
    if (apart > reach.gap) continue;
    points.insert(points.end(), other.polygon.begin(), other.polygon.end());
    area += other.area;
    moment += other.area * centroid(other.polygon);
  }
  auto m = measure_hull(plane, points);
  if (m) {
    m->centre = plane.lift(moment / area);
    m->area = area;
  }
  return m;
}

std::optional<OutlineMeasures> hull_at(const geometry::TriangleMesh& mesh, const Vec3& point,
                                       const Vec3& axis) {
  const PlaneFrame plane(point, axis);
  std::vector<Point2> points;
  for (const geometry::SectionCurve& curve : geometry::plane_section(mesh, point, axis)) {
    for (const Vec3& p : curve.point) points.push_back(plane.project(p));
  }
  return measure_hull(plane, points);
}

}  // namespace palmar::product
