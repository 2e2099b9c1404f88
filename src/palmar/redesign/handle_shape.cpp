// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/geometry/smooth_step.h"
#include "palmar/product/intake/make_product.h"

namespace palmar::redesign {
namespace {

using Point2 = Eigen::Vector2d;

constexpr int kFilletRows = 6;        // of the rounding of an end
constexpr double kDerivative = 1e-4;  // of a turn
constexpr double kBeside = 1.3;       // of the handle's radius; what is farther out isn't of it
constexpr double kOnSurface = 0.2;    // share of the radius; what is so near lies on the surface

double angle_of(const Point2& p) { return std::atan2(p.y(), p.x()); }

/// Of the circle through a corner of an outline and its neighbours, mm; infinite where it doesn't
/// bulge.
double bulge_radius(const std::vector<Point2>& outline, std::size_t corner) {
  const std::size_t n = outline.size();
  const Point2 &a = outline[(corner + n - 1) % n], &b = outline[corner],
               &c = outline[(corner + 1) % n];
  const Point2 u = b - a, v = c - b;
  const double turn = u.x() * v.y() - u.y() * v.x();
  return turn > 1e-9 ? u.norm() * v.norm() * (c - a).norm() / (2.0 * turn)
                     : std::numeric_limits<double>::infinity();
}

/// Between the directions of a grid; t goes round once from 0 to 1.
double direction_at(const std::vector<double>& directions, double t) {
  const std::size_t n = directions.size();
  const double way = (t - std::floor(t)) * static_cast<double>(n);
  const auto i = std::min(static_cast<std::size_t>(way), n - 1);
  const double next = i + 1 < n ? directions[i + 1] : kFullTurn;
  return directions[i] + (way - static_cast<double>(i)) * (next - directions[i]);
}

/// Parameter of the features' section in direction phi, by bisection: directions grow with it.
double parameter_at(const HandleShape& shape, double z, double phi) {
  const double turned = shape.features.turn + shape.features.twist * z / 100.0;
  double low = (phi - turned) / kFullTurn - 0.25, high = low + 0.5;
  for (int i = 0; i < 30; ++i) {
    const double t = 0.5 * (low + high);
    const double beyond = std::remainder(
        angle_of(section_point(shape.features, shape.body.hands, z, t)) - phi, kFullTurn);
    (beyond > 0.0 ? high : low) = t;
  }
  return 0.5 * (low + high);
}

/// Share of the features in the plane of z for what is kept at its ends.
double share_of_plane(const HandleShape& shape, double z) {
  const HandleBody& body = shape.body;
  double share = 1.0;
  if (body.is_whole) {
    for (const std::size_t end : {0, 1}) {
      if (shape.kept_ends[end] <= 0.0) continue;
      const double inwards = end == 0 ? z - body.bottom : body.top - z;
      share *= geometry::smooth_step((inwards - shape.kept_ends[end]) / kShapeBlend);
    }
    return share;
  }
  if (!body.is_free[0]) share *= geometry::smooth_step((z - body.bottom) / body.run_out);
  if (!body.is_free[1]) share *= geometry::smooth_step((body.top - z) / body.run_out);
  return share;
}

struct Row {
  double z, inset;
};
std::vector<Row> rows_of(const HandleShape& shape, double distance) {
  const double r = shape.end_radius, bottom = shape.body.bottom, top = shape.body.top;
  const double height = r * std::sin(kEndAngle);
  std::vector<Row> rows;
  const auto round = [&](int k) {
    const double angle = kEndAngle * (1.0 - static_cast<double>(k) / kFilletRows);
    return std::array{height - r * std::sin(angle), r * (1.0 - std::cos(angle))};
  };
  for (int k = 0; k < kFilletRows && r > 0.0; ++k) {
    rows.push_back({bottom + round(k)[0], round(k)[1]});
  }
  const double length = top - bottom - 2.0 * height;
  const int steps = std::max(2, static_cast<int>(std::ceil(length / distance)));
  for (int k = 0; k <= steps; ++k) rows.push_back({bottom + height + length * k / steps, 0.0});
  for (int k = kFilletRows - 1; k >= 0 && r > 0.0; --k) {
    rows.push_back({top - round(k)[0], round(k)[1]});
  }
  return rows;
}

}  // namespace

double HandleShape::radius_before(double z, double phi) const {
  const double margin = body.is_whole && body.end_radius > 0.0 ? body.end_radius + 0.5 : 0.0;
  return body.outlines.at(std::clamp(z, body.bottom + margin, body.top - margin), phi);
}

OutlineGrid outline_grid(const HandleOutlines& outlines, double distance) {
  const auto n = static_cast<std::size_t>(outlines.columns);
  std::vector<Point2> mean(n + 1, Point2::Zero());
  for (std::size_t i = 0; i <= n; ++i) {
    double sum = 0.0;
    for (const std::vector<double>& row : outlines.radius) sum += row[i % n];
    const double phi = kFullTurn * static_cast<double>(i) / outlines.columns;
    mean[i] =
        sum / static_cast<double>(outlines.radius.size()) * Point2(std::cos(phi), std::sin(phi));
  }
  std::vector<double> way = {0.0};
  for (std::size_t i = 0; i < n; ++i) way.push_back(way.back() + (mean[i + 1] - mean[i]).norm());
  const int count = 8 * std::max(3, static_cast<int>(std::ceil(way.back() / distance / 8.0)));
  OutlineGrid grid{.directions = {}, .distance = distance};
  std::size_t i = 0;
  for (int k = 0; k < count; ++k) {
    const double at = way.back() * k / count;
    while (i + 1 < n && way[i + 1] <= at) ++i;
    const double within = (at - way[i]) / (way[i + 1] - way[i]);
    grid.directions.push_back(kFullTurn * (static_cast<double>(i) + within) / outlines.columns);
  }
  return grid;
}

bool HandleShape::keeps() const {
  return follows || !body.is_whole || kept_ends[0] > 0.0 || kept_ends[1] > 0.0 ||
         !kept_boxes.empty() || !to_kept_faces.z.empty();
}

HandleRows rows_for(const HandleShape& shape) {
  if (shape.follows) {
    return {.columns = static_cast<int>(shape.follows->directions.size()),
            .distance = shape.follows->distance,
            .end_radius = shape.body.is_whole ? shape.end_radius : 0.0};
  }
  constexpr int kRoundColumns = 24;   // through which an elliptic section passes within 0.01 mm
  constexpr int kSquareColumns = 24;  // more per unit of squareness
  constexpr int kKeptColumns = 72;    // where the original's outlines are kept
  constexpr double kRows = 7.0, kFineRows = 3.5;  // mm; these for what is finer than swells
  const double wanted = kRoundColumns + kSquareColumns * shape.features.squareness;
  const bool is_whole = shape.body.is_whole;
  return {.columns = shape.keeps() ? kKeptColumns : 8 * static_cast<int>(std::ceil(wanted / 8.0)),
          .distance = (shape.keeps() && is_whole) || shape.features.finger_grooves > 0.0 ? kFineRows
                                                                                         : kRows,
          .end_radius = is_whole ? shape.end_radius : 0.0};
}

double HandleShape::share_at(double z, double phi) const {
  if (follows) return 0.0;
  double share = share_of_plane(*this, z);
  if (share > 0.0 && !to_kept_faces.z.empty()) {
    share *= geometry::smooth_step(to_kept_faces.at(z, phi) / kShapeBlend);
  }
  if (share == 0.0 || kept_boxes.empty()) return share;
  const Point2 at =
      body.centre_at(z) + radius_before(z, phi) * Point2(std::cos(phi), std::sin(phi));
  const Vec3 point = body.product_from_handle * Vec3(at.x(), at.y(), z);
  for (const Box3& box : kept_boxes) {
    share *= geometry::smooth_step(box.exteriorDistance(point) / kShapeBlend);
  }
  return share;
}

Point2 HandleShape::side_point(double z, double t) const {
  const Point2 centre = body.centre_at(z);
  if (follows) {
    const double phi = direction_at(follows->directions, t);
    return centre + radius_before(z, phi) * Point2(std::cos(phi), std::sin(phi));
  }
  Point2 point = section_point(features, body.hands, z, t);
  const double phi = angle_of(point), share = share_at(z, phi);
  if (share < 1.0) {
    const double r = point.norm();
    point *= (share * r + (1.0 - share) * radius_before(z, phi)) / r;
  }
  return centre + point;
}

double HandleShape::radius_at(double z, double phi) const {
  const double share = share_at(z, phi);
  const double before = share < 1.0 ? radius_before(z, phi) : 0.0;
  if (share == 0.0) return before;
  const double r = section_point(features, body.hands, z, parameter_at(*this, z, phi)).norm();
  return share * r + (1.0 - share) * before;
}

double tightest_at_ends(const HandleShape& shape) {
  const HandleBody& body = shape.body;
  const int columns = rows_for(shape).columns;
  double tightest = std::numeric_limits<double>::infinity();
  for (const double z : {body.bottom, body.top}) {
    std::vector<Point2> outline;
    for (int k = 0; k < columns; ++k) {
      outline.push_back(shape.side_point(z, static_cast<double>(k) / columns));
    }
    for (std::size_t k = 0; k < outline.size(); ++k) {
      tightest = std::min(tightest, bulge_radius(outline, k));
    }
  }
  return tightest;
}

ShapeChange shape_change(const HandleShape& shape) {
  const HandleBody& body = shape.body;
  constexpr int kDirections = 120;
  ShapeChange change;
  double before = 0.0, after = 0.0;
  change.smallest_radius = std::numeric_limits<double>::infinity();
  const double margin = body.is_whole ? std::max(shape.end_radius, body.end_radius) + 0.5 : 0.0;
  for (double z = body.bottom + margin; z <= body.top - margin; z += 2.0) {
    const Point2 centre = body.centre_at(z);
    std::vector<Point2> outline;
    for (int k = 0; k < kDirections; ++k) {
      outline.push_back(shape.side_point(z, static_cast<double>(k) / kDirections) - centre);
      const Point2& at = outline.back();
      change.largest =
          std::max(change.largest, std::abs(at.norm() - body.outlines.at(z, angle_of(at))));
      const double was = body.outlines.at(z, kFullTurn * k / kDirections);
      before += was * was * kFullTurn / kDirections;
    }
    for (std::size_t k = 0; k < outline.size(); ++k) {
      const Point2 &a = outline[k], &b = outline[(k + 1) % outline.size()];
      after += a.x() * b.y() - a.y() * b.x();
    }
    if (share_of_plane(shape, z) < 1.0) continue;
    for (int k = 0; k < kDirections; ++k) {
      const Point2& at = outline[static_cast<std::size_t>(k)];
      if (shape.share_at(z, angle_of(at)) < 1.0) continue;
      change.smallest_radius =
          std::min(change.smallest_radius, bulge_radius(outline, static_cast<std::size_t>(k)));
    }
  }
  if (before > 0.0) change.volume_ratio = after / before;
  return change;
}

geometry::TriangleMesh handle_mesh(const HandleShape& shape, double edge_length) {
  const std::vector<Row> rows = rows_of(shape, edge_length);
  const double girth = std::numbers::pi * 0.5 * (shape.features.width + shape.features.depth);
  const int columns = std::max(24, static_cast<int>(std::ceil(girth / edge_length)));
  geometry::TriangleMesh mesh;
  const geometry::Rigid3& from_handle = shape.body.product_from_handle;
  for (const Row& row : rows) {
    for (int i = 0; i < columns; ++i) {
      const double t = static_cast<double>(i) / columns;
      Point2 point = shape.side_point(row.z, t);
      if (row.inset > 0.0) {
        const Point2 along =
            (shape.side_point(row.z, t + kDerivative) - shape.side_point(row.z, t - kDerivative))
                .normalized();
        point += row.inset * Point2(-along.y(), along.x());
      }
      mesh.vertices.push_back(from_handle * Vec3(point.x(), point.y(), row.z));
    }
  }
  const auto last = static_cast<int>(rows.size()) - 1;
  for (int j = 0; j < last; ++j) {
    for (int i = 0; i < columns; ++i) {
      const int a = j * columns + i, b = j * columns + (i + 1) % columns;
      mesh.triangles.push_back({a, b, b + columns});
      mesh.triangles.push_back({a, b + columns, a + columns});
    }
  }
  for (const int j : {0, last}) {
    const Point2 centre = shape.body.centre_at(rows[static_cast<std::size_t>(j)].z);
    const int middle = mesh.vertex_count();
    mesh.vertices.push_back(from_handle *
                            Vec3(centre.x(), centre.y(), rows[static_cast<std::size_t>(j)].z));
    for (int i = 0; i < columns; ++i) {
      const int a = j * columns + i, b = j * columns + (i + 1) % columns;
      mesh.triangles.push_back(j == 0 ? Triangle{middle, b, a} : Triangle{middle, a, b});
    }
  }
  return mesh;
}

geometry::TriangleMesh moved_mesh(const geometry::TriangleMesh& mesh, const HandleShape& shape,
                                  double edge_length) {
  const HandleBody& body = shape.body;
  const geometry::Rigid3 to_handle = body.product_from_handle.inverse();
  // Height on the centre line, radius and direction of a point beside the handle; nothing if it
  // isn't of it.
  struct Place {
    double z = 0.0, r = 0.0, phi = 0.0, before = 0.0;
    bool is_moved = false, is_beyond = false;
  };
  const auto place_of = [&](const Vec3& x) {
    const Vec3 p = to_handle * x;
    Place place;
    const bool is_below = p.z()<body.bottom, is_above = p.z()> body.top;
    if ((is_below && !body.is_free[0]) || (is_above && !body.is_free[1])) return place;
    place.is_beyond = is_below || is_above;
    place.z = std::clamp(p.z(), body.bottom, body.top);
    const Point2 from_centre = p.head<2>() - body.centre_at(place.z);
    place.r = from_centre.norm();
    place.phi = angle_of(from_centre);
    place.before = body.outlines.at(place.z, place.phi);
    place.is_moved = place.r > 1e-6 && place.r < kBeside * place.before;
    return place;
  };
  // A triangle of CAD may go from end to end of a handle whose vertices all lie beyond what moves.
  const auto is_beside = [&](const Vec3& x) {
    const Vec3 p = to_handle * x;
    const double z = std::clamp(p.z(), body.bottom, body.top);
    const Point2 from_centre = p.head<2>() - body.centre_at(z);
    return from_centre.norm() < kBeside * body.outlines.at(z, angle_of(from_centre));
  };
  geometry::TriangleMesh moved = geometry::split_long_edges(
      mesh, edge_length, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const double za = (to_handle * a).z(), zb = (to_handle * b).z(), zc = (to_handle * c).z();
        const bool is_below = std::max({za, zb, zc}) < body.bottom && !body.is_free[0];
        const bool is_above = std::min({za, zb, zc}) > body.top && !body.is_free[1];
        return !is_below && !is_above && (is_beside(a) || is_beside(b) || is_beside(c));
      });
  for (Vec3& x : moved.vertices) {
    const Place place = place_of(x);
    if (!place.is_moved) continue;
    const double after = shape.radius_at(place.z, place.phi);
    // What lies beyond the outline does so because that was taken coarsely: scaled, it would become
    // a spike.
    const bool is_on = !place.is_beyond && place.r > (1.0 - kOnSurface) * place.before;
    // Where the shape has run out nothing moves, not even by how coarsely outlines were taken.
    const double share = shape.share_at(place.z, place.phi);
    const double scaled = place.r * after / place.before;
    const double onto = share * (is_on ? after : scaled) + (1.0 - share) * scaled;
    const Vec3 p = to_handle * x;
    const Point2 centre = body.centre_at(place.z);
    const Point2 at = centre + (p.head<2>() - centre) * (onto / place.r);
    x = body.product_from_handle * Vec3(at.x(), at.y(), p.z());
  }
  return moved;
}

product::Product shaped_product(const product::Product& original, const HandleShape& shape,
                                const std::string& name) {
  const geometry::TriangleMesh mesh =
      shape.body.is_whole ? handle_mesh(shape) : moved_mesh(original.mesh, shape);
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  return product::make_product(name, mesh, unit, original.source);
}

}  // namespace palmar::redesign
