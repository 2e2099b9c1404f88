// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/task_force.h"

#include <fmt/format.h>

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/product/mass.h"

namespace palmar::grasp {
namespace {

std::optional<double> estimated_weight(const product::Product& product) {
  try {
    return product::weight_of(product::mass_properties(product).volume, kAssumedDensity);
  } catch (const InputError&) {
    return std::nullopt;  // open, or a sheet: nothing to estimate from
  }
}

}  // namespace

double usual_grip_strength() {
  return 0.5 * (*grip_strength(Sex::kFemale, kUsualAge) + *grip_strength(Sex::kMale, kUsualAge));
}

double holding_grip_force(double load, double friction) {
  return friction > 0.0 ? kGripMargin * load / (2.0 * friction) : 0.0;
}

void HeaviestLoad::add(const product::Product& one, const contact::ProductLoad& load) {
  const std::optional<double> estimate = load.weight > 0.0 ? std::nullopt : estimated_weight(one);
  const Vec3 sum = estimate.value_or(load.weight) * load.gravity.normalized() + load.force;
  if (!(sum.norm() > force)) return;
  force = sum.norm();
  product = one.name;
  is_estimated = estimate.has_value();
}

double ShareOfStrength::reached(Grip grip) const { return strength * strength_share(grip); }

double ShareOfStrength::force(Grip grip) const {
  return std::max(share * reached(grip), std::min(least, reached(grip)));
}

bool ShareOfStrength::is_raised(Grip grip) const { return force(grip) > share * reached(grip); }

std::string ShareOfStrength::words(Grip grip) const {
  if (is_raised(grip)) {
    return fmt::format("raised from {:.0f} N to hold {}", share * reached(grip), why_least);
  }
  const std::string of = whose.empty() ? "" : " of " + whose;
  if (strength_share(grip) < 1.0) {
    return fmt::format(
        "{:g} % of the {:.0f} N of such a pinch (Mathiowetz et al. 1985) at a grip "
        "strength{} of {:.0f} N",
        100.0 * share, reached(grip), of, strength);
  }
  return fmt::format("{:g} % of what {} reach on a dynamometer, {:.0f} N", 100.0 * share,
                     whose.empty() ? "people" : whose, strength);
}

std::string usual_people() {
  return fmt::format("women and men of {:g} years (mean; Steiber 2016)", kUsualAge);
}

ShareOfStrength usual_share(double friction, const HeaviestLoad& heaviest) {
  ShareOfStrength usual;
  usual.strength = usual_grip_strength();
  usual.whose = usual_people();
  usual.least = holding_grip_force(heaviest.force, friction);
  usual.why_least = fmt::format(
      "the {:.1f} N of {}{} by friction with a margin of {:.0f} % (Westling & Johansson 1984)",
      heaviest.force, heaviest.product,
      heaviest.is_estimated
          ? fmt::format(" (no mass is given; estimated as solid, {:g} g/cm3)", kAssumedDensity)
          : "",
      100.0 * (kGripMargin - 1.0));
  return usual;
}

}  // namespace palmar::grasp
