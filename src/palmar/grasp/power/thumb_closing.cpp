// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/thumb_closing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"

namespace palmar {
namespace {

constexpr double kEndFace = 0.7;  // of the normal along the grip axis: not held, but hooked
constexpr double kStraightIp = 50.0 * kDegree;  // ordinary bend of the IP joint
constexpr double kStraightMp = 30.0 * kDegree;  // ... of the MP joint

}  // namespace

Posture ThumbCloser::wrap(const HeldProduct& product, const DepthLimits& limits,
                          const Posture& start, const ThumbPose& goal,
                          std::array<SegmentStop, kSegmentCount>& stops) const {
  const std::vector<Obstacle> fingers = obstacles(start);
  // First out of the palm's plane, clear of the product, then across it.
  Posture target = start;
  target[Dof::kThumbCmcAbduction] = goal.cmc_abduction;
  Posture posture =
      advance_skin((*groups_)[2], product, limits, fingers, start, target, care_).posture;
  target = posture;
  target[Dof::kThumbCmcFlexion] = goal.cmc_flexion;
  posture = advance_skin((*groups_)[2], product, limits, fingers, posture, target, care_).posture;
  const std::array<Segment, 2> segments = {Segment::kThumbProximal, Segment::kThumbDistal};
  for (int level = 0; level < 2; ++level) {
    const Dof dof = flexion_of(Finger::kThumb, level);
    target = posture;
    target[dof] = hand_->skeleton.dof(dof).upper;
    const Advance moved =
        advance_skin((*groups_)[level], product, limits, fingers, posture, target, care_);
    posture = moved.posture;
    SegmentStop& stop = stops[index_of(segments[level])];
    stop.segment = segments[level];
    stop.reason = moved.reason_for(stop.segment);
  }
  return posture;
}

double ThumbCloser::score(const HeldProduct& product, const Posture& posture,
                          const Vec3& grip_axis_in_hand) const {
  const SkinGroup& group = (*groups_)[2];
  const SkinLook look = look_at_skin(group, product, posture);
  const std::vector<DistanceSample>& samples = look.sample;
  double area = 0.0, other = 0.0, gap = kSkinRange, base_gap = kSkinRange, reach = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (group.segment[k] == Segment::kThumbDistal && is_palmar(group.region[k])) {
      gap = std::min(gap, samples[k].distance);
    }
    if (group.segment[k] == Segment::kThumbProximal && is_palmar(group.region[k])) {
      base_gap = std::min(base_gap, samples[k].distance);
    }
    if (samples[k].distance > 0.0) continue;
    // Full from half a millimetre: no steps as the thumb moves on.
    const double share = std::min(1.0, -2.0 * samples[k].distance);
    const double weight = share * (group.segment[k] == Segment::kThumbDistal ? 1.5 : 1.0);
    const Vec3 normal = product.product_from_hand.rotation.conjugate() * samples[k].normal;
    // Over a rim the thumb would meet the inside of a vessel.
    Vec3 out = look.in_product[k] - product.grip_point;
    out -= product.grip_axis * product.grip_axis.dot(out);
    const bool is_inside = samples[k].normal.dot(out) < 0.0;
    const bool is_on_end = !product.is_end_pressed &&
                           (is_inside || std::abs(normal.dot(grip_axis_in_hand)) > kEndFace);
    (is_palmar(group.region[k]) && !is_on_end ? area : other) += weight * group.area[k];
    // The further round, the more the product's skin there faces away from the palm.
    if (group.segment[k] == Segment::kThumbDistal && is_palmar(group.region[k]) && !is_on_end) {
      reach += share * group.area[k] * (1.0 + normal.z());
    }
  }
  // A thumb placed across the handle opposes the fingers; placed along it, it holds next to
  // nothing.
  const PosedSkeleton pose = pose_skeleton(hand_->skeleton, posture);
  const Vec3 tip = pose.segment[index_of(Segment::kThumbDistal)] *
                   hand_->skeleton.fingertips[index_of(Finger::kThumb)];
  const Vec3 base = pose.segment[index_of(Segment::kThumbProximal)] *
                    hand_->skeleton.joint(JointId::kThumbMp).centre;
  const double across = (tip - base).normalized().cross(grip_axis_in_hand).norm();
  // A thumb hooked over an edge bends at its tip alone; one that reaches round the air, at its MP.
  const double hooked = std::max(0.0, posture[Dof::kThumbIpFlexion] - kStraightIp) +
                        0.5 * std::max(0.0, posture[Dof::kThumbMpFlexion] - kStraightMp);
  return area - 2.0 * other + reach - 250.0 * hooked +
         (300.0 + 800.0 * across) * std::clamp(1.0 - gap / 3.0, 0.0, 1.0) -
         10.0 * std::max(0.0, gap) - 20.0 * std::max(0.0, base_gap);
}

std::vector<Obstacle> ThumbCloser::obstacles(const Posture& posture) const {
  std::vector<Obstacle> list;
  for (const RoundCone& cone : cones_->posed(hand_->skeleton, posture)) {
    if (cone.finger != Finger::kThumb && cone.level > 0) list.push_back({cone, kNeighbourGive});
  }
  return list;
}

ThumbPose ThumbCloser::find_pose(const HeldProduct& product, const DepthLimits& limits,
                                 const Posture& start, const Vec3& grip_axis_in_hand) const {
  const JointDof& flexion = hand_->skeleton.dof(Dof::kThumbCmcFlexion);
  const JointDof& abduction = hand_->skeleton.dof(Dof::kThumbCmcAbduction);
  std::vector<ThumbPose> goals;
  for (const double f : {0.1, 0.4, 0.7, 1.0}) {
    for (const double a : {0.15, 0.5, 0.85}) {
      goals.push_back({flexion.lower + f * (flexion.upper - flexion.lower),
                       abduction.lower + a * (abduction.upper - abduction.lower)});
    }
  }
  return best_of(goals, product, limits, start, grip_axis_in_hand);
}

ThumbPose ThumbCloser::improved(const ThumbPose& goal, const HeldProduct& product,
                                const DepthLimits& limits, const Posture& start,
                                const Vec3& grip_axis_in_hand) const {
  const JointDof& flexion = hand_->skeleton.dof(Dof::kThumbCmcFlexion);
  const JointDof& abduction = hand_->skeleton.dof(Dof::kThumbCmcAbduction);
  std::array<SegmentStop, kSegmentCount> stops;
  const auto rated = [&](const ThumbPose& tried) {
    return score(product, wrap(product, limits, start, tried, stops), grip_axis_in_hand);
  };
  ThumbPose best = goal;
  double best_score = rated(goal);
  for (const double step : {0.15, 0.075}) {
    const ThumbPose from = best;
    for (const auto& [f, a] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
      const ThumbPose next = {
          std::clamp(from.cmc_flexion + f * (flexion.upper - flexion.lower), flexion.lower,
                     flexion.upper),
          std::clamp(from.cmc_abduction + a * (abduction.upper - abduction.lower), abduction.lower,
                     abduction.upper)};
      const double here = rated(next);
      if (here <= best_score) continue;
      best_score = here;
      best = next;
    }
  }
  return best;
}

ThumbPose ThumbCloser::best_of(const std::vector<ThumbPose>& goals, const HeldProduct& product,
                               const DepthLimits& limits, const Posture& start,
                               const Vec3& grip_axis_in_hand) const {
  ThumbPose best;
  double best_score = -std::numeric_limits<double>::infinity();
  std::array<SegmentStop, kSegmentCount> stops;
  for (const ThumbPose& goal : goals) {
    const double here =
        score(product, wrap(product, limits, start, goal, stops), grip_axis_in_hand);
    if (here <= best_score) continue;
    best_score = here;
    best = goal;
  }
  return best;
}

}  // namespace palmar
