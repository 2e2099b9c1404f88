// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/rest/usual_task.h"

#include <limits>

#include "palmar/grasp/power/grip_choice.h"
#include "palmar/grasp/power/section_stack.h"

namespace palmar::grasp {
namespace {

constexpr double kSectionSpacing = 3.0;  // mm

/// Width of the section at the grip, mm.
double width_at_grip(const product::Product& product, const Grasp& grasp) {
  const double station = grasp.grip_axis.dot(grasp.grip_point);
  double width = 0.0, nearest = std::numeric_limits<double>::infinity();
  for (const Section& section : sections_along(product.mesh, grasp.grip_axis, kSectionSpacing)) {
    const double along = section.station - station;
    for (const SectionOutline& outline : section.outlines) {
      const Vec3 beside = outline.centroid - grasp.grip_point;
      const double away = beside.squaredNorm() + along * along;
      if (away >= nearest) continue;
      nearest = away;
      width = outline.width;
    }
  }
  return width;
}

}  // namespace

std::optional<UsualTask> usual_task(const product::Product& product, const Grasp& grasp,
                                    double hand_length) {
  switch (grasp.grip) {
    case Grip::kMediumWrap:
    case Grip::kSmallDiameter:
      return width_at_grip(product, grasp) > kLargestClosed * hand_length ? UsualTask::kHold
                                                                          : UsualTask::kGrip;
    case Grip::kWritingTripod:
    case Grip::kDistalType:
      return UsualTask::kGrip;
    case Grip::kFixedHook:
    case Grip::kRestingHand:
    case Grip::kFlatHand:
    case Grip::kFingerPush:
      return std::nullopt;
    default:
      return UsualTask::kHold;
  }
}

UsualTask task_of_all(std::span<const std::optional<UsualTask>> tasks) {
  bool is_any_held = false;
  for (const std::optional<UsualTask>& task : tasks) {
    if (task == UsualTask::kGrip) return UsualTask::kGrip;
    is_any_held = is_any_held || task == UsualTask::kHold;
  }
  return is_any_held ? UsualTask::kHold : UsualTask::kGrip;
}

}  // namespace palmar::grasp
