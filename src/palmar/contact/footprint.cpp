// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/footprint.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/remesh/split_edges.h"

namespace palmar {
namespace {

constexpr double kReach = 1.0;   // mm; the skin's facets stand off a curved product by less
constexpr double kBridge = 5.0;  // mm; how deep under an edge a facet of skin goes straight through
constexpr double kFacing = 0.3;  // cosine; skin and product normals must not agree by more
constexpr double kMaxRatio = 2.0;  // of areas; skin folded into a crease has next to none left

/// Loaded points sorted along x, for finding those near a triangle.
class LoadedPoints {
 public:
  explicit LoadedPoints(const ContactResult& contact) {
    for (std::size_t v = 0; v < contact.force.size(); ++v) {
      if (contact.force[v] > 0.0) points_.push_back(contact.deformed[v]);
    }
    std::sort(points_.begin(), points_.end(), [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    });
  }
  bool empty() const { return points_.empty(); }

  bool any_near(const Vec3& a, const Vec3& b, const Vec3& c, double distance) const {
    Box3 box(a);
    box.extend(b);
    box.extend(c);
    box.min().array() -= distance;
    box.max().array() += distance;
    auto p = std::lower_bound(points_.begin(), points_.end(), box.min().x(),
                              [](const Vec3& q, double x) { return q.x() < x; });
    for (; p != points_.end() && p->x() <= box.max().x(); ++p) {
      if (box.contains(*p) &&
          closest_point_on_triangle(*p, a, b, c).squared_distance <= distance * distance) {
        return true;
      }
    }
    return false;
  }

 private:
  std::vector<Vec3> points_;
};

/// Pressure per area of the skin as it lies on the product, MPa. ContactResult counts per area of
/// the reference posture; bent and flattened skin covers more or less of the product than that.
std::vector<double> pressure_on_product(const Hand& hand, const ContactResult& contact) {
  std::vector<double> now(contact.force.size(), 0.0);
  std::vector<double> before(contact.force.size(), 0.0);
  for (const Triangle& t : hand.skin.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int v) { return contact.force[v] > 0.0; })) continue;
    const auto area = [&](const std::vector<Vec3>& at) {
      return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm();
    };
    const double area_now = area(contact.deformed);
    const double area_before = area(hand.skin.vertices);
    for (const int v : t) {
      now[v] += area_now;
      before[v] += area_before;
    }
  }
  std::vector<double> pressure = contact.pressure;
  for (std::size_t v = 0; v < pressure.size(); ++v) {
    if (contact.force[v] > 0.0) pressure[v] *= before[v] / std::max(now[v], before[v] / kMaxRatio);
  }
  return pressure;
}

}  // namespace

ProductFootprint map_to_product(const Hand& hand, const ContactResult& contact,
                                const TriangleMesh& product, double edge_length) {
  if (!(edge_length >= 0.1 && edge_length <= 1000.0)) {
    std::ostringstream message;
    message << "footprint: edge length is " << edge_length << " mm; 0.1 to 1000 mm is required";
    throw UsageError(message.str());
  }
  ProductFootprint footprint{product, std::vector<double>(product.vertices.size(), 0.0),
                             std::vector<int>(product.triangles.size())};
  std::iota(footprint.parent.begin(), footprint.parent.end(), 0);
  const LoadedPoints loaded(contact);
  if (loaded.empty()) return footprint;
  SplitMesh split =
      split_with_parents(product, edge_length, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        return loaded.any_near(a, b, c, 2.0 * edge_length);
      });
  footprint.surface = std::move(split.mesh);
  footprint.parent = std::move(split.parent);
  const TriangleMesh& surface = footprint.surface;

  TriangleMesh skin{contact.deformed, {}};
  Box3 box;
  for (const Triangle& t : hand.skin.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int v) { return contact.force[v] > 0.0; })) continue;
    skin.triangles.push_back(t);
    for (const int v : t) box.extend(contact.deformed[v]);
  }
  box.min().array() -= kBridge;
  box.max().array() += kBridge;
  const ClosestPointQuery query(skin);
  const std::vector<Vec3> normals = vertex_normals(surface.vertices, surface.triangles);
  const std::vector<double> pressure = pressure_on_product(hand, contact);
  footprint.pressure.assign(surface.vertices.size(), 0.0);
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (!box.contains(surface.vertices[i])) continue;
    const auto found = query.closest(surface.vertices[i], kBridge);
    if (!found) continue;
    const Triangle& t = skin.triangles[found->triangle];
    const Vec3 n = (skin.vertices[t[1]] - skin.vertices[t[0]])
                       .cross(skin.vertices[t[2]] - skin.vertices[t[0]])
                       .normalized();
    // Not through a thin wall: the skin must face this side.
    if (n.dot(normals[i]) > kFacing) continue;
    // Skin that stands off the product carries nothing; a facet between two sides of an edge goes
    // through the product, and the edge lies before it.
    const Vec3 off = surface.vertices[i] - found->point;
    if (off.norm() > kReach && off.dot(n) > -0.7 * off.norm()) continue;
    for (int k = 0; k < 3; ++k) footprint.pressure[i] += found->weights[k] * pressure[t[k]];
  }
  return footprint;
}

}  // namespace palmar
