// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/wrench_space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"

namespace palmar::grasp {
namespace {

[[noreturn]] void fail(std::size_t contact, const std::string& what) {
  throw UsageError("grasp: contact " + std::to_string(contact) + ": " + what);
}

template <typename Contact>
void check(const std::vector<Contact>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& one = contacts[i];
    if (!one.position.allFinite()) fail(i, "its position is not finite");
    if (!(std::abs(one.normal.norm() - 1.0) < 1e-6)) {
      fail(i, "length of its normal is " + std::to_string(one.normal.norm()) +
                  "; a unit vector is required");
    }
    if (!(one.friction >= 0.0 && one.friction <= 5.0)) {
      fail(i, "friction is " + std::to_string(one.friction) + "; 0 to 5 is allowed");
    }
  }
}

/// Base of a contact's tangent plane that turns with the grasp: its first axis points towards the
/// reference point or, where the normal goes through that, to another contact.
std::pair<Vec3, Vec3> tangents(const std::vector<GraspContact>& contacts, std::size_t at,
                               const Vec3& reference, double scale) {
  const Vec3& n = contacts[at].normal;
  const auto in_plane = [&](const Vec3& way) { return Vec3(way - n * n.dot(way)); };
  const auto base = [&](const Vec3& way) {
    const Vec3 t = way.normalized();
    return std::pair<Vec3, Vec3>(t, n.cross(t));
  };
  constexpr double kClear = 1e-3;  // of the torque scale
  const Vec3 home = in_plane(reference - contacts[at].position);
  if (home.norm() > kClear * scale) return base(home);
  for (const GraspContact& other : contacts) {
    const Vec3 way = in_plane(other.position - contacts[at].position);
    if (way.norm() > kClear * scale) return base(way);
  }
  int axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  return base(in_plane(Vec3::Unit(axis)));
}

template <int D>
WrenchSpace<D> measured(PointGroups<D> groups, WrenchNorm norm, double torque_scale,
                        const BodyOptions& options) {
  WrenchSpace<D> space;
  space.norm = norm;
  space.torque_scale = torque_scale;
  if (groups.group.empty()) return space;
  groups.is_sum = norm == WrenchNorm::kLinf;
  space.body = measure<D>(groups, options);
  space.weakest = space.body.weakest;
  if (space.body.rank < D) {
    space.status = ClosureStatus::kRankDeficient;
  } else if (!space.body.contains_origin) {
    space.status = ClosureStatus::kNotClosed;
  } else {
    space.status = ClosureStatus::kForceClosure;
    space.epsilon = space.body.distance;
  }
  return space;
}

}  // namespace

std::string_view name_of(ClosureStatus status) {
  switch (status) {
    case ClosureStatus::kForceClosure:
      return "force_closure";
    case ClosureStatus::kNotClosed:
      return "not_closed";
    case ClosureStatus::kRankDeficient:
      return "rank_deficient";
    case ClosureStatus::kNoContact:
      return "no_contact";
  }
  return "no_contact";
}

void WrenchOptions::check() const {
  const auto require = [](bool is_good, const std::string& what) {
    if (!is_good) throw UsageError("stability: " + what);
  };
  require(sides >= 3 && sides <= 64,
          "sides of a friction cone are " + std::to_string(sides) + "; 3 to 64 are allowed");
  require(torsion_rings >= 0 && torsion_rings <= 8,
          "torsion rings are " + std::to_string(torsion_rings) + "; 0 to 8 are allowed");
  require(!torque_scale || (*torque_scale > 0.0 && std::isfinite(*torque_scale)),
          "torque scale is " + std::to_string(torque_scale.value_or(0.0)) +
              " mm; more than 0 is required");
  require(body.max_facets >= 10 && body.max_volume_facets >= 0,
          "facets allowed are " + std::to_string(body.max_facets) + " and " +
              std::to_string(body.max_volume_facets) + "; at least 10 and 0 are required");
}

double torque_scale_of(const std::vector<GraspContact>& contacts, const Vec3& reference) {
  double largest = 0.0;
  for (const GraspContact& one : contacts) {
    largest = std::max(largest, (one.position - reference).norm());
  }
  return largest > 0.0 ? largest : 1.0;
}

PointGroups<6> primitive_wrenches(const std::vector<GraspContact>& contacts, const Vec3& reference,
                                  double torque_scale, const WrenchOptions& options) {
  options.check();
  check(contacts);
  PointGroups<6> groups;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const GraspContact& contact = contacts[i];
    if (!(contact.torsion >= 0.0 && std::isfinite(contact.torsion))) {
      fail(i, "torsion is " + std::to_string(contact.torsion) + " mm; 0 or more is required");
    }
    std::vector<Wrench6>& edges = groups.group.emplace_back();
    const auto [t, b] = tangents(contacts, i, reference, torque_scale);
    const auto add = [&](const Vec3& force, double moment_about_normal) {
      Wrench6 w;
      w.head<3>() = force;
      w.tail<3>() =
          ((contact.position - reference).cross(force) + moment_about_normal * contact.normal) /
          torque_scale;
      edges.push_back(w);
    };
    const bool has_friction = contact.friction > 0.0;
    const bool has_torsion = contact.torsion > 0.0;
    if (!has_friction && !has_torsion) {
      add(contact.normal, 0.0);
      continue;
    }
    const int rings = has_torsion && has_friction ? options.torsion_rings : 0;
    for (int ring = -rings; has_friction && ring <= rings; ++ring) {
      const double latitude = ring * 0.5 * std::numbers::pi / (rings + 1);
      for (int k = 0; k < options.sides; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / options.sides;
        const Vec3 along = std::cos(angle) * t + std::sin(angle) * b;
        add(contact.normal + contact.friction * std::cos(latitude) * along,
            contact.torsion * std::sin(latitude));
      }
    }
    if (has_torsion) {
      add(contact.normal, contact.torsion);
      add(contact.normal, -contact.torsion);
    }
  }
  return groups;
}

WrenchSpace<6> measure_wrench_space(const std::vector<GraspContact>& contacts,
                                    const Vec3& reference, WrenchNorm norm,
                                    const WrenchOptions& options) {
  const double scale = options.torque_scale.value_or(torque_scale_of(contacts, reference));
  return measured(primitive_wrenches(contacts, reference, scale, options), norm, scale,
                  options.body);
}

WrenchSpace<3> measure_wrench_space(const std::vector<PlanarContact>& contacts,
                                    const Vec2& reference, WrenchNorm norm,
                                    const WrenchOptions& options) {
  options.check();
  check(contacts);
  double scale = 0.0;
  for (const PlanarContact& one : contacts) {
    scale = std::max(scale, (one.position - reference).norm());
  }
  if (!(scale > 0.0)) scale = 1.0;
  scale = options.torque_scale.value_or(scale);
  PointGroups<3> groups;
  for (const PlanarContact& contact : contacts) {
    std::vector<Eigen::Vector3d>& edges = groups.group.emplace_back();
    const Vec2 r = contact.position - reference;
    const Vec2 side(-contact.normal.y(), contact.normal.x());
    for (const double sign : {-1.0, 1.0}) {
      const Vec2 force = contact.normal + sign * contact.friction * side;
      edges.emplace_back(force.x(), force.y(), (r.x() * force.y() - r.y() * force.x()) / scale);
      if (contact.friction == 0.0) break;
    }
  }
  return measured(groups, norm, scale, options.body);
}

}  // namespace palmar::grasp
