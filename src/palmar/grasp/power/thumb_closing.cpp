// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/thumb_closing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/geometry/least_squares.h"
#include "palmar/geometry/numeric_jacobian.h"
#include "palmar/geometry/smooth_step.h"
#include "palmar/grasp/power/volar_skin.h"

namespace palmar::grasp {
namespace {

constexpr std::array<hand::Dof, 4> kThumbDofs = {
    hand::Dof::kThumbCmcFlexion, hand::Dof::kThumbCmcAbduction, hand::Dof::kThumbMpFlexion,
    hand::Dof::kThumbIpFlexion};

// What residuals() weighs; a residual of 1 is 1 mm between the pad and where it is meant to be. The
// weights are our choice.
constexpr double kPress = 1.5;       // mm that the pad is meant to be in the surface
constexpr double kBaseWeight = 0.3;  // of the proximal phalanx against the pad, in square
constexpr double kFarPad = 3.0;      // mm; of farther skin the square root counts
constexpr double kOppose = 0.15;     // per mm along the grip axis from the index and middle finger
constexpr double kFarAlong = 15.0;   // mm; the same
constexpr double kPadTurnedAway = 2.0;  // of the pad where the surface faces the wrong way: twice
constexpr double kPadOnEnd = 4.0;       // of the pad on an end face, or on the inside of a vessel
constexpr double kInsideRange = 0.3;    // of the normal towards the axis: the inside of a vessel
// Per mm; 6 mm^2 of skin that is as deep beyond what is allowed count like the pad as a whole.
constexpr double kWallArea = 6.0;    // mm^2
constexpr double kWallMargin = 0.7;  // mm before a limit depth from which skin counts as too deep
// Where the joints are at ease, and what half of a joint's range away from there counts.
constexpr double kEaseMp = 20.0 * geometry::kDegree, kEaseIp = 35.0 * geometry::kDegree;
constexpr double kThumbAlike =
    15.0 * geometry::kDegree;  // that MP and IP differ in bending from there
constexpr double kStrain = 3.0;
constexpr double kCountedReach = 2.0;  // mm; skin of fingers farther off the product counts no more
constexpr double kHalfPad = 5.0;       // mm
constexpr double kWorth = 2000.0;      // mm^2 of contact that a thumb without residuals is worth
constexpr double kHalfWorth = 15.0;    // sum of squares with which it is worth half of that

// The search.
constexpr std::array<double, 4> kFlexionShares = {0.1, 0.4, 0.7, 1.0};
constexpr std::array<double, 3> kAbductionShares = {0.15, 0.5, 0.85};
constexpr std::array<std::pair<double, double>, 3> kBends = {
    {{10.0 * geometry::kDegree, 20.0 * geometry::kDegree},
     {20.0 * geometry::kDegree, 50.0 * geometry::kDegree},
     {40.0 * geometry::kDegree, 40.0 * geometry::kDegree}}};
constexpr std::size_t kSettled = 3;   // starts of either kind that are followed
constexpr double kDifference = 0.02;  // rad, of the derivatives
constexpr int kMostIterations = 60;
constexpr double kNearLimit = 1.0;  // mm; skin that near to its limit depth is there

/// Surely not inside: outside a ball around the cone.
bool is_clear_of(const Obstacle& finger, const Vec3& point) {
  const RoundCone& cone = finger.cone;
  const double reach = 0.5 * (cone.b - cone.a).norm() + std::max(cone.radius_a, cone.radius_b);
  return (point - 0.5 * (cone.a + cone.b)).squaredNorm() > reach * reach;
}

}  // namespace

ThumbCloser::ThumbCloser(const hand::Hand& hand, const FingerCones& cones,
                         const DigitGroups& groups, const DigitGroups& sparse,
                         const AdvanceCare& care)
    : hand_(&hand),
      cones_(&cones),
      groups_(&groups[index_of(hand::Finger::kThumb)]),
      sparse_(&sparse),
      care_(care) {
  const SkinGroup& group = sparse[index_of(hand::Finger::kThumb)][2];
  const VolarSkin volar = volar_skin(hand, group, hand::Finger::kThumb);
  volar_share_ = volar.share;
  volar_ = volar.direction.back();
  for (std::size_t k = 0; k < group.segment.size(); ++k) {
    if (group.segment[k] == hand::Segment::kThumbDistal && volar_share_[k] > 0.0) pad_.push_back(k);
  }
}

hand::Posture ThumbCloser::with(const hand::Posture& posture, const ThumbPose& pose) const {
  hand::Posture result = posture;
  for (std::size_t i = 0; i < kThumbDofs.size(); ++i) {
    const hand::JointDof& dof = hand_->skeleton.dof(kThumbDofs[i]);
    result[kThumbDofs[i]] = std::clamp(pose[i], dof.lower, dof.upper);
  }
  return result;
}

ThumbPose ThumbCloser::reached(const HeldProduct& product, const DepthLimits& limits,
                               const hand::Posture& start, double flexion, double abduction) const {
  const std::vector<Obstacle> fingers = obstacles(start);
  // First out of the palm's plane, clear of the product, then across it.
  hand::Posture posture = start;
  const auto go = [&](hand::Dof dof, double to, int group) {
    hand::Posture target = posture;
    target[dof] = to;
    posture =
        advance_skin((*groups_)[group], product, limits, fingers, posture, target, care_).posture;
  };
  go(hand::Dof::kThumbCmcAbduction, abduction, 2);
  go(hand::Dof::kThumbCmcFlexion, flexion, 2);
  for (const int level : {0, 1}) {
    const hand::Dof dof = flexion_of(hand::Finger::kThumb, level);
    go(dof, hand_->skeleton.dof(dof).upper, level);
  }
  ThumbPose pose;
  for (std::size_t i = 0; i < pose.size(); ++i) pose[i] = posture[kThumbDofs[i]];
  return pose;
}

Eigen::VectorXd ThumbCloser::residuals(const HeldProduct& product, const DepthLimits& limits,
                                       const hand::Posture& posture, const Opposed& fingers) const {
  const SkinGroup& group = (*sparse_)[index_of(hand::Finger::kThumb)][2];
  const SkinLook look = look_at_skin(group, product, posture);
  const auto count = static_cast<Eigen::Index>(look.sample.size());
  // Per vertex: on the surface, not too deep, clear of the fingers; then four, one per joint and
  // one for MP and IP, which bend alike.
  Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * count + 9);
  double facing = 0.0, along = 0.0, end = 0.0, inside = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double d = look.sample[k].distance;
    const double wall = std::sqrt(group.area[k] / kWallArea);
    for (const Obstacle& finger : fingers.cones) {
      if (is_clear_of(finger, look.in_hand[k])) continue;
      const double into = -distance_to(finger.cone, look.in_hand[k]) - finger.give;
      r[2 * count + i] = std::max(r[2 * count + i], wall * into);
    }
    if (!is_palmar(group.region[k])) {
      r[count + i] = wall * std::max(0.0, -d);
      continue;
    }
    const double limit = group.segment[k] == hand::Segment::kPalm ? limits.palm : limits.finger;
    r[count + i] = wall * std::max(0.0, -d - limit + kWallMargin);
    if (group.segment[k] == hand::Segment::kThumbProximal) {
      r[i] = std::sqrt(kBaseWeight * volar_share_[k]) * softened(d, kFarPad);
    }
    if (group.segment[k] != hand::Segment::kThumbDistal) continue;
    const double share = volar_share_[k];
    r[i] = std::sqrt(share) * softened(d + kPress, kFarPad);
    along += share * (look.in_hand[k] - fingers.middle).dot(fingers.axis);
  }
  // Which way the surface under the pad faces is asked half a pad away from it: outside the product
  // the distance has no ridges.
  const hand::PosedSkeleton pose = hand::pose_skeleton(hand_->skeleton, posture);
  const Vec3 back =
      -kHalfPad * (pose.segment[index_of(hand::Segment::kThumbDistal)].rotation * volar_);
  std::vector<Vec3> points;
  for (const std::size_t k : pad_) {
    points.push_back(product.product_from_hand * Vec3(look.in_hand[k] + back));
  }
  std::vector<geometry::DistanceSample> samples(points.size());
  product.distance->sample(points, kSkinRange, samples);
  for (std::size_t i = 0; i < pad_.size(); ++i) {
    if (!is_near(samples[i])) continue;
    const double share = volar_share_[pad_[i]];
    const Vec3 normal = fingers.hand_from_product * samples[i].normal;
    facing += share * normal.dot(fingers.facing);
    if (product.is_end_pressed) continue;
    // Over a rim the thumb would meet the inside of a vessel.
    Vec3 out = points[i] - product.grip_point;
    out -= product.grip_axis * product.grip_axis.dot(out);
    const double inwards = -samples[i].normal.dot(out) / std::max(1.0, out.norm());
    end += share * normal.dot(fingers.axis);
    inside += share * geometry::smooth_step(inwards / kInsideRange);
  }
  const Eigen::Index rest = 3 * count;
  r[rest] = kOppose * softened(along, kFarAlong);
  r[rest + 1] = kPadTurnedAway * (1.0 - facing);
  r[rest + 2] = kPadOnEnd * end;
  r[rest + 3] = kPadOnEnd * inside;
  for (std::size_t i = 0; i < kThumbDofs.size(); ++i) {
    const hand::JointDof& dof = hand_->skeleton.dof(kThumbDofs[i]);
    const double ease = i == 2 ? kEaseMp : i == 3 ? kEaseIp : 0.5 * (dof.lower + dof.upper);
    r[rest + 4 + static_cast<Eigen::Index>(i)] =
        kStrain * (posture[dof.dof] - ease) / (0.5 * (dof.upper - dof.lower));
  }
  r[rest + 8] = (posture[hand::Dof::kThumbIpFlexion] - kEaseIp -
                 (posture[hand::Dof::kThumbMpFlexion] - kEaseMp)) /
                kThumbAlike;
  return r;
}

double ThumbCloser::worth(const HeldProduct& product, const DepthLimits& limits,
                          const hand::Posture& posture, const Vec3& grip_axis_in_hand) const {
  const double sum =
      residuals(product, limits, posture, opposed(product, posture, grip_axis_in_hand))
          .squaredNorm();
  return kWorth / (1.0 + sum / kHalfWorth);
}

ThumbCloser::Opposed ThumbCloser::opposed(const HeldProduct& product, const hand::Posture& posture,
                                          const Vec3& grip_axis_in_hand) const {
  Opposed result{obstacles(posture), Vec3::Zero(), grip_axis_in_hand, Vec3::UnitZ(),
                 product.product_from_hand.rotation.conjugate()};
  const hand::PosedSkeleton pose = hand::pose_skeleton(hand_->skeleton, posture);
  for (const hand::Finger finger : {hand::Finger::kIndex, hand::Finger::kMiddle}) {
    const hand::Segment distal = *hand::segments_of(finger)[2];
    result.middle += 0.5 * (pose.segment[index_of(distal)] *
                            hand_->skeleton.joint(hand::joint_of(distal)).centre);
  }
  // The palm holds against what fingertips press towards it, the thumb against what they press
  // across it: on a bar next to nothing, on the edge of a slab nearly all.
  Vec3 pressed = Vec3::Zero();
  double touching = 0.0;
  for (int f = 1; f < hand::kFingerCount; ++f) {
    const SkinGroup& group = (*sparse_)[f][2];
    const SkinLook look = look_at_skin(group, product, posture);
    for (std::size_t k = 0; k < look.sample.size(); ++k) {
      if (!is_palmar(group.region[k])) continue;
      const double share =
          group.area[k] * geometry::smooth_step(1.0 - look.sample[k].distance / kCountedReach);
      pressed -= share * (result.hand_from_product * look.sample[k].normal);
      touching += share;
    }
  }
  if (touching <= 0.0) return result;
  Vec3 across = pressed / touching;
  across -= across.dot(result.axis) * result.axis;
  across.z() = 0.0;
  result.facing = (across + std::max(0.0, 1.0 - across.norm()) * Vec3::UnitZ()).normalized();
  return result;
}

std::vector<Obstacle> ThumbCloser::obstacles(const hand::Posture& posture) const {
  std::vector<Obstacle> list;
  for (const RoundCone& cone : cones_->posed(hand_->skeleton, posture)) {
    if (cone.finger != hand::Finger::kThumb && cone.level > 0)
      list.push_back({cone, kNeighbourGive});
  }
  return list;
}

ThumbPose ThumbCloser::find_pose(const HeldProduct& product, const DepthLimits& limits,
                                 const hand::Posture& start, const Vec3& grip_axis_in_hand) const {
  const hand::JointDof& flexion = hand_->skeleton.dof(hand::Dof::kThumbCmcFlexion);
  const hand::JointDof& abduction = hand_->skeleton.dof(hand::Dof::kThumbCmcAbduction);
  const Opposed fingers = opposed(product, start, grip_axis_in_hand);
  const auto rated = [&](const ThumbPose& pose) {
    return -residuals(product, limits, with(start, pose), fingers).squaredNorm();
  };
  using Start = std::pair<double, ThumbPose>;
  std::vector<Start> reaching, crossing;
  for (const double f : kFlexionShares) {
    for (const double a : kAbductionShares) {
      const double to_flexion = flexion.lower + f * (flexion.upper - flexion.lower);
      const double to_abduction = abduction.lower + a * (abduction.upper - abduction.lower);
      const ThumbPose pose = reached(product, limits, start, to_flexion, to_abduction);
      reaching.emplace_back(rated(pose), pose);
      // Round to the far side there may be no free way with the metacarpal first.
      for (const auto& [mp, ip] : kBends) {
        const ThumbPose bent = {to_flexion, to_abduction, mp, ip};
        crossing.emplace_back(rated(bent), bent);
      }
    }
  }
  const auto by_rating = [](const Start& a, const Start& b) { return a.first > b.first; };
  std::stable_sort(reaching.begin(), reaching.end(), by_rating);
  std::stable_sort(crossing.begin(), crossing.end(), by_rating);
  std::vector<ThumbPose> starts;
  for (std::size_t k = 0; k < kSettled; ++k) {
    starts.push_back(reaching[k].second);
    starts.push_back(crossing[k].second);
  }
  ThumbPose best{};
  double most = -std::numeric_limits<double>::infinity();
  for (const ThumbPose& from : starts) {
    const ThumbPose pose = settled(from, product, limits, start, grip_axis_in_hand);
    const double here = rated(pose);
    if (here <= most) continue;
    most = here;
    best = pose;
  }
  return best;
}

ThumbPose ThumbCloser::settled(const ThumbPose& from, const HeldProduct& product,
                               const DepthLimits& limits, const hand::Posture& start,
                               const Vec3& grip_axis_in_hand) const {
  const Opposed fingers = opposed(product, start, grip_axis_in_hand);
  geometry::LeastSquaresProblem problem;
  Eigen::VectorXd first(4);
  problem.lower.resize(4);
  problem.upper.resize(4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const hand::JointDof& dof = hand_->skeleton.dof(kThumbDofs[k]);
    problem.lower[i] = dof.lower;
    problem.upper[i] = dof.upper;
    first[i] = from[k];
  }
  problem.evaluate = geometry::with_numeric_jacobian(
      [&](const Eigen::VectorXd& x, Eigen::VectorXd& r) {
        r = residuals(product, limits, with(start, {x[0], x[1], x[2], x[3]}), fingers);
      },
      [](Eigen::Index, double) { return kDifference; });
  const Eigen::VectorXd x =
      geometry::solve_least_squares(problem, first,
                                    {.max_iterations = kMostIterations, .step_tolerance = 1e-5})
          .x;
  return {x[0], x[1], x[2], x[3]};
}

hand::Posture ThumbCloser::closed(const HeldProduct& product, const DepthLimits& limits,
                                  const hand::Posture& start, const ThumbPose& pose,
                                  std::array<SegmentStop, hand::kSegmentCount>& stops) const {
  const hand::Posture closed = with(start, pose);
  const SkinGroup& skin = (*groups_)[0];
  const SkinLook look = look_at_skin(skin, product, closed);
  const std::array<hand::Segment, 2> segments = {hand::Segment::kThumbProximal,
                                                 hand::Segment::kThumbDistal};
  std::array<bool, 2> is_at_limit{};
  for (std::size_t k = 0; k < look.sample.size(); ++k) {
    if (look.sample[k].distance > kNearLimit - limits.finger) continue;
    is_at_limit[skin.segment[k] == hand::Segment::kThumbDistal ? 1 : 0] = true;
  }
  for (std::size_t level = 0; level < 2; ++level) {
    stops[index_of(segments[level])].segment = segments[level];
    stops[index_of(segments[level])].reason = is_at_limit[level] ? StopReason::kLimitDepth
                                              : is_at_limit[1]   ? StopReason::kDistalStop
                                                                 : StopReason::kRangeOfMotion;
  }
  return closed;
}

}  // namespace palmar::grasp
