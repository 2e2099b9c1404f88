// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/ease.h"

#include <cmath>
#include <cstdio>

#include "palmar/geometry/degrees.h"

namespace palmar::grasp {
namespace {

std::string number(double value, const char* format) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

GraspIndex row(const std::string& key, const std::string& name, const std::string& unit,
               double value) {
  GraspIndex index;
  index.key = key;
  index.name = name;
  index.group = "ease";
  index.unit = unit;
  index.value = value;
  index.lowest = 0.0;
  index.better = Better::kDown;
  return index;
}

}  // namespace

EaseResult assess_ease(const hand::Skeleton& skeleton, const hand::Posture& posture,
                       const CoordinationBasis& basis) {
  EaseResult result;
  result.basis = basis;
  result.coordination = distance_to(basis, posture);
  double squares = 0.0;
  int counted = 0;
  for (int k = 0; k < kDigitDofCount; ++k) {
    const hand::JointDof& dof = skeleton.dof(digit_dof(k));
    const double half = 0.5 * (dof.upper - dof.lower);
    if (!(half > 0.5 * geometry::kDegree)) continue;
    const double angle = posture[dof.dof];
    const double share = std::abs(angle - 0.5 * (dof.lower + dof.upper)) / half;
    result.from_middle[k] = share;
    squares += share * share;
    ++counted;
    if (share > result.farthest_share) {
      result.farthest_share = share;
      result.farthest = dof.dof;
    }
    if (angle < dof.lower + geometry::kDegree || angle > dof.upper - geometry::kDegree)
      ++result.at_limit;
  }
  if (counted > 0) result.from_middle_rms = std::sqrt(squares / counted);
  return result;
}

GraspIndices to_indices(const EaseResult& result) {
  const CoordinationBasis& basis = result.basis;
  const std::string what_basis =
      std::to_string(basis.retained) + " components carry " +
      number(100.0 * basis.retained_share, "%.0f") + " % of the variance of " +
      (basis.postures > 0 ? std::to_string(basis.postures) + " postures" : "the built-in basis");
  GraspIndices rows;
  GraspIndex distance = row("coordination_distance", "distance from natural coordination", "sd",
                            result.coordination.distance);
  distance.definition =
      "Mahalanobis distance of the digits' joint angles from the mean of natural grasps, within "
      "the "
      "principal components that carry 90 % of the variance";
  distance.source = basis.source;
  distance.remark = what_basis + "; half of such postures are within " +
                    number(result.coordination.median, "%.2f");
  rows.push_back(distance);
  GraspIndex outside = row("coordination_residual_deg", "departure from natural coordination",
                           "deg", result.coordination.outside / geometry::kDegree);
  outside.definition =
      "root mean square, over 20 joint angles, of what those principal components can't describe";
  outside.source = basis.source;
  outside.remark = what_basis;
  rows.push_back(outside);
  GraspIndex middle = row("mid_range_distance", "distance of the joints from mid-range", "",
                          result.from_middle_rms);
  middle.highest = 1.0;
  middle.definition =
      "root mean square, over the joint angles, of |angle - middle| / half the range of motion";
  middle.source = "ranges of this hand's joints; mid-range: Endo et al. (Digital Hand)";
  rows.push_back(middle);
  GraspIndex farthest = row("mid_range_distance_largest", "joint nearest to an end of its range",
                            "", result.farthest_share);
  farthest.highest = 1.0;
  farthest.definition = "largest |angle - middle| / half the range of motion of any joint angle";
  farthest.source = middle.source;
  farthest.remark = std::string(name_of(result.farthest));
  rows.push_back(farthest);
  GraspIndex limit = row("joints_at_limit", "joint angles at an end of their range", "",
                         static_cast<double>(result.at_limit));
  limit.highest = kDigitDofCount;
  limit.definition = "number of joint angles within 1 deg of an end of their range of motion";
  limit.source = middle.source;
  rows.push_back(limit);
  return rows;
}

}  // namespace palmar::grasp
