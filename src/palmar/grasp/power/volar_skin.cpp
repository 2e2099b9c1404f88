// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/volar_skin.h"

#include <algorithm>
#include <cmath>

#include "palmar/core/enum_index.h"

namespace palmar::grasp {

VolarSkin volar_skin(const hand::Hand& hand, const SkinGroup& group, hand::Finger finger) {
  const hand::Skeleton& skeleton = hand.skeleton;
  VolarSkin result;
  result.share.assign(group.segment.size(), 0.0);
  std::vector<Vec3> skin;
  group.skin.pose(hand::reference_posture(skeleton), skin);
  std::vector<std::pair<hand::Segment, Vec3>> bones;
  for (const std::optional<hand::Segment>& segment : hand::segments_of(finger)) {
    if (segment) bones.emplace_back(*segment, skeleton.joint(hand::joint_of(*segment)).centre);
  }
  for (std::size_t i = 0; i < bones.size(); ++i) {
    const hand::Segment segment = bones[i].first;
    const Vec3 from = bones[i].second;
    const Vec3 to =
        i + 1 < bones.size() ? bones[i + 1].second : skeleton.fingertips[index_of(finger)];
    const double length = (to - from).norm();
    const Vec3 bone = (to - from) / length;
    const auto direction = [&](std::size_t k) -> Vec3 {
      const Vec3 p = skin[k] - from;
      return (p - bone * std::clamp(bone.dot(p), 0.0, length)).normalized();
    };
    const auto is_volar = [&](std::size_t k) {
      return group.segment[k] == segment && is_palmar(group.region[k]);
    };
    Vec3 volar = Vec3::Zero();
    for (std::size_t k = 0; k < skin.size(); ++k) {
      if (is_volar(k)) volar += group.area[k] * direction(k);
    }
    volar.normalize();
    result.direction.push_back(volar);
    double sum = 0.0;
    for (std::size_t k = 0; k < skin.size(); ++k) {
      if (!is_volar(k)) continue;
      result.share[k] = group.area[k] * std::pow(std::max(0.0, direction(k).dot(volar)), 4.0);
      sum += result.share[k];
    }
    for (std::size_t k = 0; k < skin.size() && sum > 0.0; ++k) {
      if (is_volar(k)) result.share[k] /= sum;
    }
  }
  return result;
}

double softened(double x, double far) {
  const double size = std::abs(x);
  return size <= far ? x : std::copysign(std::sqrt(far * (2.0 * size - far)), x);
}

}  // namespace palmar::grasp
