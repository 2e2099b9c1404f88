// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/friction/friction.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Friction of skin on usual products (Derler & Gerhardt 2012, Tribol Lett 45:1-27: mean 0.46, SD
/// 0.15): what is taken where none is given and some is needed.
inline constexpr double kUsualFriction = 0.5;

/// Friction and load as people know them: the product by its mass, weight or density. Product
/// frame; FrictionOptions is what becomes of it for one product.
struct FrictionSettings {
  std::optional<double> friction;  ///< mu, 0 to 5; unset: kUsualFriction under a load, else none
  // At most one of the three; above 0 and at most 10000.
  std::optional<double> mass;     ///< kg
  std::optional<double> weight;   ///< N
  std::optional<double> density;  ///< g/cm^3, of a product that is solid throughout
  /// Of the hand, upwards, in standard gravities, 0 to 100: the product weighs 1 + that many times
  /// as much. Needs one of the three.
  std::optional<double> acceleration = std::nullopt;
  std::optional<Vec3> gravity = std::nullopt;      ///< direction, not 0; unset: not known, or -z
  std::optional<Vec3> mass_centre = std::nullopt;  ///< mm; unset: as if solid throughout
  std::optional<Vec3> force = std::nullopt;        ///< further force on the product, N
  std::optional<Vec3> torque = std::nullopt;       ///< further torque on the product, N mm
  std::optional<Vec3> force_at = std::nullopt;  ///< where `force` acts, mm; unset: centre of mass

  bool has_weight() const { return mass || weight || density; }
  bool has_load() const { return has_weight() || force || torque; }
  void check() const;  ///< throws UsageError: setting, value, allowed range

  /// Without the weight that a density gives. Throws UsageError as check().
  contact::FrictionOptions options() const;
  /// With it. Throws InputError if the weight or where it acts need a volume that the product
  /// doesn't have.
  contact::FrictionOptions options_for(const product::Product& product) const;
};

}  // namespace palmar::grasp
