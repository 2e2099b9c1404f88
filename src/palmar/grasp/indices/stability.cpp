// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/stability.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/grasp/indices/linear_program.h"
#include "palmar/grasp/rest/cone_projection.h"

namespace palmar::grasp {
namespace {

std::string direction(const Vec3& v) {
  char text[64];
  const Vec3 u = v.normalized();
  // Adding 0 makes -0 a 0.
  std::snprintf(text, sizeof text, "(%.2f, %.2f, %.2f)", u.x() + 0.0, u.y() + 0.0, u.z() + 0.0);
  return text;
}

/// "along (..)", "about (..)" or both, whatever is not small; product frame.
std::string motion_words(const Vec3& linear, const Vec3& angular) {
  constexpr double kSmall = 0.05;  // of the whole
  const double whole = std::hypot(linear.norm(), angular.norm());
  std::string words;
  if (linear.norm() > kSmall * whole) words = "along " + direction(linear);
  if (angular.norm() > kSmall * whole) {
    words += (words.empty() ? "about " : " and about ") + direction(angular);
  }
  return words + " of the product frame";
}

/// The motion whose fastest contact moves by 1 mm.
contact::SmallMotion escape_motion(const std::vector<GraspContact>& contacts, const Wrench6& along,
                                   double scale, const Vec3& reference) {
  contact::SmallMotion motion{along.head<3>(), along.tail<3>() / scale, reference};
  double fastest = motion.translation.norm();
  for (const GraspContact& one : contacts) {
    fastest = std::max(fastest, motion.at(one.position).norm());
  }
  if (fastest > 0.0) {
    motion.translation /= fastest;
    motion.rotation /= fastest;
  }
  return motion;
}

/// Primitive wrenches as columns, with the contact of each.
struct Columns {
  Eigen::MatrixXd wrench;
  std::vector<int> contact;
};

Columns columns_of(const PointGroups<6>& groups) {
  Columns columns;
  for (std::size_t g = 0; g < groups.group.size(); ++g) {
    columns.contact.insert(columns.contact.end(), groups.group[g].size(), static_cast<int>(g));
  }
  columns.wrench.resize(6, static_cast<Eigen::Index>(columns.contact.size()));
  Eigen::Index j = 0;
  for (const auto& group : groups.group) {
    for (const Wrench6& w : group) columns.wrench.col(j++) = w;
  }
  return columns;
}

/// Least factor on the known normal forces. With S the wrenches that these forces and friction can
/// make, load + lambda s = 0 for an s in S: a combination of corners s_k of S with factors m_k >= 0
/// and lambda = sum m_k. S has too many corners to list; those that matter are made as the dual
/// asks for them (column generation; Dantzig, Wolfe 1960).
std::optional<double> least_factor(const std::vector<GraspContact>& contacts,
                                   const PointGroups<6>& groups, const Wrench6& load) {
  double sum = 0.0;
  for (const GraspContact& one : contacts) sum += one.normal_force;
  if (!(sum > 0.0)) return std::nullopt;
  const auto corner = [&](const Eigen::VectorXd& along) {
    Wrench6 s = Wrench6::Zero();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      const Wrench6* best = nullptr;
      double largest = 0.0;
      for (const Wrench6& w : groups.group[i]) {
        const double here = along.dot(w);
        if (best == nullptr || here > largest) {
          best = &w;
          largest = here;
        }
      }
      s += contacts[i].normal_force / sum * *best;
    }
    return s;
  };
  const double size = load.norm();
  constexpr int kMostCorners = 400;
  Eigen::MatrixXd corners = corner(-load);
  while (corners.cols() < kMostCorners) {
    const ProgramSolution found =
        solve_linear_program(Eigen::VectorXd::Ones(corners.cols()), corners, -load / size);
    const bool is_optimal = found.status == ProgramStatus::kOptimal;
    if (!is_optimal && found.status != ProgramStatus::kInfeasible) break;
    const Wrench6 next = corner(found.dual);
    // A corner helps if its reduced cost is below 0: 1 - y . s, without the 1 while infeasible.
    const double gain = found.dual.dot(next) - (is_optimal ? 1.0 : 0.0);
    if (gain <= 1e-9 * std::max(1.0, found.dual.norm())) {
      if (!is_optimal) break;
      return found.value * size / sum;
    }
    corners.conservativeResize(Eigen::NoChange, corners.cols() + 1);
    corners.rightCols<1>() = next;
  }
  return std::nullopt;
}

std::string closure_message(const StabilityResult& result) {
  const WrenchSpace<6>& space = result.l1;
  const auto against = [&] {
    return motion_words(space.weakest.head<3>(), space.weakest.tail<3>());
  };
  switch (space.status) {
    case ClosureStatus::kNoContact:
      return "nothing is touched, so nothing is held";
    case ClosureStatus::kRankDeficient:
      return "no contact can push or turn the product " + against() + ", neither way" +
             (result.friction > 0.0 ? "" : ": there is no friction");
    case ClosureStatus::kNotClosed:
      return "no force closure: no contact can push or turn the product " + against() +
             (result.friction > 0.0 ? "" : "; there is no friction");
    case ClosureStatus::kForceClosure:
      break;
  }
  return {};
}

}  // namespace

void StabilityOptions::check() const {
  if (volume_contacts < 4 || volume_contacts > 64) {
    throw UsageError("stability: contacts for the volume are " + std::to_string(volume_contacts) +
                     "; 4 to 64 are allowed");
  }
  reduction.check();
  wrench.check();
  if (load) contact::FrictionOptions{.coefficient = reduction.friction, .load = *load}.check();
}

std::string_view name_of(GripForceStatus status) {
  switch (status) {
    case GripForceStatus::kHeld:
      return "held";
    case GripForceStatus::kNoLoad:
      return "no_load";
    case GripForceStatus::kNotHoldable:
      return "not_holdable";
    case GripForceStatus::kNoContact:
      return "no_contact";
    case GripForceStatus::kNotConverged:
      return "not_converged";
  }
  return "no_contact";
}

GripForce least_grip_force(const std::vector<GraspContact>& contacts, const contact::Wrench& load,
                           const Vec3& reference, const WrenchOptions& options) {
  GripForce result;
  const double scale = options.torque_scale.value_or(torque_scale_of(contacts, reference));
  Wrench6 w;
  w.head<3>() = load.force;
  w.tail<3>() = (load.moment - reference.cross(load.force)) / scale;
  if (!w.allFinite()) throw UsageError("stability: the load is not finite");
  const double size = w.norm();
  result.force.assign(contacts.size(), Vec3::Zero());
  if (!(size > 0.0)) {
    result.status = GripForceStatus::kNoLoad;
    result.factor = 0.0;
    return result;
  }
  if (contacts.empty()) {
    result.message = "nothing is touched, so nothing is held";
    return result;
  }
  const PointGroups<6> groups = primitive_wrenches(contacts, reference, scale, options);
  const Columns columns = columns_of(groups);
  const ProgramSolution found =
      solve_linear_program(Eigen::VectorXd::Ones(columns.wrench.cols()), columns.wrench, -w / size);
  if (found.status == ProgramStatus::kInfeasible) {
    result.status = GripForceStatus::kNotHoldable;
    // What of the load no contact force meets: no contact pushes against it.
    const ConeProjection met = project_on_cone(columns.wrench, -w / size);
    result.escape = escape_motion(contacts, -met.rest, scale, reference);
    result.message = "the load can't be held however hard the hand presses: the product moves " +
                     motion_words(result.escape.translation, scale * result.escape.rotation) +
                     ", where no contact pushes back";
    return result;
  }
  if (found.status != ProgramStatus::kOptimal) {
    result.status = GripForceStatus::kNotConverged;
    result.message = "the search for the least grip force did not end";
    return result;
  }
  result.status = GripForceStatus::kHeld;
  result.sum = size * found.value;
  for (Eigen::Index j = 0; j < columns.wrench.cols(); ++j) {
    result.force[columns.contact[j]] += size * found.x[j] * columns.wrench.col(j).head<3>();
  }
  result.balance_error = (columns.wrench * found.x + w / size).norm();
  result.factor = least_factor(contacts, groups, w);
  return result;
}

StabilityResult assess_stability(const hand::Hand& hand, const contact::ContactResult& contact,
                                 const Vec3& mass_centre, const StabilityOptions& options) {
  options.check();
  if (!mass_centre.allFinite()) throw UsageError("stability: the centre of mass is not finite");
  StabilityResult result;
  result.reference = mass_centre;
  result.friction = options.reduction.friction;
  result.wrench = options.wrench;
  result.contacts = reduce_contact(hand, contact, options.reduction);
  WrenchOptions wrench = options.wrench;
  wrench.body.with_volume = false;
  result.l1 = measure_wrench_space(result.contacts, mass_centre, WrenchNorm::kL1, wrench);
  wrench.torque_scale = result.l1.torque_scale;
  if (options.with_volume) {
    ReductionOptions fewer = options.reduction;
    fewer.max_contacts = std::min(fewer.max_contacts, options.volume_contacts);
    result.volume_contacts = reduce_contact(hand, contact, fewer);
    wrench.body.with_volume = true;
    result.volume =
        measure_wrench_space(result.volume_contacts, mass_centre, WrenchNorm::kL1, wrench);
    wrench.body.with_volume = false;
  }
  if (options.with_linf) {
    result.linf = measure_wrench_space(result.contacts, mass_centre, WrenchNorm::kLinf, wrench);
  }
  if (options.load) {
    result.grip = least_grip_force(result.contacts, contact::wrench_of(*options.load, mass_centre),
                                   mass_centre, options.wrench);
  }
  result.message = closure_message(result);
  return result;
}

}  // namespace palmar::grasp
