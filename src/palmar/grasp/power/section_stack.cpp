// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/section_stack.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "palmar/geometry/convex_hull.h"

namespace palmar::grasp {
namespace {

constexpr double kSmallestGirth = 3.0;  // mm; shorter outlines are scan noise

using Point2 = Eigen::Vector2d;

// One triangle's share of a section, directed so that the solid lies on its left.
struct Cut {
  std::uint64_t from = 0;  // mesh edge at which it starts
  std::uint64_t to = 0;
  Point2 start;
};

std::uint64_t edge_key(int a, int b) {
  const auto low = static_cast<std::uint64_t>(std::min(a, b));
  const auto high = static_cast<std::uint64_t>(std::max(a, b));
  return (high << 32U) | low;
}

// Right-handed frame of the section plane.
struct Plane {
  Vec3 u, v, axis;
  Point2 project(const Vec3& p) const { return {u.dot(p), v.dot(p)}; }
  Vec3 lift(const Point2& p, double station) const {
    return p.x() * u + p.y() * v + station * axis;
  }
};

Plane plane_across(const Vec3& axis) {
  const Vec3 u = axis.unitOrthogonal();
  return {u, axis.cross(u), axis};
}

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

std::optional<SectionOutline> outline_of(const std::vector<Point2>& loop, double station,
                                         const Plane& plane) {
  double twice_area = 0.0;
  Point2 moment = Point2::Zero();
  const Point2& base = loop.front();
  for (std::size_t i = 0; i + 1 < loop.size(); ++i) {
    const Point2 a = loop[i] - base;
    const Point2 b = loop[i + 1] - base;
    const double c = cross(a, b);
    twice_area += c;
    moment += c * (a + b) / 3.0;
  }
  if (twice_area <= 0.0) return {};
  const std::vector<Point2> hull = geometry::convex_hull(loop);
  if (hull.size() < 3) return {};
  SectionOutline outline;
  outline.area = 0.5 * twice_area;
  outline.centroid = plane.lift(base + moment / twice_area, station);
  outline.thickness = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point2 edge = hull[(i + 1) % hull.size()] - hull[i];
    const double length = edge.norm();
    outline.girth += length;
    if (length == 0.0) continue;
    const Point2 along = edge / length;
    double across = 0.0, low = 0.0, high = 0.0;
    for (const Point2& p : hull) {
      across = std::max(across, cross(along, p - hull[i]));
      low = std::min(low, along.dot(p - hull[i]));
      high = std::max(high, along.dot(p - hull[i]));
    }
    if (across < outline.thickness) {
      outline.thickness = across;
      outline.width = high - low;
      outline.wide = along.x() * plane.u + along.y() * plane.v;
    }
  }
  if (outline.girth < kSmallestGirth) return {};
  return outline;
}

// Follows the cuts from edge to edge. A start edge that two cuts share (non-manifold) is served in
// order of the triangles.
std::vector<SectionOutline> outlines_of(std::vector<Cut>& cuts, double station,
                                        const Plane& plane) {
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const Cut& a, const Cut& b) { return a.from < b.from; });
  std::vector<char> used(cuts.size(), 0);
  std::vector<SectionOutline> outlines;
  std::vector<Point2> loop;
  for (std::size_t first = 0; first < cuts.size(); ++first) {
    if (used[first] != 0) continue;
    loop.clear();
    std::size_t current = first;
    while (true) {
      used[current] = 1;
      loop.push_back(cuts[current].start);
      auto next = std::lower_bound(cuts.begin(), cuts.end(), cuts[current].to,
                                   [](const Cut& c, std::uint64_t key) { return c.from < key; });
      while (next != cuts.end() && next->from == cuts[current].to &&
             used[next - cuts.begin()] != 0) {
        ++next;
      }
      if (next == cuts.end() || next->from != cuts[current].to) break;
      current = static_cast<std::size_t>(next - cuts.begin());
    }
    if (loop.size() < 3) continue;
    loop.push_back(loop.front());
    if (auto outline = outline_of(loop, station, plane)) outlines.push_back(*outline);
  }
  return outlines;
}

}  // namespace

std::vector<Section> sections_along(const geometry::TriangleMesh& mesh, const Vec3& axis,
                                    double spacing) {
  if (mesh.vertices.empty() || mesh.triangles.empty()) return {};
  const Plane plane = plane_across(axis);
  std::vector<double> height(mesh.vertices.size());
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t i = 0; i < height.size(); ++i) {
    height[i] = axis.dot(mesh.vertices[i]);
    low = std::min(low, height[i]);
    high = std::max(high, height[i]);
  }
  const int count = static_cast<int>(std::floor((high - low) / spacing + 0.5));
  if (count <= 0) return {};
  const double first = 0.5 * (low + high) - 0.5 * (count - 1) * spacing;
  std::vector<std::vector<Cut>> cuts(count);
  for (const Triangle& triangle : mesh.triangles) {
    std::array<double, 3> h{};
    for (std::size_t c = 0; c < 3; ++c) h[c] = height[triangle[c]];
    const double lowest = std::min({h[0], h[1], h[2]});
    const double highest = std::max({h[0], h[1], h[2]});
    const int begin = std::max(0, static_cast<int>(std::ceil((lowest - first) / spacing)));
    const int end = std::min(count - 1, static_cast<int>(std::floor((highest - first) / spacing)));
    for (int k = begin; k <= end; ++k) {
      const double station = first + k * spacing;
      // Going round the triangle counter-clockwise, the solid is on the left of the line from
      // where the border falls below the plane to where it rises above it, seen from the tip of
      // the axis: the border comes up on the left side of an outward facing triangle.
      std::optional<std::size_t> falls, rises;
      for (std::size_t c = 0; c < 3; ++c) {
        const bool above = h[c] >= station;
        const bool next_above = h[(c + 1) % 3] >= station;
        if (above && !next_above) falls = c;
        if (!above && next_above) rises = c;
      }
      if (!falls || !rises) continue;
      const auto point_on = [&](std::size_t c) {
        const int a = triangle[c];
        const int b = triangle[(c + 1) % 3];
        const double share = (station - h[c]) / (h[(c + 1) % 3] - h[c]);
        return plane.project((1.0 - share) * mesh.vertices[a] + share * mesh.vertices[b]);
      };
      cuts[k].push_back({edge_key(triangle[*falls], triangle[(*falls + 1) % 3]),
                         edge_key(triangle[*rises], triangle[(*rises + 1) % 3]), point_on(*falls)});
    }
  }
  std::vector<Section> sections(count);
  for (int k = 0; k < count; ++k) {
    Section& section = sections[k];
    section.station = first + k * spacing;
    section.outlines = outlines_of(cuts[k], section.station, plane);
  }
  return sections;
}

}  // namespace palmar::grasp
