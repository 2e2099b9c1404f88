// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/footprint/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/remesh/split_edges.h"

namespace palmar::contact {
namespace {

constexpr double kReach = 1.0;   // mm; the skin's facets stand off a curved product by less
constexpr double kBridge = 5.0;  // mm; how deep under an edge a facet of skin goes straight through
constexpr double kOpposing = 0.3;  // cosine; skin and product normals must not agree by more

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
      if (box.contains(*p) && geometry::closest_point_on_triangle(*p, a, b, c).squared_distance <=
                                  distance * distance) {
        return true;
      }
    }
    return false;
  }

 private:
  std::vector<Vec3> points_;
};

/// A vertex of the product's surface under the skin: which triangle of skin lies on it, and where.
struct Landing {
  std::size_t vertex = 0;
  Triangle skin{};
  std::array<double, 3> weights{};
};

/// A third of the area of every triangle, for each of its corners, mm^2: by it a pressure that is
/// linear over triangles is integrated.
std::vector<double> areas_of_corners(const geometry::TriangleMesh& mesh) {
  std::vector<double> area(mesh.vertices.size(), 0.0);
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.vertices[t[0]];
    const double part = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a).norm() / 6.0;
    for (const int v : t) area[v] += part;
  }
  return area;
}

/// Pressure per vertex of skin, MPa: less than the skin's where it lands on more of the product
/// than the area that its own pressure counts by, as facets do that cut through an edge. Never
/// more: skin that lands on less lies over other skin, or beside a hollow.
std::vector<double> pressure_on_landings(const geometry::TriangleMesh& skin,
                                         const ContactResult& contact,
                                         const std::vector<Landing>& landings,
                                         const std::vector<double>& surface_area) {
  std::vector<double> landed(contact.force.size(), 0.0);
  for (const Landing& one : landings) {
    for (int k = 0; k < 3; ++k) landed[one.skin[k]] += one.weights[k] * surface_area[one.vertex];
  }
  // Of a vertex and its neighbours: alone it has too few landings to tell.
  std::vector<double> force_on_landed(landed.size(), 0.0), force(landed.size(), 0.0);
  for (const Triangle& t : skin.triangles) {
    double sum = 0.0, sum_landed = 0.0;
    for (const int v : t) {
      sum += contact.force[v];
      sum_landed += contact.pressure[v] * landed[v];
    }
    for (const int v : t) {
      force[v] += sum;
      force_on_landed[v] += sum_landed;
    }
  }
  std::vector<double> pressure = contact.pressure;
  for (std::size_t v = 0; v < pressure.size(); ++v) {
    if (!(pressure[v] > 0.0)) continue;
    pressure[v] *= force[v] / std::max(force_on_landed[v], force[v]);
  }
  return pressure;
}

}  // namespace

ProductFootprint map_to_product(const hand::Hand& hand, const ContactResult& contact,
                                const geometry::TriangleMesh& product, double edge_length) {
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
  geometry::SplitMesh split = geometry::split_with_parents(
      product, edge_length, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        return loaded.any_near(a, b, c, 2.0 * edge_length);
      });
  footprint.surface = std::move(split.mesh);
  footprint.parent = std::move(split.parent);
  const geometry::TriangleMesh& surface = footprint.surface;

  geometry::TriangleMesh skin{contact.deformed, {}};
  Box3 box;
  for (const Triangle& t : hand.skin.triangles) {
    if (std::none_of(t.begin(), t.end(), [&](int v) { return contact.force[v] > 0.0; })) continue;
    skin.triangles.push_back(t);
    for (const int v : t) box.extend(contact.deformed[v]);
  }
  box.min().array() -= kBridge;
  box.max().array() += kBridge;
  const geometry::ClosestPointQuery query(skin);
  const std::vector<Vec3> normals =
      geometry::area_weighted_normals(surface.vertices, surface.triangles);
  std::vector<Landing> landings;
  for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
    if (!box.contains(surface.vertices[i])) continue;
    const auto found = query.closest(surface.vertices[i], kBridge);
    if (!found) continue;
    const Triangle& t = skin.triangles[found->triangle];
    const Vec3 n = (skin.vertices[t[1]] - skin.vertices[t[0]])
                       .cross(skin.vertices[t[2]] - skin.vertices[t[0]])
                       .normalized();
    // Not through a thin wall: the skin must face this side.
    if (n.dot(normals[i]) > kOpposing) continue;
    // Skin that stands off the product carries nothing; a facet between two sides of an edge goes
    // through the product, and the edge lies before it.
    const Vec3 off = surface.vertices[i] - found->point;
    if (off.norm() > kReach && off.dot(n) > -0.7 * off.norm()) continue;
    landings.push_back({i, t, found->weights});
  }
  const std::vector<double> pressure =
      pressure_on_landings(skin, contact, landings, areas_of_corners(surface));
  footprint.pressure.assign(surface.vertices.size(), 0.0);
  for (const Landing& one : landings) {
    for (int k = 0; k < 3; ++k) {
      footprint.pressure[one.vertex] += one.weights[k] * pressure[one.skin[k]];
    }
  }
  return footprint;
}

}  // namespace palmar::contact
