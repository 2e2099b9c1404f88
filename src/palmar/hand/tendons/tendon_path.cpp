// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/tendons/tendon_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palmar::hand {
namespace {

/// A posed span: straight from a to b, or from a to t1, round the cylinder to t2, and on to b.
struct Course {
  Vec3 a, b;
  bool wraps = false;
  Vec3 t1, t2;
  double length = 0.0;
  std::optional<double> held_arm;  ///< of a chord past its largest arm, see TendonCylinder
};

/// Whether the span crosses one hinge alone, that of its cylinder.
bool crosses_one_axis(const TendonSpan& span) {
  return span.distal.body == span.proximal.body + 1 && span.cylinder->body == span.proximal.body;
}

/// A chord between points at distances p and q from the axis has its largest arm, the smaller of
/// these, where it is perpendicular to the shorter one, cos psi = p / q. Nearer together it would
/// pass through the joint's soft parts: length goes on falling by that arm.
void hold_largest_arm(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double axial,
                      double sense, Course& course) {
  const double arm = std::min(a.norm(), b.norm()), other = std::max(a.norm(), b.norm());
  if (arm <= 0.0) return;
  const double largest = std::acos(arm / other);
  const double psi = std::acos(std::clamp(a.dot(b) / (arm * other), -1.0, 1.0));
  if (psi >= largest) return;
  const double planar = std::sqrt(other * other - arm * arm) - arm * (largest - psi);
  course.length = std::hypot(planar, axial);
  course.held_arm = course.length > 0.0 ? -sense * arm * planar / course.length : 0.0;
}

Course course_of(const TendonSpan& span, const PosedDigit& digit) {
  Course course;
  course.a = digit.place(span.proximal.body, span.proximal.point);
  course.b = digit.place(span.distal.body, span.distal.point);
  course.length = (course.b - course.a).norm();
  if (!span.cylinder) return course;

  const TendonCylinder& cylinder = *span.cylinder;
  const geometry::Rigid3& posed = digit.body[cylinder.body];
  const Vec3 centre = posed * cylinder.centre, u = posed.rotation * cylinder.axis;
  const Vec3 e1 = u.unitOrthogonal(), e2 = u.cross(e1);
  const auto in_plane = [&](const Vec3& x) {
    return Eigen::Vector2d((x - centre).dot(e1), (x - centre).dot(e2));
  };
  const Eigen::Vector2d a = in_plane(course.a), b = in_plane(course.b);
  const Eigen::Vector2d along = b - a;
  const double reach = along.norm();
  if (reach <= 0.0) return course;
  // Distance of the straight line from the axis, positive on the tendon's side.
  const double arm = cylinder.sense * (a.x() * along.y() - a.y() * along.x()) / reach;
  const double r = cylinder.radius;
  // A point inside the cylinder has no tangent: the tendon runs straight there.
  const double axial = (course.b - course.a).dot(u);
  if (arm > 0.0 && crosses_one_axis(span)) hold_largest_arm(a, b, axial, cylinder.sense, course);
  if (course.held_arm || arm >= r || a.norm() < r || b.norm() < r) return course;

  const double out_a = std::acos(std::clamp(r / a.norm(), -1.0, 1.0));
  const double out_b = std::acos(std::clamp(r / b.norm(), -1.0, 1.0));
  const double first = std::atan2(a.y(), a.x()) + cylinder.sense * out_a;
  const double last = std::atan2(b.y(), b.x()) - cylinder.sense * out_b;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const double arc = std::remainder(cylinder.sense * (last - first), kTurn);
  if (arc <= 0.0) return course;  // nearest to the axis beyond the span's end

  const double to_t1 = std::sqrt(std::max(0.0, a.squaredNorm() - r * r));
  const double from_t2 = std::sqrt(std::max(0.0, b.squaredNorm() - r * r));
  const double planar = to_t1 + r * arc + from_t2;
  const double start = (course.a - centre).dot(u);
  const auto on_cylinder = [&](double angle, double way) {
    return Vec3(centre + r * (std::cos(angle) * e1 + std::sin(angle) * e2) +
                (start + axial * way / planar) * u);
  };
  course.wraps = true;
  course.t1 = on_cylinder(first, to_t1);
  course.t2 = on_cylinder(last, to_t1 + r * arc);
  course.length = std::hypot(planar, axial);
  return course;
}

/// Rate at which the straight piece from p to q gets longer.
double lengthening(const Vec3& p, const Vec3& q, const Vec3& rate_p, const Vec3& rate_q) {
  const Vec3 way = q - p;
  const double length = way.norm();
  return length > 0.0 ? way.dot(rate_q - rate_p) / length : 0.0;
}

}  // namespace

double path_length(const TendonPath& path, const PosedDigit& digit) {
  double sum = 0.0;
  for (const TendonSpan& span : path) sum += span.share * course_of(span, digit).length;
  return sum;
}

std::array<double, kDigitDofs> moment_arms(const TendonPath& path, const PosedDigit& digit) {
  std::array<double, kDigitDofs> arms{};
  for (const TendonSpan& span : path) {
    const Course course = course_of(span, digit);
    for (int k = 0; k < kDigitDofs; ++k) {
      const Vec3 rate_a = digit.velocity(k, span.proximal.body, course.a);
      const Vec3 rate_b = digit.velocity(k, span.distal.body, course.b);
      double rate = 0.0;
      if (course.held_arm) {
        if (digit.moves[k] == span.distal.body) rate = -*course.held_arm;
      } else if (course.wraps) {
        const int body = span.cylinder->body;
        rate = lengthening(course.a, course.t1, rate_a, digit.velocity(k, body, course.t1)) +
               lengthening(course.t2, course.b, digit.velocity(k, body, course.t2), rate_b);
      } else {
        rate = lengthening(course.a, course.b, rate_a, rate_b);
      }
      arms[k] -= span.share * rate;
    }
  }
  return arms;
}

}  // namespace palmar::hand
