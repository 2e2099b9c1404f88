// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/distance/analytic_distance.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::geometry {
namespace {

/// Signed distance and its gradient at a point.
struct Value {
  double distance = 0.0;
  Vec3 normal = Vec3::UnitZ();
};

/// The same for a cross-section in the plane.
struct Value2 {
  double distance = 0.0;
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();
};

/// A field from a function Vec3 -> Value.
template <typename Function>
class AnalyticDistance : public DistanceField {
 public:
  AnalyticDistance(Function function, const Box3& box)
      : function_(std::move(function)), box_(box) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<DistanceSample> samples) const override {
    if (points.size() != samples.size()) {
      throw UsageError("distance to a solid: " + std::to_string(points.size()) +
                       " points but room for " + std::to_string(samples.size()) +
                       " samples; the numbers must be equal");
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Value v = function_(points[i]);
      if (std::abs(v.distance) > range) {
        samples[i] = {std::copysign(range, v.distance), points[i], v.normal, -1};
      } else {
        samples[i] = {v.distance, points[i] - v.distance * v.normal, v.normal, -1};
      }
    }
  }
  Box3 bounding_box() const override { return box_; }
  bool is_lipschitz() const override { return true; }

 private:
  Function function_;
  Box3 box_;
};

template <typename Function>
DistanceFieldPtr make_field(Function function, const Vec3& half_size) {
  return std::make_shared<AnalyticDistance<Function>>(std::move(function),
                                                      Box3(-half_size, half_size));
}

void check_length(const char* object, const char* name, double value) {
  if (!(value > 0.0) || !std::isfinite(value)) {
    throw UsageError(std::string(object) + ": " + name + " is " + std::to_string(value) +
                     " mm; a finite length above 0 is required");
  }
}

void check_rounding(const char* object, const char* name, double value, double largest) {
  if (!(value >= 0.0) || value > largest) {
    throw UsageError(std::string(object) + ": " + name + " is " + std::to_string(value) +
                     " mm; 0 to " + std::to_string(largest) + " mm is allowed");
  }
}

Vec3 sign_of(const Vec3& v) {
  return {std::copysign(1.0, v.x()), std::copysign(1.0, v.y()), std::copysign(1.0, v.z())};
}

/// Box of half sizes `half` in n dimensions, q already folded into the positive orthant. Outside
/// the distance to the nearest corner, edge or face; inside to the nearest face.
template <int N>
std::pair<double, Eigen::Matrix<double, N, 1>> folded_box(const Eigen::Matrix<double, N, 1>& q,
                                                          const Eigen::Matrix<double, N, 1>& half) {
  using Vec = Eigen::Matrix<double, N, 1>;
  const Vec beyond = q - half;
  int nearest = 0;
  const double largest = beyond.maxCoeff(&nearest);
  if (largest > 0.0) {
    const Vec outside = beyond.cwiseMax(0.0);
    return {outside.norm(), outside.normalized()};
  }
  Vec normal = Vec::Unit(nearest);
  if (largest == 0.0) {
    // On an edge or corner: the middle of the faces that meet there.
    normal = (beyond.array() == 0.0).template cast<double>().matrix().normalized();
  }
  return {largest, normal};
}

Value2 rounded_rectangle(const Eigen::Vector2d& p, const Eigen::Vector2d& half, double radius) {
  const auto [distance, normal] =
      folded_box<2>(p.cwiseAbs(), half - Eigen::Vector2d::Constant(radius));
  return {distance - radius, {std::copysign(normal.x(), p.x()), std::copysign(normal.y(), p.y())}};
}

/// Section swept along z over |z| <= half_length: side and end combine like a box in the plane of
/// (distance to the section, |z|). Exact wherever the section's own distance is.
Value swept(const Value2& section, double z, double half_length) {
  const auto [distance, normal] =
      folded_box<2>({section.distance, std::abs(z)}, {0.0, half_length});
  return {distance,
          {normal.x() * section.normal.x(), normal.x() * section.normal.y(),
           std::copysign(normal.y(), z)}};
}

Value2 disc(const Eigen::Vector2d& p, double radius) {
  const double r = p.norm();
  return {r - radius, r > 0.0 ? Eigen::Vector2d(p / r) : Eigen::Vector2d::UnitX()};
}

Value ellipsoid(const Vec3& q, const Vec3& axes) {
  // In units of the largest axis; coordinates of zero are lifted by rounding, so that no case
  // needs a branch of its own.
  const double scale = axes.maxCoeff();
  const Vec3 e = axes / scale;
  const Vec3 y = (q.cwiseAbs() / scale).cwiseMax(1e-13 * e);
  const double smallest2 = e.minCoeff() * e.minCoeff();
  const Vec3 rest = e.cwiseProduct(e) - Vec3::Constant(smallest2);
  const Vec3 ey = e.cwiseProduct(y);
  // Unknown g = t + (smallest axis)^2 > 0; F(g) = sum (e y / (g + rest))^2 - 1 falls and is convex,
  // so Newton from a g with F >= 0 climbs to the root and never passes it.
  double g = (ey - rest).maxCoeff();
  g = std::max(g, 1e-300);
  for (int i = 0; i < 400; ++i) {
    const Vec3 s = ey.cwiseQuotient(rest + Vec3::Constant(g));
    const double value = s.squaredNorm() - 1.0;
    const double slope = -2.0 * s.cwiseProduct(s).cwiseQuotient(rest + Vec3::Constant(g)).sum();
    const double step = -value / slope;
    if (!(step > 1e-16 * g)) break;
    g += step;
  }
  const Vec3 folded = e.cwiseProduct(ey).cwiseQuotient(rest + Vec3::Constant(g)) * scale;
  const Vec3 closest = folded.cwiseProduct(sign_of(q));
  const Vec3 normal = closest.cwiseQuotient(axes).cwiseQuotient(axes).normalized();
  return {normal.dot(q - closest), normal};
}

}  // namespace

DistanceFieldPtr make_sphere_distance(double radius) {
  check_length("sphere", "radius", radius);
  return make_field(
      [radius](const Vec3& p) -> Value {
        const double r = p.norm();
        return {r - radius, r > 0.0 ? Vec3(p / r) : Vec3::UnitZ()};
      },
      Vec3::Constant(radius));
}

DistanceFieldPtr make_half_space_distance() {
  return make_field(
      [](const Vec3& p) -> Value {
        return {p.z(), Vec3::UnitZ()};
      },
      Vec3(1000.0, 1000.0, 0.0));
}

void CylinderShape::check() const {
  check_length("cylinder", "radius", radius);
  if (!(length > 0.0)) {
    throw UsageError("cylinder: length is " + std::to_string(length) +
                     " mm; a length above 0 is required");
  }
  check_rounding("cylinder", "edge radius", edge_radius, std::min(radius, 0.5 * length));
}

DistanceFieldPtr make_cylinder_distance(const CylinderShape& shape) {
  shape.check();
  const double half = 0.5 * shape.length;
  return make_field(
      [shape, half](const Vec3& p) -> Value {
        Value v = swept(disc(p.head<2>(), shape.radius - shape.edge_radius), p.z(),
                        half - shape.edge_radius);
        v.distance -= shape.edge_radius;
        return v;
      },
      Vec3(shape.radius, shape.radius, std::min(half, 1000.0)));
}

DistanceFieldPtr make_box_distance(const Vec3& size, double edge_radius) {
  for (int k = 0; k < 3; ++k) check_length("box", "edge length", size[k]);
  check_rounding("box", "edge radius", edge_radius, 0.5 * size.minCoeff());
  const Vec3 inner = 0.5 * size - Vec3::Constant(edge_radius);
  return make_field(
      [inner, edge_radius](const Vec3& p) -> Value {
        const auto [distance, normal] = folded_box<3>(p.cwiseAbs(), inner);
        return {distance - edge_radius, normal.cwiseProduct(sign_of(p))};
      },
      0.5 * size);
}

DistanceFieldPtr make_slab_distance(const Vec3& size) {
  for (int k = 0; k < 3; ++k) check_length("slab", "edge length", size[k]);
  const Vec3 half = 0.5 * size;
  const auto function = [half](const Vec3& p) -> Value {
    const Vec3 q(p.x(), p.y(), p.z() + half.z());
    const auto [distance, normal] = folded_box<3>(q.cwiseAbs(), half);
    return {distance, normal.cwiseProduct(sign_of(q))};
  };
  return std::make_shared<AnalyticDistance<decltype(function)>>(
      function, Box3(Vec3(-half.x(), -half.y(), -size.z()), Vec3(half.x(), half.y(), 0.0)));
}

void PrismShape::check() const {
  check_length("prism", "width", width);
  check_length("prism", "depth", depth);
  check_length("prism", "length", length);
  check_rounding("prism", "fillet radius", fillet_radius, 0.5 * std::min(width, depth));
}

DistanceFieldPtr make_prism_distance(const PrismShape& shape) {
  shape.check();
  const Eigen::Vector2d half(0.5 * shape.width, 0.5 * shape.depth);
  return make_field(
      [shape, half](const Vec3& p) -> Value {
        return swept(rounded_rectangle(p.head<2>(), half, shape.fillet_radius), p.z(),
                     0.5 * shape.length);
      },
      0.5 * Vec3(shape.width, shape.depth, shape.length));
}

DistanceFieldPtr make_ellipsoid_distance(const Vec3& semi_axes) {
  for (int k = 0; k < 3; ++k) check_length("ellipsoid", "semi-axis", semi_axes[k]);
  return make_field([semi_axes](const Vec3& p) { return ellipsoid(p, semi_axes); }, semi_axes);
}

}  // namespace palmar::geometry
