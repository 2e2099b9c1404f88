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

std::string_view name_of(HandTask task) {
  switch (task) {
    case HandTask::kUsual:
      return "usual";
    case HandTask::kSqueeze:
      return "squeeze";
    case HandTask::kHold:
      return "hold";
    case HandTask::kCarry:
      return "carry";
    case HandTask::kTurn:
      return "turn";
  }
  return "unknown";
}

HandTask hand_task_named(std::string_view name) {
  std::string names;
  for (const HandTask task : kHandTasks) {
    if (name == name_of(task)) return task;
    names += fmt::format("{}{}",
                         task == kHandTasks.front()  ? ""
                         : task == kHandTasks.back() ? " or "
                                                     : ", ",
                         name_of(task));
  }
  throw UsageError(fmt::format("setting \"task\" is \"{}\"; {} is required", name, names));
}

double usual_grip_strength() {
  return 0.5 * (*grip_strength(Sex::kFemale, kUsualAge) + *grip_strength(Sex::kMale, kUsualAge));
}

double holding_grip_force(double load, double friction) {
  return friction > 0.0 ? kGripMargin * load / (2.0 * friction) : 0.0;
}

void HeaviestLoad::add(const product::Product& one, const contact::ProductLoad& load) {
  const std::optional<double> estimate = load.weight > 0.0 ? std::nullopt : estimated_weight(one);
  const Vec3 sum = estimate.value_or(load.weight) * load.down() + load.force;
  if (!(sum.norm() > force)) return;
  force = sum.norm();
  product = one.name;
  is_estimated = estimate.has_value();
}

double ShareOfStrength::reached(Grip grip) const { return strength * strength_share(grip); }

void ShareOfStrength::take_least(double friction, const HeaviestLoad& heaviest) {
  least = holding_grip_force(heaviest.force, friction);
  why_least = fmt::format(
      "the {:.1f} N of {}{} by friction with a margin of {:.0f} % (Westling & Johansson 1984)",
      heaviest.force, heaviest.product,
      heaviest.is_estimated
          ? fmt::format(" (no mass is given; estimated as solid, {:g} g/cm3)", kAssumedDensity)
          : "",
      100.0 * (kGripMargin - 1.0));
}

double ShareOfStrength::force(Grip grip) const {
  const double of_strength = share * reached(grip);
  if (grip == Grip::kFingerPush) return of_strength;
  const double held = std::min(least, reached(grip));
  return holds_only ? std::max(kLightestHold, held) : std::max(of_strength, held);
}

bool ShareOfStrength::is_raised(Grip grip) const {
  return !holds_only && force(grip) > share * reached(grip);
}

std::string ShareOfStrength::words(Grip grip) const {
  if (holds_only && grip != Grip::kFingerPush) {
    return least < kLightestHold ? "as even the lightest thing is held; its weight asks for less"
                                 : "what holds " + why_least;
  }
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
  usual.take_least(friction, heaviest);
  return usual;
}

}  // namespace palmar::grasp
