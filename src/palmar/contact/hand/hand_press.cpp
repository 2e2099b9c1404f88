// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "palmar/contact/hand/hand_contact.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/press/half_space_press.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

constexpr double kPunchLength = 100.0;  // mm; longer than any part of a hand is thick

/// Two punches stand at x = +- this; one at 0.
double punch_offset(const PressIndenter& indenter) {
  return indenter.kind == PressIndenter::Kind::kTwoPunches ? 0.5 * indenter.distance : 0.0;
}

/// The indenter as a solid in a frame of its own: it presses along -z, its lowest point (of the
/// punch: its whole face) in the origin, the cylinder's axis along y.
class IndenterField : public geometry::DistanceField {
 public:
  explicit IndenterField(const PressIndenter& indenter) : indenter_(indenter) {}

  void sample(std::span<const Vec3> points, double range,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      samples[i] = one(points[i]);
      if (std::abs(samples[i].distance) <= range) continue;
      samples[i].distance = std::copysign(range, samples[i].distance);
      samples[i].closest = points[i];
    }
  }
  Box3 bounding_box() const override {
    const bool is_round = indenter_.kind == PressIndenter::Kind::kSphere ||
                          indenter_.kind == PressIndenter::Kind::kPunch ||
                          indenter_.kind == PressIndenter::Kind::kTwoPunches;
    const double y = is_round ? indenter_.radius : 1e4;
    const double x = y + punch_offset(indenter_);
    return {Vec3(-x, -y, 0.0), Vec3(x, y, 1e4)};
  }

 private:
  /// Outside a ball or bar the nearest point; inside, the one below along the press, from where the
  /// skin came: the gap of Hertz' problem. (Measured radially, deep skin near the middle would be
  /// pushed sideways, and the force fall to nothing as the depth nears the radius.)
  geometry::DistanceSample around(const Vec3& q, const Vec3& from_axis) const {
    const double radius = indenter_.radius;
    const double length = from_axis.norm();
    if (length >= radius) {
      const Vec3 n = from_axis / length;
      return {length - radius, q - (length - radius) * n, n, -1};
    }
    const double across2 = from_axis.squaredNorm() - from_axis.z() * from_axis.z();
    const double height = radius - std::sqrt(radius * radius - across2);
    return {height - q.z(), {q.x(), q.y(), height}, -Vec3::UnitZ(), -1};
  }

  geometry::DistanceSample one(const Vec3& q) const {
    const double radius = indenter_.radius;
    switch (indenter_.kind) {
      case PressIndenter::Kind::kSphere:
        return around(q, Vec3(q.x(), q.y(), q.z() - radius));
      case PressIndenter::Kind::kCylinder:
        return around(q, Vec3(q.x(), 0.0, q.z() - radius));
      case PressIndenter::Kind::kPlane:
        return {-q.z(), {q.x(), q.y(), 0.0}, -Vec3::UnitZ(), -1};
      case PressIndenter::Kind::kPunch:
      case PressIndenter::Kind::kTwoPunches:
        break;
    }
    const Vec3 axis(std::copysign(punch_offset(indenter_), q.x()), 0.0, 0.0);
    const double x = q.x() - axis.x();
    const double rho = std::hypot(x, q.y());
    const Vec3 out = rho > 0.0 ? Vec3(x / rho, q.y() / rho, 0.0) : Vec3(Vec3::UnitX());
    // Skin under the punch came in through its face, however near the edge it lies.
    if (rho <= radius) return {-q.z(), {q.x(), q.y(), 0.0}, -Vec3::UnitZ(), -1};
    const Vec3 side = axis + radius * out + std::clamp(q.z(), 0.0, kPunchLength) * Vec3::UnitZ();
    const Vec3 from_side = q - side;
    return {from_side.norm(), side, from_side.normalized(), -1};
  }

  PressIndenter indenter_;
};

/// Height at which the indenter first touches a point (x, y, z), if it covers it.
double touching_height(const PressIndenter& indenter, const Vec3& q) {
  double across2 = 0.0;
  switch (indenter.kind) {
    case PressIndenter::Kind::kPlane:
      return q.z();
    case PressIndenter::Kind::kCylinder:
      across2 = q.x() * q.x();
      break;
    case PressIndenter::Kind::kSphere:
      across2 = q.x() * q.x() + q.y() * q.y();
      break;
    case PressIndenter::Kind::kPunch:
    case PressIndenter::Kind::kTwoPunches: {
      const double x = std::abs(q.x()) - punch_offset(indenter);
      const bool is_under = x * x + q.y() * q.y() <= indenter.radius * indenter.radius;
      return is_under ? q.z() : -std::numeric_limits<double>::infinity();
    }
  }
  const double inside = indenter.radius * indenter.radius - across2;
  if (inside < 0.0) return -std::numeric_limits<double>::infinity();
  return q.z() - indenter.radius + std::sqrt(inside);
}

/// Along the finger towards its tip; along the hand for the palm.
Vec3 distal_direction(const hand::Hand& hand, hand::Region region) {
  const auto segment = hand::segment_of(region);
  const auto finger = segment ? hand::finger_of(*segment) : std::nullopt;
  if (!finger) return Vec3::UnitY();
  const Vec3 along = hand.skeleton.fingertips[index_of(*finger)] -
                     hand.skeleton.joint(hand::joint_of(*segment)).centre;
  return along.norm() > 1e-6 ? Vec3(along.normalized()) : Vec3(Vec3::UnitY());
}

/// Frame of the indenter at first touch.
geometry::Rigid3 hand_from_indenter(const PressOptions& options,
                                    const PreparedHand::Impl& prepared) {
  const hand::Hand& hand = *prepared.hand;
  Vec3 outward = Vec3::Zero();
  Vec3 middle = Vec3::Zero();
  double area = 0.0;
  for (int v = 0; v < prepared.skin.vertex_count(); ++v) {
    if (hand.region[v] != options.specimen.region) continue;
    outward += prepared.skin.area[v] * prepared.skin.normal[v];
    middle += prepared.skin.area[v] * prepared.skin.position[v];
    area += prepared.skin.area[v];
  }
  if (!(area > 0.0) || !(outward.norm() > 1e-9 * area)) {
    throw UsageError("press: hand \"" + hand.name + "\" has no skin in region " +
                     std::string(name_of(options.specimen.region)));
  }
  middle /= area;
  outward.normalize();
  Vec3 distal = distal_direction(hand, options.specimen.region);
  distal -= distal.dot(outward) * outward;
  if (distal.norm() < 1e-6) distal = outward.unitOrthogonal();
  distal.normalize();
  const double c = std::cos(options.tilt);
  const double s = std::sin(options.tilt);
  // z points away from the skin, x towards the tip, y across.
  Eigen::Matrix3d axes;
  axes.col(2) = c * outward + s * distal;
  axes.col(0) = c * distal - s * outward;
  axes.col(1) = axes.col(2).cross(axes.col(0));
  geometry::Rigid3 frame{Quat(axes), middle};

  // Over the point that stands out most along the press, at the height of first touch.
  const geometry::Rigid3 frame_from_hand = frame.inverse();
  Vec3 top(0.0, 0.0, -std::numeric_limits<double>::infinity());
  for (int v = 0; v < prepared.skin.vertex_count(); ++v) {
    if (hand.region[v] != options.specimen.region) continue;
    const Vec3 q = frame_from_hand * prepared.skin.position[v];
    if (q.z() > top.z()) top = q;
  }
  double height = -std::numeric_limits<double>::infinity();
  for (int v = 0; v < prepared.skin.vertex_count(); ++v) {
    if (hand.region[v] != options.specimen.region) continue;
    const Vec3 q = frame_from_hand * prepared.skin.position[v] - Vec3(top.x(), top.y(), 0.0);
    height = std::max(height, touching_height(options.indenter, q));
  }
  frame.translation = frame * Vec3(top.x(), top.y(), height);
  return frame;
}

}  // namespace

geometry::Rigid3 indenter_at_first_touch(const PressOptions& options, const PreparedHand& hand) {
  return hand_from_indenter(options, hand.impl());
}

PressStep press_hand_region(const PressOptions& options, const PreparedHand& hand, double depth) {
  const PreparedHand::Impl& prepared = hand.impl();
  geometry::Rigid3 hand_from_product = hand_from_indenter(options, prepared);
  hand_from_product.translation -= depth * (hand_from_product.rotation * Vec3::UnitZ());
  ContactOptions contact_options;
  contact_options.swelling = false;
  contact_options.cell_area = options.cell_area;
  contact_options.shear_modulus = options.shear_modulus;
  if (options.coating) {
    contact_options.coatings = {*options.coating};
    contact_options.coatings.front().where = Box3();
  }
  const ContactResult contact = solve_region_contact(
      hand, prepared.hand->skin.vertices, hand_from_product.inverse(),
      IndenterField(options.indenter), contact_options, options.specimen.region);
  if (contact.status == ContactStatus::kNotConverged || contact.status == ContactStatus::kTooDeep) {
    throw NumericalError("press: " + contact.message);
  }
  PressStep step{.depth = depth};
  step.force = contact.total.force_vector.z();
  step.area = contact.total.area;
  step.peak_pressure = contact.total.peak_pressure;
  step.peak_pressure_cells = contact.total.peak_pressure_cells;
  step.mean_pressure = step.area > 0.0 ? step.force / step.area : 0.0;
  step.complementarity_error = contact.complementarity_error;
  double largest = 0.0;
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    largest = std::max(largest, contact.force[v]);
    if (contact.distance[v] < 0.0) ++step.vertices;
  }
  if (largest > 0.0) step.relative_residual = step.complementarity_error / (depth * largest);
  for (const RegionContact& region : contact.regions) step.shear_modulus = region.shear_modulus;
  return step;
}

}  // namespace palmar::contact
