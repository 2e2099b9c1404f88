// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/handle_body.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/section.h"
#include "palmar/product/parts/part_outline.h"
#include "palmar/redesign/handle_ends.h"

namespace palmar::redesign {
namespace {

using Point2 = Eigen::Vector2d;

constexpr int kColumns = 144;             // 2.5 degrees apart
constexpr double kSectionDistance = 2.0;  // mm, about
constexpr double kInside = 0.02;          // mm; of the first section from a flat end
constexpr double kFlatWithin = 0.05;      // mm; a plane's vertices lie within
constexpr double kParallel = 0.9998;      // cosine of 1 degree
constexpr double kLeanest = 0.75;         // cosine of 41 degrees, of a flat end against the axis
constexpr double kHidden = 0.1;           // share of directions in which an outline is met twice

/// The largest plane of a mesh that looks along `axis` and has all of the mesh behind it.
struct FlatEnd {
  Vec3 normal = Vec3::Zero();
  double offset = 0.0;  ///< along the normal
};
std::optional<FlatEnd> flat_end(const geometry::TriangleMesh& mesh, const Vec3& axis) {
  const std::vector<Vec3> normals = geometry::triangle_normals(mesh);
  struct Plane {
    FlatEnd end;
    double area = 0.0;
  };
  std::vector<Plane> planes;
  for (std::size_t t = 0; t < normals.size(); ++t) {
    if (normals[t].dot(axis) < kLeanest) continue;
    const Triangle& corner = mesh.triangles[t];
    const Vec3& at = mesh.vertices[static_cast<std::size_t>(corner[0])];
    const double area =
        geometry::triangle_area(at, mesh.vertices[static_cast<std::size_t>(corner[1])],
                                mesh.vertices[static_cast<std::size_t>(corner[2])]);
    const auto same = std::find_if(planes.begin(), planes.end(), [&](const Plane& one) {
      return one.end.normal.dot(normals[t]) > kParallel &&
             std::abs(one.end.normal.dot(at) - one.end.offset) < kFlatWithin;
    });
    if (same != planes.end()) {
      same->area += area;
      continue;
    }
    constexpr std::size_t kMostPlanes = 64;  // a round end has no flat one
    if (planes.size() < kMostPlanes) planes.push_back({{normals[t], normals[t].dot(at)}, area});
  }
  if (planes.empty()) return std::nullopt;
  const FlatEnd end = std::max_element(planes.begin(), planes.end(), [](auto& a, auto& b) {
                        return a.area < b.area;
                      })->end;
  for (const Vec3& x : mesh.vertices) {
    if (end.normal.dot(x) > end.offset + kFlatWithin) return std::nullopt;
  }
  return end;
}

Point2 centroid_of(const std::vector<Point2>& polygon) {
  double sum = 0.0;
  Point2 moment = Point2::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 a = polygon[i] - polygon[0], b = polygon[(i + 1) % polygon.size()] - polygon[0];
    const double c = a.x() * b.y() - a.y() * b.x();
    sum += c;
    moment += c * (a + b) / 3.0;
  }
  return sum == 0.0 ? polygon[0] : Point2(polygon[0] + moment / sum);
}

/// The outline in the plane of z that holds `near`, else the largest (none: empty), and what is
/// closed within it.
struct HandleCut {
  std::vector<Point2> outline;
  std::vector<std::vector<Point2>> hollows;
};
HandleCut cut_at(const geometry::TriangleMesh& mesh, const geometry::Rigid3& product_from_handle,
                 double z, const Point2& near) {
  const geometry::Rigid3 handle_from_product = product_from_handle.inverse();
  std::vector<std::vector<Point2>> polygons;
  std::size_t best = 0;
  double largest = 0.0;
  bool has_held = false;
  for (const geometry::SectionCurve& curve :
       geometry::plane_section(mesh, product_from_handle * Vec3(0, 0, z),
                               product_from_handle.rotation * Vec3::UnitZ())) {
    if (!curve.is_closed || curve.point.size() < 3) continue;
    std::vector<Point2> polygon;
    for (const Vec3& point : curve.point)
      polygon.push_back((handle_from_product * point).head<2>());
    const double area = std::abs(product::twice_area(polygon));
    const bool is_held = product::holds(polygon, near);
    polygons.push_back(std::move(polygon));
    if (is_held < has_held || (is_held == has_held && area <= largest)) continue;
    has_held = is_held;
    largest = area;
    best = polygons.size() - 1;
  }
  HandleCut cut;
  if (largest == 0.0) return cut;
  cut.outline = std::move(polygons[best]);
  for (std::size_t k = 0; k < polygons.size(); ++k) {
    if (k != best && product::holds(cut.outline, polygons[k].front())) {
      cut.hollows.push_back(std::move(polygons[k]));
    }
  }
  return cut;
}

/// Farthest crossing of the outline from a centre, by direction; counts directions in which there
/// are several.
std::vector<double> radii_of(const std::vector<Point2>& polygon, const Point2& centre,
                             int& crossed_often) {
  constexpr double kRounding = 1e-9;  // rad; a direction through a corner meets both of its edges
  constexpr double kApart = 0.3;      // mm; crossings nearer to each other are one
  std::vector<double> radius(kColumns, 0.0);
  std::vector<double> nearest(kColumns, std::numeric_limits<double>::infinity());
  const double step = kFullTurn / kColumns;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point2 a = polygon[i] - centre, b = polygon[(i + 1) % polygon.size()] - centre;
    const double from = std::atan2(a.y(), a.x());
    const double by = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
    const double low = std::min(from, from + by) - kRounding;
    const double high = std::max(from, from + by) + kRounding;
    for (int k = static_cast<int>(std::ceil(low / step)); k * step <= high; ++k) {
      const Point2 ray(std::cos(k * step), std::sin(k * step));
      const Point2 edge = b - a;
      const double across = ray.x() * edge.y() - ray.y() * edge.x();
      if (std::abs(across) < 1e-12) continue;
      const double way = (a.x() * edge.y() - a.y() * edge.x()) / across;
      const auto column = static_cast<std::size_t>(((k % kColumns) + kColumns) % kColumns);
      radius[column] = std::max(radius[column], way);
      nearest[column] = std::min(nearest[column], way);
    }
  }
  for (std::size_t k = 0; k < radius.size(); ++k) {
    crossed_often += radius[k] - nearest[k] > kApart ? 1 : 0;
  }
  return radius;
}

geometry::Rigid3 frame_along(const Vec3& origin, const Vec3& axis, const Vec3& palm) {
  const Vec3 across = palm - palm.dot(axis) * axis;
  Eigen::Matrix3d axes;
  axes.col(2) = axis;
  axes.col(1) = across.norm() > 1e-6 ? Vec3(across.normalized()) : axis.unitOrthogonal();
  axes.col(0) = axes.col(1).cross(axes.col(2));
  return {Quat(axes), origin};
}

/// Sections, their centres and radii. Throws UsageError if there are none, or hidden parts.
void take_sections(const product::Product& product, const product::ProductPart& part,
                   HandleBody& body) {
  const double inside = body.is_whole ? kInside : 0.0;
  const double bottom = body.bottom + inside, top = body.top - inside;
  const int steps = std::max(8, static_cast<int>(std::ceil((top - bottom) / kSectionDistance)));
  std::vector<HandleCut> cuts;
  const geometry::Rigid3 handle_from_product = body.product_from_handle.inverse();
  Eigen::MatrixXd powers(steps + 1, 3);
  Eigen::MatrixXd centres(steps + 1, 2);
  body.outlines.z.clear();
  body.outlines.radius.clear();
  body.hollow = {};
  for (int k = 0; k <= steps; ++k) {
    const double z = bottom + (top - bottom) * k / steps;
    // The part's own centre line where this plane meets it.
    Point2 near = Point2::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const product::PartStation& station : part.line) {
      const Vec3 at = handle_from_product * station.centre;
      if (std::abs(at.z() - z) >= least) continue;
      least = std::abs(at.z() - z);
      near = at.head<2>();
    }
    cuts.push_back(cut_at(product.mesh, body.product_from_handle, z, near));
    if (cuts.back().outline.empty()) {
      throw UsageError(
          fmt::format("{}: the {} has no closed section {:.0f} mm from the middle of "
                      "the hand; it can't be shaped anew",
                      product.name, part.name, z));
    }
    body.outlines.z.push_back(z);
    powers.row(k) << 1.0, z, z * z;
    centres.row(k) = centroid_of(cuts.back().outline).transpose();
  }
  const Eigen::MatrixXd line = powers.colPivHouseholderQr().solve(centres);
  for (int i = 0; i < 3; ++i) body.centre[static_cast<std::size_t>(i)] = line.row(i).transpose();
  body.outlines.columns = kColumns;
  int hidden = 0;
  for (int k = 0; k <= steps; ++k) {
    const double z = body.outlines.z[static_cast<std::size_t>(k)];
    body.outlines.radius.push_back(
        radii_of(cuts[static_cast<std::size_t>(k)].outline, body.centre_at(z), hidden));
    const auto& radius = body.outlines.radius.back();
    if (*std::min_element(radius.begin(), radius.end()) <= 0.0) {
      throw UsageError(fmt::format("{}: the {} is bent too much, or too hollow, to be shaped anew",
                                   product.name, part.name));
    }
  }
  const bool is_hollow = std::any_of(cuts.begin(), cuts.end(),
                                     [](const HandleCut& one) { return !one.hollows.empty(); });
  if (is_hollow) body.hollow = {body.outlines.z, kColumns, {}};
  for (std::size_t k = 0; is_hollow && k < cuts.size(); ++k) {
    std::vector<double>& radius = body.hollow.radius.emplace_back(kColumns, 0.0);
    for (const std::vector<Point2>& one : cuts[k].hollows) {
      int ignored = 0;
      const std::vector<double> way = radii_of(one, body.centre_at(body.hollow.z[k]), ignored);
      for (std::size_t i = 0; i < radius.size(); ++i) radius[i] = std::max(radius[i], way[i]);
    }
  }
  if (hidden > kHidden * kColumns * (steps + 1)) {
    throw UsageError(fmt::format(
        "{}: the {} has hollows that can't be seen from its centre line; it can't be shaped anew",
        product.name, part.name));
  }
}

/// Takes what isn't the handle from a part's body.
void leave_other_ends(const product::Product& product, const product::ProductPart& part,
                      HandleBody& body) {
  const std::array<double, 2> other = other_ends(body), kept = kept_lengths(body);
  body.bottom += kept[0];
  body.top -= kept[1];
  for (const std::size_t end : {0, 1}) body.is_free[end] = body.is_free[end] && other[end] == 0.0;
  if (kept[0] > 0.0 || kept[1] > 0.0) take_sections(product, part, body);
}

/// Radius of the rounding of the edges at flat ends, the larger of the two, by how much the section
/// next to the end is smaller than those 8 and 16 mm inside, continued straight.
double end_radius_of(const HandleBody& body) {
  constexpr double kWithin = 8.0, kSharp = 0.3;  // mm
  double largest = 0.0;
  for (const double end : {body.bottom, body.top}) {
    const double inwards = end == body.bottom ? 1.0 : -1.0;
    double inset = 0.0;
    for (int k = 0; k < kColumns; ++k) {
      const double phi = kFullTurn * k / kColumns;
      const double continued = 2.0 * body.outlines.at(end + inwards * kWithin, phi) -
                               body.outlines.at(end + inwards * 2.0 * kWithin, phi);
      inset += (continued - body.outlines.at(end + inwards * kInside, phi)) / kColumns;
    }
    if (inset < kSharp) continue;
    // inset = r - sqrt(2 r e - e^2), e the distance of that section from the end.
    double r = inset;
    for (int i = 0; i < 50; ++i) r = inset + std::sqrt(2.0 * r * kInside - kInside * kInside);
    largest = std::max(largest, r);
  }
  return largest;
}

}  // namespace

double HandleOutlines::at(double height, double phi) const {
  const auto rows = static_cast<int>(z.size());
  const double way =
      std::clamp((height - z.front()) / (z.back() - z.front()) * (rows - 1), 0.0, rows - 1.0);
  const int j = std::min(static_cast<int>(way), rows - 2);
  double column = phi / kFullTurn * columns;
  column -= std::floor(column / columns) * columns;
  const int i = std::min(static_cast<int>(column), columns - 1);
  const auto next = static_cast<std::size_t>((i + 1) % columns);
  const auto here = static_cast<std::size_t>(i);
  const auto& low = radius[static_cast<std::size_t>(j)];
  const auto& high = radius[static_cast<std::size_t>(j) + 1];
  const double u = column - i, v = way - j;
  return (1.0 - v) * ((1.0 - u) * low[here] + u * low[next]) +
         v * ((1.0 - u) * high[here] + u * high[next]);
}

Point2 HandleBody::centre_at(double z) const { return centre[0] + z * (centre[1] + z * centre[2]); }

HandleBody measure_handle(const product::Product& product, const product::ProductPart& part,
                          const HandsOnHandle& hands, const MeasureHandleOptions& options) {
  if (part.is_ring || part.line.size() < 2 ||
      (part.kind != product::PartKind::kBar && part.kind != product::PartKind::kPen &&
       part.kind != product::PartKind::kBody)) {
    throw UsageError(fmt::format("{}: is held by its {}; a bar or a body can be shaped anew",
                                 product.name, part.name));
  }
  const Vec3 chord = part.line.back().centre - part.line.front().centre;
  Vec3 axis = chord.normalized();
  const bool is_forward = axis.dot(hands.thumb_side) >= 0.0;
  if (!is_forward) axis = -axis;

  HandleBody body;
  body.hands.breadth = hands.breadth;
  const std::optional<FlatEnd> top = flat_end(product.mesh, axis);
  const std::optional<FlatEnd> bottom = flat_end(product.mesh, -axis);
  if (top && bottom && top->normal.dot(bottom->normal) < -kParallel) {
    constexpr double kMost = 0.6;  // of the product's length; the part is all of it
    const double length = top->offset + bottom->offset;
    if (part.length > kMost * length) {
      body.is_whole = true;
      axis = top->normal;
      body.top = top->offset - axis.dot(hands.place);
      body.bottom = -bottom->offset - axis.dot(hands.place);
    }
  }
  body.product_from_handle = frame_along(hands.place, axis, hands.palm);
  if (!body.is_whole) {
    body.run_out = kShapeBlend;
    const product::PartEnd& low = part.ends[is_forward ? 0 : 1];
    const product::PartEnd& high = part.ends[is_forward ? 1 : 0];
    body.is_free = {!low.joined, !high.joined};
    // Free ends are round: they keep their form, as wide as the section before them.
    constexpr double kRound = 0.35, kJoint = 2.0;  // of the thickness; mm
    const Vec3 &first = part.line.front().centre, &last = part.line.back().centre;
    body.bottom = axis.dot((is_forward ? first : last) - hands.place) +
                  (low.joined ? kJoint : kRound * part.thickness);
    body.top = axis.dot((is_forward ? last : first) - hands.place) -
               (high.joined ? kJoint : kRound * part.thickness);
  }
  if (body.top - body.bottom < part.thickness) {
    throw UsageError(
        fmt::format("{}: the {} is too short to be shaped anew", product.name, part.name));
  }
  take_sections(product, part, body);
  if (body.is_whole) body.end_radius = end_radius_of(body);
  body.gripped = gripped_length(body, hands);
  // Of a solid the ends stay as they are: rest and handle meet in the outlines that were there.
  if (!body.is_whole && product.faces != nullptr) body.is_free = {false, false};
  if (!body.is_whole && !options.takes_all) leave_other_ends(product, part, body);
  if (options.smooths_scans && !body.is_whole && product.faces == nullptr)
    body.outlines = smoothed(body.outlines);
  const Vec3 thumb = body.product_from_handle.inverse() * hands.thumb;
  body.hands.thumb_at = thumb.z();
  const Point2 from_centre = thumb.head<2>() - body.centre_at(thumb.z());
  body.hands.thumb_phi = std::atan2(from_centre.y(), from_centre.x());
  return body;
}

}  // namespace palmar::redesign
