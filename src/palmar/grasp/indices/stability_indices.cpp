// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "palmar/core/text.h"
#include "palmar/grasp/indices/stability.h"

namespace palmar::grasp {
namespace {

constexpr const char* kGroup = "stability";
// With 16 contacts in place of 24 epsilon changes by up to half, the volume by more
// (docs/method/indices.md).
constexpr double kEpsilonToldApart = 0.5;
constexpr double kVolumeToldApart = 0.9;

GraspIndex row(const std::string& key, const std::string& name, const std::string& unit,
               Better better, const std::string& definition, const std::string& source) {
  GraspIndex index;
  index.key = key;
  index.name = name;
  index.group = kGroup;
  index.unit = unit;
  index.better = better;
  index.lowest = 0.0;
  index.definition = definition;
  index.source = source;
  return index;
}

std::string setting_words(const StabilityResult& result,
                          const std::vector<GraspContact>& contacts) {
  return std::to_string(contacts.size()) + " contacts, friction " +
         significant(result.friction, 4) + ", cones of " + std::to_string(result.wrench.sides) +
         " sides, moments divided by " + significant(result.l1.torque_scale, 4) + " mm";
}

void add_epsilon(const WrenchSpace<6>& space, const StabilityResult& result, GraspIndices& rows) {
  const bool is_l1 = space.norm == WrenchNorm::kL1;
  GraspIndex index = row(
      is_l1 ? "epsilon_l1" : "epsilon_linf",
      is_l1 ? "largest disturbance held, any direction, one force budget"
            : "largest disturbance held, any direction, each contact on its own",
      "", Better::kUp,
      is_l1 ? "epsilon, L1: distance from 0 to the boundary of the grasp wrench space of normal "
              "forces that sum to 1; the disturbance is a force, or a moment over the torque scale"
            : "epsilon, L-infinity: the same with every normal force at most 1",
      "Ferrari and Canny 1992");
  index.told_apart = kEpsilonToldApart;
  if (is_l1) {
    index.highest = std::sqrt(1.0 + result.friction * result.friction);
  } else {
    index.highest = static_cast<double>(result.contacts.size()) *
                    std::sqrt(1.0 + result.friction * result.friction);
  }
  if (space.status != ClosureStatus::kNoContact) index.value = space.epsilon;
  index.remark = space.status == ClosureStatus::kNoContact ? "nothing is touched"
                                                           : setting_words(result, result.contacts);
  if (space.status == ClosureStatus::kForceClosure && !space.body.is_distance_exact) {
    index.remark += "; proven lower bound " + significant(space.body.distance_lower, 4);
  }
  rows.push_back(index);
}

void add_grip(const GripForce& grip, GraspIndices& rows) {
  GraspIndex sum = row(
      "least_normal_force_n", "least sum of normal forces that holds the load", "N", Better::kDown,
      "linear program: least sum of normal forces, shared out as suits the load, whose "
      "friction cones balance weight, force and torque",
      "Kerr and Roth 1986");
  GraspIndex factor =
      row("least_force_factor", "least share of the present grip that holds the load", "",
          Better::kDown,
          "linear program: least factor on the normal forces found, their shares kept, whose "
          "friction cones balance weight, force and torque; below 1 the present grip holds it",
          "Kerr and Roth 1986");
  if (grip.status == GripForceStatus::kHeld || grip.status == GripForceStatus::kNoLoad) {
    sum.value = grip.sum;
    factor.value = grip.factor;
    if (!grip.factor) {
      factor.remark = "no factor on the pressures found balances the load: their shares don't suit";
    }
    if (grip.status == GripForceStatus::kNoLoad) sum.remark = factor.remark = "nothing to hold";
  } else {
    sum.remark = factor.remark = grip.message;
  }
  rows.push_back(sum);
  rows.push_back(factor);
}

}  // namespace

GraspIndices to_indices(const StabilityResult& result) {
  GraspIndices rows;
  GraspIndex closure =
      row("force_closure", "force closure", "", Better::kUp,
          "1 if forces within the friction cones can meet any small disturbance, else 0: 0 is "
          "strictly inside the grasp wrench space, which spans all six dimensions",
          "Ferrari and Canny 1992");
  closure.highest = 1.0;
  if (result.l1.status == ClosureStatus::kNoContact) {
    closure.remark = result.message;
  } else {
    closure.value = result.l1.status == ClosureStatus::kForceClosure ? 1.0 : 0.0;
    closure.remark = result.message;
  }
  rows.push_back(closure);
  add_epsilon(result.l1, result, rows);
  if (result.linf.norm == WrenchNorm::kLinf) add_epsilon(result.linf, result, rows);
  if (result.volume) {
    const BodyMeasures<6>& body = result.volume->body;
    GraspIndex volume =
        row("wrench_volume_l1", "volume of the wrenches that the grasp can meet", "", Better::kUp,
            "volume of the grasp wrench space, L1 (six dimensions, normal forces "
            "that sum to 1), with 0 in its hull; compare only at equal settings",
            "Ferrari and Canny 1992; Miller and Allen 1999");
    volume.told_apart = kVolumeToldApart;
    if (result.l1.status == ClosureStatus::kNoContact) {
      volume.remark = "nothing is touched";
    } else {
      volume.value = body.volume;
      volume.remark = setting_words(result, result.volume_contacts);
      if (!body.is_volume_exact) {
        volume.remark += "; lower bound, upper bound " + significant(body.volume_upper, 4);
      }
    }
    rows.push_back(volume);
  }
  if (result.grip) add_grip(*result.grip, rows);
  return rows;
}

}  // namespace palmar::grasp
