// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/friction/friction_problem.h"

namespace palmar::contact {

/// What pulls at the product while it is held; product frame.
struct ProductLoad {
  double weight = 0.0;  ///< N
  /// Direction of the weight; any length but 0. Unset: not known, that of -z where one is needed.
  std::optional<Vec3> gravity = std::nullopt;
  std::optional<Vec3> mass_centre =
      std::nullopt;            ///< mm; unset: that of a solid of uniform density
  Vec3 force = Vec3::Zero();   ///< further force, of a screw or a wall, N
  Vec3 torque = Vec3::Zero();  ///< N mm
  std::optional<Vec3> force_at =
      std::nullopt;  ///< where `force` acts, mm; unset: at the centre of mass

  Vec3 down() const { return gravity.value_or(-Vec3::UnitZ()).normalized(); }
};

struct FrictionOptions {
  double coefficient = 0.0;  ///< mu of skin on product; 0: friction is off
  ProductLoad load;
  bool is_on() const { return coefficient > 0.0; }
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// The load as force and moment about the origin of the product frame.
Wrench wrench_of(const ProductLoad& load, const Vec3& mass_centre);

enum class FrictionStatus {
  kOff,
  kHeld,         ///< friction balances the load
  kSlips,        ///< no friction within mu p can balance it
  kNoContact,    ///< nothing is touched
  kNotConverged  ///< the two bounds of the limit stay apart
};
std::string_view name_of(FrictionStatus status);  ///< "held", "slips", ...

/// Friction in one region of the hand.
struct RegionFriction {
  hand::Region region{};
  double normal_force = 0.0;    ///< N
  double limit = 0.0;           ///< mu times that, N
  Vec3 force = Vec3::Zero();    ///< friction of the skin on the product, vector sum, N
  double margin = 0.0;          ///< 1 - sum |t_i| / limit: share of the friction still unused
  double slipping_share = 0.0;  ///< of the loaded area
};

/// Friction at the contact of a hand with a product. Per-vertex fields follow hand.skin.
struct FrictionResult {
  FrictionStatus status = FrictionStatus::kOff;
  std::string message;
  Vec3 mass_centre = Vec3::Zero();  ///< that was used, mm
  Wrench load;                      ///< about the origin of the product frame
  /// How many times the load could be held; nothing where there is no load. Below 1 it slips.
  std::optional<double> load_factor;
  double load_factor_upper = 0.0;       ///< proven upper bound of it
  double margin = 0.0;                  ///< 1 - 1 / load_factor; 1 without load, 0 where it slips
  std::vector<Vec3> force;              ///< t, of the skin on the product, product frame, N
  std::vector<double> mobilised;        ///< |t| / (mu p), 0 to 1; 0 without contact
  std::vector<RegionFriction> regions;  ///< regions in contact, ascending
  double slipping_share = 0.0;          ///< of the loaded area of the hand
  SmallMotion motion;          ///< of the product until the skin holds it; about mass_centre
  SmallMotion slip;            ///< how it slips at load_factor; its fastest contact moves by 1 mm
  Wrench grip;                 ///< of the contact pressures on the product: not part of the balance
  double balance_error = 0.0;  ///< |load + friction| over the load, recomputed
  int iterations = 0;
};

/// Coulomb friction at the loaded vertices of a solved contact, whose normal forces are kept: what
/// friction adds is the balance of `options.load`. Tractions are those of stick and slip
/// (friction_problem.h) with the shear modulus of each vertex' region; where the load can't be held
/// they are those at the limit load, load_factor times the load. Skin of one finger, or of the
/// palm, moves as one body; fingers don't move each other.
///
/// Directions: the contact normal of a vertex is that along which it was moved to the surface; its
/// neighbours at rest and posed show how it was turned.
///
/// Never throws on a numerical failure: see status. Throws UsageError on bad options.
FrictionResult solve_friction(const PreparedHand& prepared, const ContactResult& contact,
                              const geometry::DistanceField& product, const Vec3& mass_centre,
                              const FrictionOptions& options);

}  // namespace palmar::contact
