// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"
#include "palmar/effort/effort.h"

namespace palmar::effort {
namespace {

constexpr const char* kMethod =
    "Crowninshield & Brand 1981; tendons: An et al. 1979, Synek et al. "
    "2019, Mirakhorlo et al. 2016";

struct HardestMuscle {
  double activation = 0.0, force = 0.0;
  std::string name;
};

HardestMuscle hardest_muscle(const EffortResult& effort) {
  HardestMuscle hardest;
  for (const DigitEffort& digit : effort.digits) {
    for (const TendonLoad& load : digit.tendons) {
      if (!hardest.name.empty() && load.activation <= hardest.activation) continue;
      hardest = {load.activation, load.force,
                 std::string(name_of(digit.finger)) + " " +
                     std::string(hand::anatomical_name_of(load.tendon))};
    }
  }
  for (int i = 0; effort.wrist && i < hand::kWristMuscleCount; ++i) {
    const auto muscle = static_cast<hand::WristMuscle>(i);
    if (effort.wrist->activation(muscle) <= hardest.activation) continue;
    hardest = {effort.wrist->activation(muscle), effort.wrist->force[palmar::index_of(muscle)],
               std::string(hand::anatomical_name_of(muscle))};
  }
  return hardest;
}

}  // namespace

grasp::GraspIndices effort_indices(const EffortResult& effort) {
  const bool is_known =
      effort.status != EffortStatus::kNoLoad && effort.status != EffortStatus::kNotConverged;
  std::string why;
  if (effort.status == EffortStatus::kNoLoad) why = "no digit touches the product";
  if (effort.status != EffortStatus::kHeld && !effort.message.empty()) why = effort.message;
  const std::string loads =
      effort.with_friction ? "pressure and friction" : "pressure alone, no friction";
  const auto remark = [&](const std::string& own) {
    std::string text = own;
    for (const std::string& part : {why, is_known ? loads : std::string()}) {
      if (!part.empty()) text += (text.empty() ? "" : "; ") + part;
    }
    return text;
  };

  const HardestMuscle hardest = hardest_muscle(effort);
  double missing = 0.0, squares = 0.0;
  int active = 0;
  for (const DigitEffort& digit : effort.digits) {
    for (const JointEffort& joint : digit.joints) {
      missing = std::max(missing, std::abs(joint.missing));
    }
    if (digit.status == EffortStatus::kNoLoad) continue;
    for (const TendonLoad& load : digit.tendons) {
      squares += load.activation * load.activation;
      ++active;
    }
  }
  double wrist_force = 0.0;
  for (int i = 0; effort.wrist && i < hand::kWristMuscleCount; ++i) {
    const auto muscle = static_cast<hand::WristMuscle>(i);
    missing = std::max(missing, std::abs(effort.wrist->missing));
    squares += effort.wrist->activation(muscle) * effort.wrist->activation(muscle);
    wrist_force += effort.wrist->force[palmar::index_of(muscle)];
    ++active;
  }
  const auto value = [&](double v) { return is_known ? std::optional<double>(v) : std::nullopt; };
  const std::string which = is_known && !hardest.name.empty()
                                ? "hardest: " + hardest.name + ", " +
                                      std::to_string(static_cast<int>(std::lround(hardest.force))) +
                                      " N"
                                : "";

  const auto index = [&](const char* key, const char* name, const char* unit,
                         std::optional<double> of, const char* definition,
                         const std::string& own_remark = "") {
    grasp::GraspIndex result;
    result.key = key;
    result.name = name;
    result.group = "effort";
    result.value = of;
    result.unit = unit;
    result.lowest = 0.0;
    result.better = grasp::Better::kDown;
    result.definition = definition;
    result.source = kMethod;
    result.remark = remark(own_remark);
    return result;
  };
  grasp::GraspIndex largest =
      index("largest_activation", "hardest working muscle", "", value(hardest.activation),
            "largest share of its strength that any muscle of the hand or the wrist gives (min sum "
            "(F/PCSA)^n)",
            which);
  grasp::GraspIndex mean = index(
      "mean_activation", "muscles on average", "",
      value(active > 0 ? std::sqrt(squares / active) : 0.0),
      "root mean square of the activations of all muscles of the loaded digits and the wrist");
  largest.highest = 1.0;
  mean.highest = 1.0;
  const auto per_force = is_known && effort.contact_force > 0.0
                             ? std::optional<double>(effort.tendon_force / effort.contact_force)
                             : std::nullopt;
  return {
      largest, mean,
      index("tendon_force_n", "sum of all tendon forces", "N",
            value(effort.tendon_force + wrist_force),
            "sum of the forces of all muscles of fingers, thumb and wrist"),
      index("tendon_force_per_contact_force", "tendon force per contact force", "", per_force,
            "sum of the digits' tendon forces over the sum of contact forces on the digits: the "
            "price of "
            "a newton of grip in this posture"),
      index("missing_moment_n_mm", "largest missing joint moment", "N mm", value(missing),
            "largest moment about a joint axis that the muscles would have to give beyond their "
            "strength; 0: the load can be held")};
}

}  // namespace palmar::effort
