// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/friction_arguments.h"

#include <fmt/format.h>

#include "palmar/core/error.h"
#include "palmar/product/mass.h"
#include "palmar/report/page/friction_section.h"

namespace palmar::cli {
namespace {

constexpr double kStandardGravity = 9.80665;  // m/s^2; CGPM 1901

double positive(const char* option, double value, const char* unit) {
  if (value > 0.0 && value <= 1e4) return value;
  throw UsageError(
      fmt::format("{} is {}; more than 0 and at most 10000 {} is required", option, value, unit));
}

}  // namespace

void FrictionArguments::add_to(CLI::App& verb) {
  verb.add_option("--friction", coefficient,
                  "Coefficient of friction of skin on the product (0.3 to 1.2 is usual): tells "
                  "whether the hand holds the load; default: 0.5 while the grasp comes to rest and "
                  "for a given load. 0: none");
  CLI::Option* mass = verb.add_option("--mass-kg", mass_kg, "Mass of the product, kg");
  CLI::Option* weight =
      verb.add_option("--weight-n", weight_n, "Weight of the product instead of its mass, N")
          ->excludes(mass);
  verb.add_option("--density-g-cm3", density,
                  "Density of the product, solid throughout, instead of its mass, g/cm3")
      ->excludes(mass)
      ->excludes(weight);
  verb.add_option("--gravity", gravity,
                  "Direction of gravity in the product's frame, x,y,z; default 0,0,-1");
  verb.add_option("--mass-at", mass_at,
                  "Centre of mass, x,y,z in mm; default: as if the product were solid throughout");
  verb.add_option("--load-n", load_n, "Further force on the product, x,y,z in N");
  verb.add_option("--torque-n-mm", torque_n_mm, "Further torque on the product, x,y,z in N mm");
  verb.add_option("--load-at", load_at,
                  "Where --load-n acts, x,y,z in mm; default: at the centre of mass");
}

FrictionOptions FrictionArguments::options() const {
  FrictionOptions result;
  if (coefficient && !(*coefficient >= 0.0 && *coefficient <= 5.0)) {
    throw UsageError(fmt::format("--friction is {}; 0 to 5 is required", *coefficient));
  }
  result.coefficient = coefficient.value_or(has_load() ? kUsualFriction : 0.0);
  if (density) positive("--density-g-cm3", *density, "g/cm3");
  ProductLoad& load = result.load;
  if (mass_kg) load.weight = kStandardGravity * positive("--mass-kg", *mass_kg, "kg");
  if (weight_n) load.weight = positive("--weight-n", *weight_n, "N");
  if (!gravity.empty()) load.gravity = parse_vector("--gravity", gravity);
  if (load.gravity.isZero(0.0)) throw UsageError("--gravity is 0,0,0; a direction is required");
  if (!mass_at.empty()) load.mass_centre = parse_vector("--mass-at", mass_at);
  if (!load_n.empty()) load.force = parse_vector("--load-n", load_n);
  if (!torque_n_mm.empty()) load.torque = parse_vector("--torque-n-mm", torque_n_mm);
  if (!load_at.empty()) load.force_at = parse_vector("--load-at", load_at);
  result.check();
  return result;
}

bool FrictionArguments::has_load() const {
  return mass_kg || weight_n || density || !load_n.empty() || !torque_n_mm.empty();
}

FrictionOptions FrictionArguments::options_for(const Product& product) const {
  FrictionOptions result = options();
  const bool has_weight = mass_kg || weight_n || density;
  if (density || (has_weight && mass_at.empty())) {
    const MassProperties solid = mass_properties(product);
    if (density) result.load.weight = weight_of(solid.volume, *density);
  }
  return result;
}

std::string friction_text(const Hand& hand, const Assessment& assessment) {
  const FrictionResult& friction = assessment.friction;
  if (friction.status == FrictionStatus::kOff) return {};
  std::string text =
      fmt::format("friction: {}\n{}\n",
                  friction.status == FrictionStatus::kSlips ? "SLIPS" : name_of(friction.status),
                  friction_verdict(hand, assessment));
  if (friction.regions.empty()) return text;
  text +=
      "region           normal    at most   friction   slip margin   slips\n"
      "                      N          N          N             %       % of area\n";
  for (const RegionFriction& one : friction.regions) {
    text += fmt::format("{:<16} {:6.2f} {:10.2f} {:10.2f} {:13.0f} {:7.0f}\n", name_of(one.region),
                        one.normal_force, one.limit, one.force.norm(), 100.0 * one.margin,
                        100.0 * one.slipping_share);
  }
  return text;
}

}  // namespace palmar::cli
