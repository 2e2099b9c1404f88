// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/skin_advance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palmar::grasp {
namespace {

constexpr double kOtherSide = -0.3;  // cosine between normals of the two sides of a wall

}  // namespace

bool is_near(const geometry::DistanceSample& sample) {
  return std::abs(sample.distance) < kSkinRange - 1e-6;
}

int level_of(hand::Finger finger, hand::Segment segment) {
  const auto segments = hand::segments_of(finger);
  for (int level = 0; level < 3; ++level) {
    if (segments[level] == segment) return level;
  }
  return -1;
}

hand::Dof flexion_of(hand::Finger finger, int level) {
  if (finger == hand::Finger::kThumb)
    return level == 0 ? hand::Dof::kThumbMpFlexion : hand::Dof::kThumbIpFlexion;
  const int first =
      static_cast<int>(hand::Dof::kIndexMcpFlexion) + 4 * (static_cast<int>(finger) - 1);
  return static_cast<hand::Dof>(level == 0 ? first : first + level + 1);
}

hand::Dof abduction_of(hand::Finger finger) {
  if (finger == hand::Finger::kThumb) return hand::Dof::kThumbCmcAbduction;
  return static_cast<hand::Dof>(static_cast<int>(hand::Dof::kIndexMcpAbduction) +
                                4 * (static_cast<int>(finger) - 1));
}

SkinLook look_at_skin(const SkinGroup& group, const HeldProduct& product,
                      const hand::Posture& posture) {
  SkinLook look;
  group.skin.pose(posture, look.in_hand);
  look.in_product.reserve(look.in_hand.size());
  for (const Vec3& p : look.in_hand) look.in_product.push_back(product.product_from_hand * p);
  look.sample.resize(look.in_hand.size());
  product.distance->sample(look.in_product, kSkinRange, look.sample);
  return look;
}

StopReason Advance::reason_for(hand::Segment moved) const {
  if (!is_stopped) return StopReason::kRangeOfMotion;
  if (!by_product) return StopReason::kOtherFinger;
  return segment == moved ? StopReason::kLimitDepth : StopReason::kDistalStop;
}

Advance advance_skin(const SkinGroup& group, const HeldProduct& product, const DepthLimits& limits,
                     const std::vector<Obstacle>& obstacles, const hand::Posture& from,
                     const hand::Posture& to, const AdvanceCare& care) {
  const std::size_t count = group.segment.size();
  const auto posture_at = [&](double s) {
    hand::Posture posture = from;
    for (std::size_t i = 0; i < posture.angle.size(); ++i) {
      posture.angle[i] += s * (to.angle[i] - from.angle[i]);
    }
    return posture;
  };
  struct Look {
    double share = 0.0;
    std::vector<Vec3> skin;
    std::vector<geometry::DistanceSample> sample;
    std::vector<double> slack;      // to the product's limit, mm
    std::vector<double> clearance;  // to the obstacles, mm
    double least = 0.0;
    std::size_t who = 0;
    bool by_product = true;
  };
  // Obstacles farther than that from a point say nothing.
  std::vector<Vec3> middle;
  std::vector<double> farthest;  // squared, mm^2
  for (const Obstacle& obstacle : obstacles) {
    const RoundCone& cone = obstacle.cone;
    middle.push_back(0.5 * (cone.a + cone.b));
    const double far =
        0.5 * (cone.b - cone.a).norm() + std::max(cone.radius_a, cone.radius_b) + kSkinRange;
    farthest.push_back(far * far);
  }
  std::vector<double> forgiven(count, 0.0), forgiven_clearance(count, 0.0);
  std::vector<Vec3> points(count);
  const auto look_at = [&](double s, Look& look, const Look* before) {
    look.share = s;
    group.skin.pose(posture_at(s), look.skin);
    for (std::size_t k = 0; k < count; ++k) points[k] = product.product_from_hand * look.skin[k];
    look.sample.resize(count);
    product.distance->sample(points, kSkinRange, look.sample);
    look.slack.resize(count);
    look.clearance.assign(count, kSkinRange);
    look.least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      const double limit = group.segment[k] == hand::Segment::kPalm ? limits.palm : limits.finger;
      look.slack[k] = look.sample[k].distance + limit + forgiven[k];
      // Past the middle of a thin wall the other side is nearer: that is deeper still, not out
      // again.
      if (before != nullptr && look.sample[k].distance < 0.0 && is_near(before->sample[k]) &&
          look.sample[k].normal.dot(before->sample[k].normal) < kOtherSide) {
        look.slack[k] = std::min(look.slack[k], -0.5 * limit);
      }
      for (std::size_t i = 0; i < obstacles.size(); ++i) {
        if ((look.skin[k] - middle[i]).squaredNorm() > farthest[i]) continue;
        look.clearance[k] = std::min(
            look.clearance[k], distance_to(obstacles[i].cone, look.skin[k]) + obstacles[i].give);
      }
      look.clearance[k] += forgiven_clearance[k];
      const double least = std::min(look.slack[k], look.clearance[k]);
      if (least < look.least) {
        look.least = least;
        look.who = k;
        look.by_product = look.slack[k] <= look.clearance[k];
      }
    }
  };

  Look now, next;
  look_at(0.0, now, nullptr);
  // Skin that starts beyond a limit (pressed in by the palm) may stay, but go no deeper.
  now.least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < count; ++k) {
    forgiven[k] = std::max(0.0, care.tolerance + 0.05 - now.slack[k]);
    forgiven_clearance[k] = std::max(0.0, care.tolerance + 0.05 - now.clearance[k]);
    now.slack[k] += forgiven[k];
    now.clearance[k] += forgiven_clearance[k];
    const double least = std::min(now.slack[k], now.clearance[k]);
    if (least >= now.least) continue;
    now.least = least;
    now.who = k;
    now.by_product = now.slack[k] <= now.clearance[k];
  }
  std::vector<Vec3> velocity(count, Vec3::Zero());
  group.skin.pose(posture_at(1e-3), next.skin);
  for (std::size_t k = 0; k < count; ++k) velocity[k] = (next.skin[k] - now.skin[k]) / 1e-3;

  for (int i = 0; i < kLongestAdvance && now.share < 1.0 && now.least > care.tolerance; ++i) {
    double step = 1.0 - now.share;
    for (std::size_t k = 0; k < count; ++k) {
      const double speed = velocity[k].norm();
      if (speed < 1e-9) continue;
      const double glide = care.glide / speed;
      double reach = now.slack[k] / speed;
      if (is_near(now.sample[k])) {
        const Vec3 normal = product.product_from_hand.rotation.conjugate() * now.sample[k].normal;
        const double approach = -normal.dot(velocity[k]);
        const double planar = approach > 0.0 ? 0.95 * now.slack[k] / approach : glide;
        reach = std::max(reach, std::min(planar, glide));
      }
      const double passing = std::max(now.clearance[k] / speed, 0.2 * glide);
      step = std::min({step, reach, passing});
    }
    look_at(now.share + std::max(step, 1e-5), next, &now);
    // Too far after all: back between the last good place and here.
    double good = now.share, bad = next.share;
    double good_slack = now.least, bad_slack = next.least;
    for (int back = 0; back < 12 && next.least < 0.0; ++back) {
      const double mix = std::clamp(good_slack / (good_slack - bad_slack), 0.1, 0.9);
      look_at(good + mix * (bad - good), next, &now);
      if (next.least < 0.0) {
        bad = next.share;
        bad_slack = next.least;
      } else {
        good = next.share;
        good_slack = next.least;
      }
    }
    if (next.least < 0.0) {
      now.by_product = next.by_product;
      now.who = next.who;
      now.least = 0.0;
      break;
    }
    const double moved = next.share - now.share;
    for (std::size_t k = 0; k < count; ++k) velocity[k] = (next.skin[k] - now.skin[k]) / moved;
    std::swap(now, next);
  }
  Advance result;
  result.share = now.share;
  result.posture = posture_at(now.share);
  result.is_stopped = now.share < 1.0;
  result.by_product = now.by_product;
  if (count > 0) result.segment = group.segment[now.who];
  for (std::size_t k = 0; k < count; ++k) {
    const auto finger = hand::finger_of(group.segment[k]);
    if (!finger) continue;
    double& deepest = result.deepest[level_of(*finger, group.segment[k])];
    deepest = std::max(deepest, -now.sample[k].distance);
  }
  return result;
}

}  // namespace palmar::grasp
