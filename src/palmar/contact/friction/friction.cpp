// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/friction/friction.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/contact/contact_normals.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/core/enum_index.h"
#include "palmar/core/error.h"
#include "palmar/geometry/rotation.h"

namespace palmar::contact {
namespace {

/// Vertices with less than this share of the largest vertex force hold nothing worth reporting.
constexpr double kLeastForce = 1e-6;
/// Mobilised friction from which a patch counts as slipping; the interior-point method ends within
/// 1e-6 of the limit.
constexpr double kSlipping = 0.9999;

void require_finite(const Vec3& v, const std::string& name, const char* unit) {
  if (v.allFinite()) return;
  throw UsageError("friction: " + name + " is " + std::to_string(v.x()) + ", " +
                   std::to_string(v.y()) + ", " + std::to_string(v.z()) + " " + unit +
                   "; finite values are required");
}

/// How the skin round a vertex was turned from rest to its contact: the rotation that fits its
/// neighbours best, then on the shortest way until its normal faces the product.
Quat turn_of_skin(const SkinGeometry& skin, const std::vector<Vec3>& posed, int v,
                  const Vec3& product_normal) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int w : skin.neighbours(v)) {
    const Vec3 rest = skin.position[w] - skin.position[v];
    const Vec3 now = posed[w] - posed[v];
    sum += now * rest.transpose();
  }
  const Quat posed_from_rest(geometry::fit_rotation(sum));
  const Quat onto_product =
      geometry::shortest_rotation(posed_from_rest * skin.normal[v], -product_normal);
  return (onto_product * posed_from_rest).normalized();
}

/// Fingers and the palm are distinguished: 0 the palm, 1 + finger else.
int body_of(hand::Segment segment) {
  const auto finger = hand::finger_of(segment);
  return finger ? 1 + static_cast<int>(*finger) : 0;
}

std::vector<RubbingPatch> rubbing_patches(const PreparedHand::Impl& prepared,
                                          const ContactResult& contact,
                                          const geometry::DistanceField& product,
                                          const std::vector<int>& loaded, double coefficient) {
  std::array<double, hand::kRegionCount> modulus{};
  for (const RegionContact& region : contact.regions) {
    modulus[index_of(region.region)] = region.shear_modulus;
  }
  const std::vector<Vec3> normals = contact_normals(contact, product, loaded);
  std::vector<RubbingPatch> patches;
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const int v = loaded[k];
    patches.push_back(
        {.position = contact.deformed[v],
         .normal = normals[k],
         .limit = coefficient * contact.force[v],
         .radius = prepared.skin.radius[v],
         .shear_modulus = modulus[index_of(prepared.hand->region[v])],
         .rest = prepared.skin.position[v],
         .contact_from_rest = turn_of_skin(prepared.skin, contact.undeformed, v, normals[k]),
         .body = body_of(prepared.hand->segment[v])});
  }
  return patches;
}

/// The same motion expressed for another point.
SmallMotion about(const SmallMotion& motion, const Vec3& point) {
  return {motion.at(point), motion.rotation, point};
}

void add_regions(const PreparedHand::Impl& prepared, const std::vector<int>& loaded,
                 const std::vector<RubbingPatch>& patches, double coefficient,
                 const ContactResult& contact, FrictionResult& result) {
  std::array<RegionFriction, hand::kRegionCount> part{};
  std::array<double, hand::kRegionCount> used{}, area{}, slipping{};
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const int v = loaded[k];
    const std::size_t r = index_of(prepared.hand->region[v]);
    part[r].limit += patches[k].limit;
    part[r].force += result.force[v];
    used[r] += result.force[v].norm();
    const double pressed = contact.force[v] / contact.pressure[v];
    area[r] += pressed;
    if (result.mobilised[v] >= kSlipping) slipping[r] += pressed;
  }
  double all = 0.0, all_slipping = 0.0;
  for (std::size_t r = 0; r < part.size(); ++r) {
    if (!(part[r].limit > 0.0)) continue;
    part[r].region = static_cast<hand::Region>(r);
    part[r].normal_force = part[r].limit / coefficient;
    part[r].margin = std::clamp(1.0 - used[r] / part[r].limit, 0.0, 1.0);
    part[r].slipping_share = slipping[r] / area[r];
    all += area[r];
    all_slipping += slipping[r];
    result.regions.push_back(part[r]);
  }
  if (all > 0.0) result.slipping_share = all_slipping / all;
}

}  // namespace

void FrictionOptions::check() const {
  if (!(coefficient >= 0.0 && coefficient <= 5.0)) {
    throw UsageError("friction: coefficient is " + std::to_string(coefficient) +
                     "; more than 0 and at most 5 is required (0: off)");
  }
  if (!(load.weight >= 0.0 && load.weight <= 1e5)) {
    throw UsageError("friction: weight is " + std::to_string(load.weight) +
                     " N; 0 to 100000 N is required");
  }
  if (load.gravity) require_finite(*load.gravity, "gravity", "(direction)");
  require_finite(load.force, "force", "N");
  require_finite(load.torque, "torque", "N mm");
  constexpr double kMostForce = 1e5, kMostTorque = 1e7, kFarthest = 1e4;
  const auto require_below = [](double size, double most, const char* name, const char* unit) {
    if (size <= most) return;
    char text[160];
    std::snprintf(text, sizeof text, "friction: %s is %.4g %s; at most %g %s is allowed", name,
                  size, unit, most, unit);
    throw UsageError(text);
  };
  require_below(load.force.norm(), kMostForce, "force", "N");
  require_below(load.torque.norm(), kMostTorque, "torque", "N mm");
  for (const auto& point : {load.mass_centre, load.force_at}) {
    if (point) require_below(point->norm(), kFarthest, "a point of the load", "mm from the origin");
  }
  if (load.mass_centre) require_finite(*load.mass_centre, "mass_centre", "mm");
  if (load.force_at) require_finite(*load.force_at, "force_at", "mm");
  if (load.weight > 0.0 && load.gravity && !(load.gravity->norm() > 0.0)) {
    throw UsageError("friction: gravity is 0, 0, 0; a direction is required");
  }
}

Wrench wrench_of(const ProductLoad& load, const Vec3& mass_centre) {
  Wrench wrench;
  if (load.weight > 0.0) {
    wrench.force = load.weight * load.down();
    wrench.moment = load.mass_centre.value_or(mass_centre).cross(wrench.force);
  }
  wrench.moment +=
      load.force_at.value_or(load.mass_centre.value_or(mass_centre)).cross(load.force) +
      load.torque;
  wrench.force += load.force;
  return wrench;
}

std::string_view name_of(FrictionStatus status) {
  switch (status) {
    case FrictionStatus::kOff:
      return "off";
    case FrictionStatus::kHeld:
      return "held";
    case FrictionStatus::kSlips:
      return "slips";
    case FrictionStatus::kNoContact:
      return "no_contact";
    case FrictionStatus::kNotConverged:
      return "not_converged";
  }
  return "unknown";
}

FrictionResult solve_friction(const PreparedHand& hand, const ContactResult& contact,
                              const geometry::DistanceField& product, const Vec3& mass_centre,
                              const FrictionOptions& options) {
  constexpr double kBarely = 1e-6;  // a factor this near to 1 is at the limit
  options.check();
  const PreparedHand::Impl& prepared = hand.impl();
  const std::size_t n = prepared.hand->skin.vertices.size();
  FrictionResult result;
  result.force.assign(n, Vec3::Zero());
  result.mobilised.assign(n, 0.0);
  if (!options.is_on()) return result;
  result.mass_centre = options.load.mass_centre.value_or(mass_centre);
  result.load = wrench_of(options.load, mass_centre);

  std::vector<int> loaded;
  double largest = 0.0;
  for (const double p : contact.force) largest = std::max(largest, p);
  for (std::size_t v = 0; v < contact.force.size(); ++v) {
    if (contact.force[v] > kLeastForce * largest) loaded.push_back(static_cast<int>(v));
  }
  if (loaded.empty()) {
    result.status = FrictionStatus::kNoContact;
    result.message = "nothing is touched, so there is no friction";
    return result;
  }
  const std::vector<RubbingPatch> patches =
      rubbing_patches(prepared, contact, product, loaded, options.coefficient);
  for (const RubbingPatch& patch : patches) {
    const Vec3 push = -patch.limit / options.coefficient * patch.normal;
    result.grip.force += push;
    result.grip.moment += patch.position.cross(push);
  }

  const HoldingLimit limit = holding_limit(patches, result.load);
  result.iterations = limit.iterations;
  const bool has_load = !result.load.force.isZero(0.0) || !result.load.moment.isZero(0.0);
  if (has_load) result.load_factor = limit.factor;
  result.load_factor_upper = limit.upper_factor;
  result.slip = about(limit.slip, result.mass_centre);
  if (!limit.has_converged) {
    char text[160];
    std::snprintf(text, sizeof text,
                  "what friction can hold is only known to be between %.4g and %.4g times the load",
                  limit.factor, limit.upper_factor);
    result.status = FrictionStatus::kNotConverged;
    result.message = text;
    return result;
  }
  const bool is_held = limit.factor > 1.0 + kBarely;
  result.status = is_held ? FrictionStatus::kHeld : FrictionStatus::kSlips;
  result.margin = is_held && has_load ? 1.0 - 1.0 / limit.factor : (is_held ? 1.0 : 0.0);

  std::vector<Vec3> force = limit.force;
  if (is_held) {
    StickSlip answer = solve_stick_slip(patches, result.load, limit);
    result.iterations += answer.iterations;
    if (answer.has_converged) {
      force = std::move(answer.force);
      result.motion = about(answer.motion, result.mass_centre);
    } else {
      // Still a proof that the load is held, only not how.
      for (Vec3& t : force) t /= limit.factor;
      result.message =
          "stick and slip of the skin were not found; the map shows one way to hold "
          "the load, and the motion is left out";
    }
    result.balance_error = answer.balance_error;
  }
  for (std::size_t k = 0; k < loaded.size(); ++k) {
    const int v = loaded[k];
    result.force[v] = force[k];
    result.mobilised[v] = std::min(1.0, force[k].norm() / patches[k].limit);
  }
  add_regions(prepared, loaded, patches, options.coefficient, contact, result);
  return result;
}

}  // namespace palmar::contact
