// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/primitives.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "palmar/core/error.h"
#include "palmar/core/text.h"
#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/product/primitive_faces.h"

namespace palmar::product {
namespace {

constexpr int kMaxEdges = 400;  // per side: 400 x 400 squares are 320 000 triangles
constexpr int kMaxSubdivisions = 7;

void check_between(const char* object, const char* name, double value, double low, double high) {
  if (value >= low && value <= high) return;
  throw UsageError(std::string(object) + ": " + name + " is " + significant(value, 6) + " mm; " +
                   significant(low, 6) + " to " + significant(high, 6) + " mm is allowed");
}

void check_size(const char* object, const char* name, double value) {
  check_between(object, name, value, 0.1, 10000.0);
}

/// Segments of a full circle so that chords stay within the error and about the edge length.
int circle_segments(double radius, const MeshFineness& fineness) {
  const double share = std::min(1.0, fineness.chordal_error / radius);
  const double chord = std::numbers::pi / std::acos(1.0 - share);
  const double edge = 2.0 * std::numbers::pi * radius / fineness.longest_edge;
  // A multiple of 4, so that the four fillets of a prism share it.
  return 4 * static_cast<int>(std::ceil(std::clamp(std::max(chord, edge), 12.0, 720.0) / 4.0));
}

int divisions(double length, const MeshFineness& fineness) {
  return static_cast<int>(
      std::clamp(std::ceil(length / fineness.longest_edge), 1.0, double{kMaxEdges}));
}

/// Convex section (counter-clockwise, about the origin) swept along z over |z| <= length / 2. The
/// ends are rings that shrink towards the middle.
geometry::TriangleMesh sweep(std::span<const Eigen::Vector2d> section, double length, int rings,
                             int end_rings) {
  geometry::TriangleMesh mesh;
  const int n = static_cast<int>(section.size());
  const auto add_ring = [&](double scale, double z) {
    for (const Eigen::Vector2d& p : section) {
      mesh.vertices.emplace_back(scale * p.x(), scale * p.y(), z);
    }
  };
  const auto join = [&](int lower, int upper) {
    for (int i = 0; i < n; ++i) {
      const int j = (i + 1) % n;
      mesh.triangles.push_back({lower + i, lower + j, upper + j});
      mesh.triangles.push_back({lower + i, upper + j, upper + i});
    }
  };
  const double half = 0.5 * length;
  const auto ring_start = [n](int ring) { return 1 + ring * n; };
  mesh.vertices.emplace_back(0.0, 0.0, -half);
  int ring = 0;
  for (int k = 1; k < end_rings; ++k, ++ring) add_ring(static_cast<double>(k) / end_rings, -half);
  for (int k = 0; k <= rings; ++k, ++ring) add_ring(1.0, -half + length * k / rings);
  for (int k = end_rings - 1; k >= 1; --k, ++ring) {
    add_ring(static_cast<double>(k) / end_rings, half);
  }
  mesh.vertices.emplace_back(0.0, 0.0, half);
  const int top = mesh.vertex_count() - 1;
  for (int i = 0; i < n; ++i) mesh.triangles.push_back({0, 1 + (i + 1) % n, 1 + i});
  for (int k = 0; k + 1 < ring; ++k) join(ring_start(k), ring_start(k + 1));
  for (int i = 0; i < n; ++i) {
    mesh.triangles.push_back({ring_start(ring - 1) + i, ring_start(ring - 1) + (i + 1) % n, top});
  }
  return mesh;
}

// Sides of a prism in the order of its faces: those without fillet first.
constexpr int kRight = 0, kBack = 1, kLeft = 2, kFront = 3, kFirstFillet = 4;

BarSection filleted_rectangle(const PrismProductOptions& o) {
  BarSection section;
  const double r = o.fillet_radius;
  const Eigen::Vector2d inner(0.5 * o.width - r, 0.5 * o.depth - r);
  const int arc = r > 0.0 ? circle_segments(r, o.fineness) / 4 : 0;
  const std::array<Eigen::Vector2d, 4> corners = {Eigen::Vector2d(inner.x(), inner.y()),
                                                  {-inner.x(), inner.y()},
                                                  -inner,
                                                  {inner.x(), -inner.y()}};
  const std::array<int, 4> flat_after = {kBack, kLeft, kFront, kRight};
  for (int c = 0; c < 4; ++c) {
    const int flat = flat_after[c];
    for (int i = 0; i <= arc; ++i) {
      const double angle =
          0.5 * std::numbers::pi * (c + (arc > 0 ? static_cast<double>(i) / arc : 0.0));
      section.points.push_back(corners[c] + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      section.side.push_back(i < arc ? kFirstFillet + c : flat);
    }
    // Points along the flat side that follows; none if the fillets meet.
    const Eigen::Vector2d start = section.points.back();
    const double next_angle = 0.5 * std::numbers::pi * (c + 1);
    const Eigen::Vector2d end =
        corners[(c + 1) % 4] + r * Eigen::Vector2d(std::cos(next_angle), std::sin(next_angle));
    const double side = (end - start).norm();
    if (side < 1e-9 * (o.width + o.depth)) {
      section.points.pop_back();
      section.side.pop_back();
      continue;
    }
    const int steps = divisions(side, o.fineness);
    for (int i = 1; i < steps; ++i) {
      section.points.push_back(start + (end - start) * (static_cast<double>(i) / steps));
      section.side.push_back(flat);
    }
  }
  return section;
}

std::vector<BarSide> prism_sides(const PrismProductOptions& o) {
  const double r = o.fillet_radius;
  const double across = o.width - 2.0 * r, along = o.depth - 2.0 * r;
  std::vector<BarSide> sides = {{.name = "right", .width = along},
                                {.name = "back", .width = across},
                                {.name = "left", .width = along},
                                {.name = "front", .width = across}};
  for (int i = 1; i <= 4; ++i) {
    sides.push_back({.name = "fillet " + std::to_string(i),
                     .radius = r,
                     .is_fillet = true,
                     .width = 0.5 * std::numbers::pi * r});
  }
  return sides;
}

/// Unit sphere fine enough for an ellipsoid with these semi-axes.
geometry::TriangleMesh fine_icosphere(const Vec3& semi_axes, const MeshFineness& fineness) {
  const double largest = semi_axes.maxCoeff();
  // Largest gap under a triangle of edge e on a sphere of radius R: the circumradius is e / sqrt 3,
  // so e^2 / 6 R; stretching it to the ellipsoid keeps the gap below that times the largest axis.
  const double edge =
      std::min(fineness.longest_edge / largest, std::sqrt(6.0 * fineness.chordal_error / largest));
  int subdivisions = 2;
  while (subdivisions < kMaxSubdivisions && 1.25 / (1 << subdivisions) > edge) ++subdivisions;
  return geometry::make_icosphere(1.0, subdivisions);
}

Product finish(const std::string& name, geometry::TriangleMesh mesh,
               geometry::DistanceFieldPtr distance) {
  Product product;
  product.name = name;
  product.mesh = std::move(mesh);
  product.distance = std::move(distance);
  product.source = "made: " + name;
  return product;
}

}  // namespace

void MeshFineness::check() const {
  check_between("mesh fineness", "chordal error", chordal_error, 1e-4, 10.0);
  check_between("mesh fineness", "longest edge", longest_edge, 0.1, 1000.0);
}

void CylinderProductOptions::check() const {
  check_size("cylinder", "diameter", diameter);
  check_size("cylinder", "length", length);
  fineness.check();
}

Product make_cylinder_product(const CylinderProductOptions& options) {
  options.check();
  const double radius = 0.5 * options.diameter;
  const int segments = circle_segments(radius, options.fineness);
  BarSection circle;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / segments;
    circle.points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  circle.side.assign(circle.points.size(), 0);
  const BarRings rings = {.length = options.length,
                          .end_area = std::numbers::pi * radius * radius,
                          .along = divisions(options.length, options.fineness),
                          .on_ends = divisions(radius, options.fineness)};
  Product product =
      finish("cylinder " + significant(options.diameter, 6) + " x " +
                 significant(options.length, 6) + " mm",
             sweep(circle.points, options.length, rings.along, rings.on_ends),
             geometry::make_cylinder_distance({.radius = radius, .length = options.length}));
  const BarSide side = {.name = "side", .radius = radius, .width = 2.0 * std::numbers::pi * radius};
  product.faces = bar_faces(circle, {side}, rings);
  return product;
}

void PrismProductOptions::check() const {
  check_size("prism", "width", width);
  check_size("prism", "depth", depth);
  check_size("prism", "length", length);
  check_between("prism", "fillet radius", fillet_radius, 0.0, 0.5 * std::min(width, depth));
  fineness.check();
}

Product make_prism_product(const PrismProductOptions& options) {
  options.check();
  const BarSection section = filleted_rectangle(options);
  const double r = options.fillet_radius;
  const BarRings rings = {
      .length = options.length,
      .end_area = options.width * options.depth - (4.0 - std::numbers::pi) * r * r,
      .along = divisions(options.length, options.fineness),
      .on_ends = divisions(0.5 * std::max(options.width, options.depth), options.fineness)};
  Product product =
      finish("prism " + significant(options.width, 6) + " x " + significant(options.depth, 6) +
                 " x " + significant(options.length, 6) + " mm, fillet " +
                 significant(options.fillet_radius, 6) + " mm",
             sweep(section.points, options.length, rings.along, rings.on_ends),
             geometry::make_prism_distance({.width = options.width,
                                            .depth = options.depth,
                                            .length = options.length,
                                            .fillet_radius = options.fillet_radius}));
  product.faces = bar_faces(section, prism_sides(options), rings);
  return product;
}

void SphereProductOptions::check() const {
  check_size("sphere", "diameter", diameter);
  fineness.check();
}

Product make_sphere_product(const SphereProductOptions& options) {
  options.check();
  const double radius = 0.5 * options.diameter;
  geometry::TriangleMesh mesh = fine_icosphere(Vec3::Constant(radius), options.fineness);
  for (Vec3& x : mesh.vertices) x *= radius;
  return finish("sphere " + significant(options.diameter, 6) + " mm", std::move(mesh),
                geometry::make_sphere_distance(radius));
}

void EllipsoidProductOptions::check() const {
  check_size("ellipsoid", "diameter along x", diameters.x());
  check_size("ellipsoid", "diameter along y", diameters.y());
  check_size("ellipsoid", "diameter along z", diameters.z());
  fineness.check();
}

Product make_ellipsoid_product(const EllipsoidProductOptions& options) {
  options.check();
  const Vec3 axes = 0.5 * options.diameters;
  geometry::TriangleMesh mesh = fine_icosphere(axes, options.fineness);
  for (Vec3& x : mesh.vertices) x = x.cwiseProduct(axes);
  return finish("ellipsoid " + significant(options.diameters.x(), 6) + " x " +
                    significant(options.diameters.y(), 6) + " x " +
                    significant(options.diameters.z(), 6) + " mm",
                std::move(mesh), geometry::make_ellipsoid_distance(axes));
}

void PlaneProductOptions::check() const {
  check_size("plane", "width", width);
  check_size("plane", "depth", depth);
  check_size("plane", "thickness", thickness);
  fineness.check();
}

Product make_plane_product(const PlaneProductOptions& options) {
  options.check();
  const Vec3 size(options.width, options.depth, options.thickness);
  geometry::TriangleMesh mesh = geometry::make_box(
      size, std::min(100, divisions(std::max(options.width, options.depth), options.fineness)));
  for (Vec3& x : mesh.vertices) x.z() -= 0.5 * options.thickness;
  return finish("plane " + significant(options.width, 6) + " x " + significant(options.depth, 6) +
                    " x " + significant(options.thickness, 6) + " mm",
                std::move(mesh), geometry::make_slab_distance(size));
}

}  // namespace palmar::product
