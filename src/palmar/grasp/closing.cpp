// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/closing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "palmar/grasp/site_distance.h"
#include "palmar/grasp/skin_sampling.h"

namespace palmar {
namespace {

constexpr double kRange = kSiteBand;    // mm; farther skin needn't know how far
constexpr double kTolerance = 0.02;     // mm; how near to a limit counts as there
constexpr double kGlide = 1.5;          // mm; longest step along a surface between two looks
constexpr double kNeighbourGive = 1.5;  // mm; skin of two fingers pressed together
constexpr double kWidestGap = 12.0;     // mm between neighbours that one round closes
constexpr double kUsualGap = 0.5;       // mm; fingers round a handle lie side by side
constexpr double kPalmGive = 4.0;       // mm; finger on palm: the cones are coarse there
constexpr double kSharedLimit = 0.6;    // of the finger limit may be used up by pushing in
constexpr double kBallShare = 0.7;      // of the palm limit for the thumb's ball in pushing in
constexpr double kHalfFinger = 8.0;     // mm; bone line to palmar skin
constexpr double kWideOpen = -20.0 * std::numbers::pi / 180.0;  // MCP when the hand reaches out
constexpr double kPreshape = 0.8;  // of the bend that fits the handle, before closing
constexpr double kEndFace = 0.7;   // of the normal along the grip axis: not held, but hooked
constexpr double kStraightIp = 45.0 * std::numbers::pi / 180.0;  // ordinary bend of the IP joint
constexpr int kLongestAdvance = 60;                              // steps

constexpr std::array<Finger, 4> kFingers = {Finger::kIndex, Finger::kMiddle, Finger::kRing,
                                            Finger::kLittle};

// Whether the sample says more than "far".
bool is_near(const DistanceSample& sample) { return std::abs(sample.distance) < kRange - 1e-6; }

bool is_palmar(Region region) { return region != Region::kDorsum; }

std::size_t index_of(Segment segment) { return static_cast<std::size_t>(segment); }

int level_of(Finger finger, Segment segment) {
  const auto segments = segments_of(finger);
  for (int level = 0; level < 3; ++level) {
    if (segments[static_cast<std::size_t>(level)] == segment) return level;
  }
  return -1;
}

int levels_of(Finger finger) { return finger == Finger::kThumb ? 2 : 3; }

}  // namespace

Dof flexion_of(Finger finger, int level) {
  if (finger == Finger::kThumb) return level == 0 ? Dof::kThumbMpFlexion : Dof::kThumbIpFlexion;
  const int first = static_cast<int>(Dof::kIndexMcpFlexion) + 4 * (static_cast<int>(finger) - 1);
  return static_cast<Dof>(level == 0 ? first : first + level + 1);
}

Dof abduction_of(Finger finger) {
  if (finger == Finger::kThumb) return Dof::kThumbCmcAbduction;
  return static_cast<Dof>(static_cast<int>(Dof::kIndexMcpAbduction) +
                          4 * (static_cast<int>(finger) - 1));
}

HandCloser::HandCloser(const Hand& hand, double spacing) : hand_(&hand), cones_(hand) {
  const SkinSample sample = sample_skin(hand, spacing);
  const auto group_of = [&](auto&& belongs) {
    std::vector<int> vertices;
    std::vector<double> area;
    for (std::size_t k = 0; k < sample.vertex.size(); ++k) {
      const auto v = static_cast<std::size_t>(sample.vertex[k]);
      if (!belongs(hand.segment[v], hand.region[v])) continue;
      vertices.push_back(sample.vertex[k]);
      area.push_back(sample.area[k]);
    }
    Group group{PosableSkin(hand, vertices), {}, {}, std::move(area)};
    for (const int v : vertices) {
      group.segment.push_back(hand.segment[static_cast<std::size_t>(v)]);
      group.region.push_back(hand.region[static_cast<std::size_t>(v)]);
    }
    return group;
  };
  all_ = group_of([](Segment, Region) { return true; });
  palm_ = group_of([](Segment, Region region) { return is_palmar(region); });
  for (int f = 0; f < kFingerCount; ++f) {
    const auto finger = static_cast<Finger>(f);
    for (int level = 0; level < 3; ++level) {
      groups_.push_back(group_of([&](Segment segment, Region region) {
        const int own = level_of(finger, segment);
        // The third group of the thumb is what its CMC joint moves.
        const bool is_cmc = finger == Finger::kThumb && level == 2;
        return is_cmc ? own >= 0 || region == Region::kThenar : own >= level;
      }));
    }
  }
}

Posture HandCloser::open_posture() const {
  const Skeleton& skeleton = hand_->skeleton;
  Posture posture = reference_posture(skeleton);
  for (const Finger finger : kFingers) {
    for (int level = 0; level < 3; ++level) {
      const JointDof& dof = skeleton.dof(flexion_of(finger, level));
      posture[dof.dof] = std::clamp(0.0, dof.lower, dof.upper);
    }
  }
  const auto at_share = [&](Dof d, double share) {
    const JointDof& dof = skeleton.dof(d);
    posture[d] = dof.lower + share * (dof.upper - dof.lower);
  };
  at_share(Dof::kThumbCmcFlexion, 0.05);
  at_share(Dof::kThumbCmcAbduction, 0.35);
  posture[Dof::kThumbMpFlexion] = std::clamp(0.0, lower_of(*hand_, Dof::kThumbMpFlexion),
                                             upper_of(*hand_, Dof::kThumbMpFlexion));
  posture[Dof::kThumbIpFlexion] = std::clamp(0.0, lower_of(*hand_, Dof::kThumbIpFlexion),
                                             upper_of(*hand_, Dof::kThumbIpFlexion));
  return posture;
}

double HandCloser::free_travel(const HeldProduct& product, const DepthLimits& limits,
                               const Posture& posture, const Vec3& direction,
                               double longest) const {
  std::vector<Vec3> posed;
  palm_.skin.pose(posture, posed);
  const Vec3 step = product.product_from_hand.rotation * direction;
  std::vector<Vec3> points(posed.size());
  std::vector<DistanceSample> samples(posed.size());
  double travel = 0.0;
  for (int i = 0; i < kLongestAdvance && travel < longest; ++i) {
    // The product goes along +direction; seen from it, the hand goes along -direction.
    for (std::size_t k = 0; k < posed.size(); ++k) {
      points[k] = product.product_from_hand * posed[k] - travel * step;
    }
    product.distance->sample(points, kRange, samples);
    double advance = std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < posed.size(); ++k) {
      double limit = limits.palm;
      if (palm_.segment[k] != Segment::kPalm) {
        limit = kSharedLimit * limits.finger;
      } else if (palm_.region[k] == Region::kThenar) {
        limit = kBallShare * limits.palm;
      }
      const double slack = samples[k].distance + limit;
      least = std::min(least, slack);
      const double approach = samples[k].normal.dot(step);
      const double planar = !is_near(samples[k]) ? slack
                            : approach > 0.0     ? 0.9 * slack / approach
                                                 : std::numeric_limits<double>::infinity();
      advance = std::min(advance, std::max(slack, std::min(planar, kGlide)));
    }
    if (least <= kTolerance) break;
    travel += std::max(advance, 0.5 * kTolerance);
  }
  return std::min(travel, longest);
}

struct HandCloser::Advance {
  Posture posture;
  double share = 0.0;  // of the way from `from` to `to`
  bool is_stopped = false;
  bool by_product = false;
  Segment segment{};                                            // whose skin was at its limit
  std::array<double, 3> deepest = {-kRange, -kRange, -kRange};  // per phalanx from the palm, mm

  StopReason reason_for(Segment moved) const {
    if (!is_stopped) return StopReason::kRangeOfMotion;
    if (!by_product) return StopReason::kOtherFinger;
    return segment == moved ? StopReason::kLimitDepth : StopReason::kDistalStop;
  }
};

HandCloser::Advance HandCloser::advance(const Group& group, const HeldProduct& product,
                                        const DepthLimits& limits,
                                        const std::vector<Obstacle>& obstacles, const Posture& from,
                                        const Posture& to) const {
  const std::size_t count = group.segment.size();
  const auto posture_at = [&](double s) {
    Posture posture = from;
    for (std::size_t i = 0; i < posture.angle.size(); ++i) {
      posture.angle[i] += s * (to.angle[i] - from.angle[i]);
    }
    return posture;
  };
  struct Look {
    double share = 0.0;
    std::vector<Vec3> skin;
    std::vector<DistanceSample> sample;
    std::vector<double> slack;      // to the product's limit, mm
    std::vector<double> clearance;  // to the obstacles, mm
    double least = 0.0;
    std::size_t who = 0;
    bool by_product = true;
  };
  std::vector<double> forgiven(count, 0.0), forgiven_clearance(count, 0.0);
  std::vector<Vec3> points(count);
  const auto look_at = [&](double s, Look& look) {
    look.share = s;
    group.skin.pose(posture_at(s), look.skin);
    for (std::size_t k = 0; k < count; ++k) points[k] = product.product_from_hand * look.skin[k];
    look.sample.resize(count);
    product.distance->sample(points, kRange, look.sample);
    look.slack.resize(count);
    look.clearance.assign(count, kRange);
    look.least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < count; ++k) {
      const double limit = group.segment[k] == Segment::kPalm ? limits.palm : limits.finger;
      look.slack[k] = look.sample[k].distance + limit + forgiven[k];
      for (const Obstacle& obstacle : obstacles) {
        look.clearance[k] =
            std::min(look.clearance[k], distance_to(obstacle.cone, look.skin[k]) + obstacle.give);
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
  look_at(0.0, now);
  // Skin that starts beyond a limit (pressed in by the palm) may stay, but go no deeper.
  for (std::size_t k = 0; k < count; ++k) {
    forgiven[k] = std::max(0.0, kTolerance + 0.05 - now.slack[k]);
    forgiven_clearance[k] = std::max(0.0, kTolerance + 0.05 - now.clearance[k]);
  }
  look_at(0.0, now);
  look_at(1e-3, next);
  std::vector<Vec3> velocity(count, Vec3::Zero());
  for (std::size_t k = 0; k < count; ++k) velocity[k] = (next.skin[k] - now.skin[k]) / 1e-3;

  for (int i = 0; i < kLongestAdvance && now.share < 1.0 && now.least > kTolerance; ++i) {
    double step = 1.0 - now.share;
    for (std::size_t k = 0; k < count; ++k) {
      const double speed = velocity[k].norm();
      if (speed < 1e-9) continue;
      const double glide = kGlide / speed;
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
    look_at(now.share + std::max(step, 1e-5), next);
    // Too far after all: back between the last good place and here.
    double good = now.share, bad = next.share;
    double good_slack = now.least, bad_slack = next.least;
    for (int back = 0; back < 12 && next.least < 0.0; ++back) {
      const double mix = std::clamp(good_slack / (good_slack - bad_slack), 0.1, 0.9);
      look_at(good + mix * (bad - good), next);
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
    const auto finger = finger_of(group.segment[k]);
    if (!finger) continue;
    double& deepest = result.deepest[static_cast<std::size_t>(level_of(*finger, group.segment[k]))];
    deepest = std::max(deepest, -now.sample[k].distance);
  }
  return result;
}

Posture HandCloser::preshaped(const HeldProduct& product, const DepthLimits& limits, Finger finger,
                              double diameter, double share, const Posture& start) const {
  const Skeleton& skeleton = hand_->skeleton;
  const auto segments = segments_of(finger);
  std::array<double, 3> turn{};  // that each phalanx takes round the handle, half of it
  for (std::size_t level = 0; level < 3; ++level) {
    const Vec3& a = skeleton.joint(joint_of(*segments[level])).centre;
    const Vec3& b = level == 2 ? skeleton.fingertips[static_cast<std::size_t>(finger)]
                               : skeleton.joint(joint_of(*segments[level + 1])).centre;
    turn[level] = std::atan((b - a).norm() / (diameter + 2.0 * kHalfFinger));
  }
  Posture posture = start;
  const Dof mcp = flexion_of(finger, 0);
  posture[mcp] = std::max(lower_of(*hand_, mcp), kWideOpen);
  for (; share > 0.05; share -= 0.25) {
    for (int level = 1; level < 3; ++level) {
      const JointDof& dof = skeleton.dof(flexion_of(finger, level));
      const auto l = static_cast<std::size_t>(level);
      posture[dof.dof] = std::clamp(share * (turn[l - 1] + turn[l]), dof.lower, dof.upper);
    }
    if (is_free(product, limits, finger, posture)) return posture;
  }
  return start;
}

bool HandCloser::is_free(const HeldProduct& product, const DepthLimits& limits, Finger finger,
                         const Posture& posture) const {
  const Group& group = groups_[static_cast<std::size_t>(finger) * 3];
  std::vector<Vec3> points;
  group.skin.pose(posture, points);
  for (Vec3& p : points) p = product.product_from_hand * p;
  std::vector<DistanceSample> samples(points.size());
  product.distance->sample(points, kRange, samples);
  return std::all_of(samples.begin(), samples.end(), [&](const DistanceSample& sample) {
    return sample.distance > -kSharedLimit * limits.finger;
  });
}

Posture HandCloser::close_finger(const HeldProduct& product, const DepthLimits& limits,
                                 Finger finger, Posture posture,
                                 std::array<SegmentStop, kSegmentCount>& stops) const {
  std::vector<Obstacle> palm;
  for (const RoundCone& cone : cones_.posed(hand_->skeleton, posture)) {
    if (cone.level == 0) palm.push_back({cone, kPalmGive});
  }
  const auto segments = segments_of(finger);
  for (int level = 0; level < levels_of(finger); ++level) {
    const Dof dof = flexion_of(finger, level);
    Posture closed = posture;
    closed[dof] = upper_of(*hand_, dof);
    const Group& group = groups_[static_cast<std::size_t>(static_cast<int>(finger) * 3 + level)];
    // A proximal phalanx can't meet the palm.
    const Advance way = advance(group, product, limits, level == 0 ? std::vector<Obstacle>{} : palm,
                                posture, closed);
    posture = way.posture;
    SegmentStop& stop = stops[index_of(*segments[static_cast<std::size_t>(level)])];
    stop.segment = *segments[static_cast<std::size_t>(level)];
    if (level == 0) {
      for (int outer = 0; outer < 2; ++outer) {
        const Segment segment = *segments[static_cast<std::size_t>(outer)];
        stops[index_of(segment)].penetration = way.deepest[static_cast<std::size_t>(outer)];
      }
    }
    stop.reason = way.reason_for(stop.segment);
  }
  return posture;
}

Posture HandCloser::close_fingers(const HeldProduct& product, const DepthLimits& limits,
                                  Posture start,
                                  std::array<SegmentStop, kSegmentCount>& stops) const {
  Posture open = start;
  Posture posture = start;
  for (int round = 0;; ++round) {
    posture = open;
    for (const Finger finger : kFingers) {
      // Bent too much, the fingertip meets the product first and the rest hangs in the air.
      const Posture before = posture;
      for (const double share : {kPreshape, 0.5 * kPreshape, 0.0}) {
        const Posture shaped = preshaped(product, limits, finger, product.diameter, share, before);
        const bool is_last = share == 0.0;
        posture = close_finger(product, limits, finger, shaped, stops);
        const auto segments = segments_of(finger);
        const SegmentStop& proximal = stops[index_of(*segments[0])];
        if (is_last || proximal.reason != StopReason::kDistalStop) break;
        if (proximal.penetration > 0.0 || stops[index_of(*segments[1])].penetration > 0.0) break;
      }
    }
    if (round == 3) break;
    // Flexing fingers converge; where two would share space, spread them at the knuckle and close
    // again. The middle finger stays, the others give way outwards.
    const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, posture);
    const auto crossing = [&](Finger a, Finger b) {
      double deepest = -kWidestGap;
      const double arm = 60.0;
      for (const RoundCone& p : cones) {
        if (p.finger != a || p.level == 0) continue;
        for (const RoundCone& q : cones) {
          if (q.finger != b || q.level == 0) continue;
          deepest = std::max(deepest, overlap(p, q));
        }
      }
      if (deepest > 0.5 * kNeighbourGive) return deepest / arm;
      return deepest < -kUsualGap ? (deepest + kUsualGap) / arm : 0.0;
    };
    const double index = crossing(Finger::kIndex, Finger::kMiddle);
    const double ring = crossing(Finger::kMiddle, Finger::kRing);
    const double little = crossing(Finger::kRing, Finger::kLittle);
    if (index == 0.0 && ring == 0.0 && little == 0.0) break;
    const auto spread = [&](Finger finger, double angle) {
      const JointDof& dof = hand_->skeleton.dof(abduction_of(finger));
      open[dof.dof] = std::clamp(open[dof.dof] + angle, dof.lower, dof.upper);
    };
    spread(Finger::kIndex, index);
    spread(Finger::kRing, -ring);
    spread(Finger::kLittle, -ring - little);
  }
  return posture;
}

Posture HandCloser::wrap_thumb(const HeldProduct& product, const DepthLimits& limits,
                               const Posture& start, double cmc_flexion, double cmc_abduction,
                               std::array<SegmentStop, kSegmentCount>& stops) const {
  const std::vector<Obstacle> obstacles = thumb_obstacles(start);
  // First out of the palm's plane, clear of the product, then across it.
  Posture target = start;
  target[Dof::kThumbCmcAbduction] = cmc_abduction;
  Posture posture = advance(groups_[2], product, limits, obstacles, start, target).posture;
  target = posture;
  target[Dof::kThumbCmcFlexion] = cmc_flexion;
  posture = advance(groups_[2], product, limits, obstacles, posture, target).posture;
  const std::array<Segment, 2> segments = {Segment::kThumbProximal, Segment::kThumbDistal};
  for (int level = 0; level < 2; ++level) {
    const Dof dof = flexion_of(Finger::kThumb, level);
    target = posture;
    target[dof] = upper_of(*hand_, dof);
    const Advance way = advance(groups_[static_cast<std::size_t>(level)], product, limits,
                                obstacles, posture, target);
    posture = way.posture;
    SegmentStop& stop = stops[index_of(segments[static_cast<std::size_t>(level)])];
    stop.segment = segments[static_cast<std::size_t>(level)];
    stop.reason = way.reason_for(stop.segment);
  }
  return posture;
}

double HandCloser::thumb_score(const HeldProduct& product, const Posture& posture,
                               const Vec3& grip_axis_in_hand) const {
  const Group& group = groups_[2];
  std::vector<Vec3> posed;
  group.skin.pose(posture, posed);
  std::vector<Vec3> points(posed.size());
  for (std::size_t k = 0; k < posed.size(); ++k) points[k] = product.product_from_hand * posed[k];
  std::vector<DistanceSample> samples(posed.size());
  product.distance->sample(points, kRange, samples);
  double area = 0.0, other = 0.0, gap = kRange, reach = 0.0;
  for (std::size_t k = 0; k < posed.size(); ++k) {
    if (group.segment[k] == Segment::kThumbDistal && is_palmar(group.region[k])) {
      gap = std::min(gap, samples[k].distance);
    }
    if (samples[k].distance > 0.0) continue;
    // Full from half a millimetre: no steps as the thumb moves on.
    const double share = std::min(1.0, -2.0 * samples[k].distance);
    const double weight = share * (group.segment[k] == Segment::kThumbDistal ? 1.5 : 1.0);
    const Vec3 normal = product.product_from_hand.rotation.conjugate() * samples[k].normal;
    // Over a rim the thumb would meet the inside of a vessel.
    Vec3 out = points[k] - product.grip_point;
    out -= product.grip_axis * product.grip_axis.dot(out);
    const bool is_inside = samples[k].normal.dot(out) < 0.0;
    const bool is_on_end = is_inside || std::abs(normal.dot(grip_axis_in_hand)) > kEndFace;
    (is_palmar(group.region[k]) && !is_on_end ? area : other) += weight * group.area[k];
    // The further round, the more the product's skin there faces away from the palm.
    if (group.segment[k] == Segment::kThumbDistal && is_palmar(group.region[k]) && !is_on_end) {
      reach += share * group.area[k] * (1.0 + normal.z());
    }
  }
  // A thumb laid across the handle opposes the fingers; laid along it, it holds next to nothing.
  const PosedSkeleton pose = pose_skeleton(hand_->skeleton, posture);
  const Vec3 tip = pose.segment[index_of(Segment::kThumbDistal)] *
                   hand_->skeleton.fingertips[static_cast<std::size_t>(Finger::kThumb)];
  const Vec3 base = pose.segment[index_of(Segment::kThumbProximal)] *
                    hand_->skeleton.joint(JointId::kThumbMp).centre;
  const double across = (tip - base).normalized().cross(grip_axis_in_hand).norm();
  // A thumb hooked over an edge bends at its tip alone.
  const double hooked = std::max(0.0, posture[Dof::kThumbIpFlexion] - kStraightIp);
  return area - 2.0 * other + reach - 250.0 * hooked + 500.0 * across - 10.0 * std::max(0.0, gap);
}

std::vector<HandCloser::Obstacle> HandCloser::thumb_obstacles(const Posture& posture) const {
  std::vector<Obstacle> obstacles;
  for (const RoundCone& cone : cones_.posed(hand_->skeleton, posture)) {
    if (cone.finger != Finger::kThumb && cone.level > 0)
      obstacles.push_back({cone, kNeighbourGive});
  }
  return obstacles;
}

HandCloser::ThumbWay HandCloser::find_thumb_way(const HeldProduct& product,
                                                const DepthLimits& limits, const Posture& start,
                                                const Vec3& grip_axis_in_hand) const {
  const JointDof& flexion = hand_->skeleton.dof(Dof::kThumbCmcFlexion);
  const JointDof& abduction = hand_->skeleton.dof(Dof::kThumbCmcAbduction);
  const auto at = [](const JointDof& dof, double share) {
    return dof.lower + share * (dof.upper - dof.lower);
  };
  double best_score = -std::numeric_limits<double>::infinity();
  double best_flexion = 0.5, best_abduction = 0.5;
  std::array<SegmentStop, kSegmentCount> stops;
  const auto try_at = [&](double f, double a) {
    if (f < 0.0 || f > 1.0 || a < 0.0 || a > 1.0) return;
    const Posture posture =
        wrap_thumb(product, limits, start, at(flexion, f), at(abduction, a), stops);
    const double score = thumb_score(product, posture, grip_axis_in_hand);
    if (score <= best_score) return;
    best_score = score;
    best_flexion = f;
    best_abduction = a;
  };
  for (const double f : {0.1, 0.4, 0.7, 1.0}) {
    for (const double a : {0.1, 0.4, 0.7, 1.0}) try_at(f, a);
  }
  for (const double step : {0.15, 0.075, 0.04}) {
    const double f = best_flexion, a = best_abduction;
    for (const auto& [df, da] : {std::pair{step, 0.0}, {-step, 0.0}, {0.0, step}, {0.0, -step}}) {
      try_at(f + df, a + da);
    }
  }
  return {at(flexion, best_flexion), at(abduction, best_abduction)};
}

HoldMeasure HandCloser::measure(const HeldProduct& product, const Posture& posture,
                                const Vec3& axis_in_hand) const {
  std::vector<Vec3> posed;
  all_.skin.pose(posture, posed);
  std::vector<Vec3> points(posed.size());
  for (std::size_t k = 0; k < posed.size(); ++k) points[k] = product.product_from_hand * posed[k];
  std::vector<DistanceSample> samples(posed.size());
  product.distance->sample(points, kRange, samples);
  HoldMeasure measure;
  measure.penetration.fill(-kRange);
  const Vec3 u = axis_in_hand.unitOrthogonal();
  const Vec3 v = axis_in_hand.cross(u);
  std::vector<double> turns;
  for (std::size_t k = 0; k < posed.size(); ++k) {
    const double depth = -samples[k].distance;
    double& deepest = measure.penetration[index_of(all_.segment[k])];
    if (!is_palmar(all_.region[k])) {
      if (depth > 0.0) measure.other_area += all_.area[k];
      measure.deepest_other = std::max(measure.deepest_other, depth);
      continue;
    }
    deepest = std::max(deepest, depth);
    if (depth <= 0.0) continue;
    // Full from half a millimetre, so that the area of a sparse sample changes without steps.
    measure.contact_area += std::min(1.0, 2.0 * depth) * all_.area[k];
    if (finger_of(all_.segment[k]) == Finger::kThumb || all_.region[k] == Region::kThenar) {
      measure.thumb_area += all_.area[k];
    }
    const Vec3 normal = product.product_from_hand.rotation.conjugate() * samples[k].normal;
    if (Vec3(normal - axis_in_hand * axis_in_hand.dot(normal)).norm() > 0.5) {
      turns.push_back(std::atan2(v.dot(normal), u.dot(normal)));
    }
  }
  std::array<bool, kFingerCount> touches{};
  for (std::size_t s = 1; s < measure.penetration.size(); ++s) {
    measure.touching += std::clamp(0.5 * (measure.penetration[s] + 1.0), 0.0, 1.0);
    if (measure.penetration[s] <= 0.0) continue;
    ++measure.segments;
    touches[static_cast<std::size_t>(*finger_of(static_cast<Segment>(s)))] = true;
  }
  for (const bool t : touches) measure.fingers += t ? 1 : 0;
  if (!turns.empty()) {
    std::sort(turns.begin(), turns.end());
    double widest = turns.front() + 2.0 * std::numbers::pi - turns.back();
    for (std::size_t i = 1; i < turns.size(); ++i) {
      widest = std::max(widest, turns[i] - turns[i - 1]);
    }
    measure.wrap = 1.0 - widest / (2.0 * std::numbers::pi);
  }
  return measure;
}

}  // namespace palmar
