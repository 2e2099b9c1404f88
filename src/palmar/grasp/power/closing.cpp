// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/power/closing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "palmar/core/enum_index.h"
#include "palmar/geometry/degrees.h"
#include "palmar/grasp/power/site_distance.h"
#include "palmar/hand/skin/skin_sampling.h"
#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::grasp {
namespace {

constexpr double kWidestGap = 12.0;     // mm between neighbours that one round closes
constexpr double kUsualGap = 0.5;       // mm; fingers round a handle lie side by side
constexpr double kLeastSpread = 0.015;  // rad; less isn't worth closing again for
constexpr double kPalmGive = 4.0;       // mm; finger on palm: the cones are coarse there
constexpr double kSharedLimit = 0.6;    // of the finger limit may be used up by pushing in
constexpr double kBallShare = 0.7;      // of the palm limit for the thumb's ball in pushing in
constexpr double kHalfFinger = 8.0;     // mm; bone line to palmar skin
constexpr double kWideOpen = -20.0 * geometry::kDegree;  // MCP when the hand reaches out
constexpr double kPreshape = 0.8;                // of the bend that fits the handle, before closing
constexpr int kPreshapeHalvings = 8;             // of it, where the product is in the way
constexpr double kDipPerPipFlexion = 2.0 / 3.0;  // DIP / PIP; Rijkpema & Girard 1991
constexpr double kDipLag = 10.0 * geometry::kDegree;    // DIP behind that while PIP closes
constexpr double kDipLeave = 25.0 * geometry::kDegree;  // DIP may be off that to lie on
constexpr double kHookGive = 20.0 * geometry::kDegree;  // that a hook's MCP may flex
constexpr double kLeastShare = 0.35;  // of the limit depth: shallower skin doesn't stay in contact
constexpr double kShareRange = 0.3;   // over which that fades
constexpr double kIdleGap = 1.0;  // mm; a finger farther than that from the product does nothing
constexpr double kIdleMore = 5.0 * geometry::kDegree;  // that it bends beyond its neighbour
constexpr double kRoomStep =
    3.0 * geometry::kDegree;  // by which a finger goes out of the way of a product
constexpr int kRoomRounds = 20;
// The thumb's way, in shares of the ranges of CMC flexion and abduction, MP and IP flexion.
constexpr std::array<double, hand::kDigitDofs> kThumbOut{0.05, 0.95, 0.15, 0.12},
    kThumbAcross{0.85, 0.95, 0.7, 0.6};
constexpr double kThumbBeside = 0.35;  // abduction on top of a loop, beside what that is on

}  // namespace

HandCloser::HandCloser(const hand::Hand& hand, double spacing) : hand_(&hand), cones_(hand) {
  if (spacing > 0.0) care_ = {0.1, 3.0};
  const auto group_of = [&](const hand::SkinSample& sample, auto&& belongs) {
    std::vector<int> vertices;
    std::vector<double> area;
    for (std::size_t k = 0; k < sample.vertex.size(); ++k) {
      const int v = sample.vertex[k];
      if (!belongs(hand.segment[v], hand.region[v])) continue;
      vertices.push_back(sample.vertex[k]);
      area.push_back(sample.area[k]);
    }
    SkinGroup group{PosableSkin(hand, vertices), {}, {}, std::move(area)};
    for (const int v : vertices) {
      group.segment.push_back(hand.segment[v]);
      group.region.push_back(hand.region[v]);
    }
    return group;
  };
  const auto digits_of = [&](const hand::SkinSample& sample) {
    DigitGroups groups;
    for (int f = 0; f < hand::kFingerCount; ++f) {
      const auto finger = static_cast<hand::Finger>(f);
      for (int level = 0; level < 3; ++level) {
        groups[f][level] = group_of(sample, [&](hand::Segment segment, hand::Region region) {
          const int own = level_of(finger, segment);
          // The third group of the thumb is what its CMC joint moves.
          const bool is_cmc = finger == hand::Finger::kThumb && level == 2;
          return is_cmc ? own >= 0 || region == hand::Region::kThenar : own >= level;
        });
      }
    }
    return groups;
  };
  const hand::SkinSample sample = hand::sample_skin(hand, spacing);
  all_ = group_of(sample, [](hand::Segment, hand::Region) { return true; });
  palm_ = group_of(sample, [](hand::Segment, hand::Region region) { return is_palmar(region); });
  groups_ = digits_of(sample);
  const hand::Skeleton& skeleton = hand.skeleton;
  hand::Posture& posture = open_posture_;
  posture = hand::reference_posture(skeleton);
  for (const hand::Finger finger : kFingers) {
    for (int level = 0; level < 3; ++level) {
      const hand::JointDof& dof = skeleton.dof(flexion_of(finger, level));
      posture[dof.dof] = std::clamp(0.0, dof.lower, dof.upper);
    }
  }
  const auto at_share = [&](hand::Dof d, double share) {
    const hand::JointDof& dof = skeleton.dof(d);
    posture[d] = dof.lower + share * (dof.upper - dof.lower);
  };
  at_share(hand::Dof::kThumbCmcFlexion, 0.05);
  at_share(hand::Dof::kThumbCmcAbduction, 0.35);
  posture[hand::Dof::kThumbMpFlexion] =
      std::clamp(0.0, lower_of(*hand_, hand::Dof::kThumbMpFlexion),
                 upper_of(*hand_, hand::Dof::kThumbMpFlexion));
  posture[hand::Dof::kThumbIpFlexion] =
      std::clamp(0.0, lower_of(*hand_, hand::Dof::kThumbIpFlexion),
                 upper_of(*hand_, hand::Dof::kThumbIpFlexion));
  palm_.skin.pose(posture, open_palm_);
}

hand::Posture HandCloser::start_posture(const ClosingStyle& style) const {
  hand::Posture posture = open_posture_;
  const auto fan = [&](hand::Finger finger, double share) {
    const hand::JointDof& dof = hand_->skeleton.dof(abduction_of(finger));
    const double end = share > 0.0 ? dof.upper : dof.lower;
    posture[dof.dof] += std::abs(share) * (end - posture[dof.dof]);
  };
  if (!style.uses_thumb()) {
    const hand::Posture rest = hand::reference_posture(hand_->skeleton);
    for (const hand::Dof dof : {hand::Dof::kThumbCmcFlexion, hand::Dof::kThumbCmcAbduction,
                                hand::Dof::kThumbMpFlexion, hand::Dof::kThumbIpFlexion}) {
      posture[dof] = rest[dof];
    }
  }
  if (style.hook) {
    for (const hand::Finger finger : kFingers) {
      const hand::JointDof& mcp = hand_->skeleton.dof(flexion_of(finger, 0));
      posture[mcp.dof] = std::clamp(*style.hook, mcp.lower, mcp.upper);
    }
  }
  if (style.spread > 0.0) {
    fan(hand::Finger::kIndex, style.spread);
    fan(hand::Finger::kRing, -0.5 * style.spread);
    fan(hand::Finger::kLittle, -style.spread);
  }
  return posture;
}

double HandCloser::free_travel(const HeldProduct& product, const DepthLimits& limits,
                               const ClosingStyle& style, const Vec3& direction,
                               double longest) const {
  std::vector<Vec3> bent;
  if (style.hook && *style.hook != 0.0) palm_.skin.pose(start_posture(style), bent);
  const std::vector<Vec3>& posed = bent.empty() ? open_palm_ : bent;
  const double shared = style.hook ? 1.0 : kSharedLimit;
  const Vec3 step = product.product_from_hand.rotation * direction;
  std::vector<Vec3> points(posed.size());
  std::vector<geometry::DistanceSample> samples(posed.size());
  double travel = 0.0;
  for (int i = 0; i < kLongestAdvance && travel < longest; ++i) {
    // The product goes along +direction; seen from it, the hand goes along -direction.
    for (std::size_t k = 0; k < posed.size(); ++k) {
      points[k] = product.product_from_hand * posed[k] - travel * step;
    }
    product.distance->sample(points, kSkinRange, samples);
    double advance = std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < posed.size(); ++k) {
      double limit = limits.palm;
      if (palm_.segment[k] != hand::Segment::kPalm) {
        limit = shared * limits.finger;
      } else if (palm_.region[k] == hand::Region::kThenar) {
        limit = kBallShare * limits.palm;
      }
      const double slack = samples[k].distance + limit;
      least = std::min(least, slack);
      const double approach = samples[k].normal.dot(step);
      const double planar = !is_near(samples[k]) ? slack
                            : approach > 0.0     ? 0.9 * slack / approach
                                                 : std::numeric_limits<double>::infinity();
      advance = std::min(advance, std::max(slack, std::min(planar, care_.glide)));
    }
    if (least <= care_.tolerance) break;
    travel += std::max(advance, 0.5 * care_.tolerance);
  }
  return std::min(travel, longest);
}

hand::Posture HandCloser::preshaped(const HeldProduct& product, const DepthLimits& limits,
                                    hand::Finger finger, double diameter, double share,
                                    const hand::Posture& start) const {
  const hand::Skeleton& skeleton = hand_->skeleton;
  const auto segments = hand::segments_of(finger);
  std::array<double, 3> turn{};  // that each phalanx takes round the handle, half of it
  for (std::size_t level = 0; level < 3; ++level) {
    const Vec3& a = skeleton.joint(hand::joint_of(*segments[level])).centre;
    const Vec3& b = level == 2 ? skeleton.fingertips[index_of(finger)]
                               : skeleton.joint(hand::joint_of(*segments[level + 1])).centre;
    turn[level] = std::atan((b - a).norm() / (diameter + 2.0 * kHalfFinger));
  }
  const auto bent = [&](double part) {
    hand::Posture posture = start;
    const hand::Dof mcp = flexion_of(finger, 0);
    posture[mcp] = std::max(lower_of(*hand_, mcp), kWideOpen);
    const hand::JointDof& pip = skeleton.dof(flexion_of(finger, 1));
    const hand::JointDof& dip = skeleton.dof(flexion_of(finger, 2));
    posture[pip.dof] = std::clamp(part * (turn[0] + turn[1]), pip.lower, pip.upper);
    posture[dip.dof] = std::clamp(
        std::min(part * (turn[1] + turn[2]), kDipPerPipFlexion * posture[pip.dof] + kDipLeave),
        dip.lower, dip.upper);
    return posture;
  };
  hand::Posture posture = bent(share);
  if (is_free(product, limits, finger, posture)) return posture;
  double free = 0.0;
  if (!is_free(product, limits, finger, bent(free))) return start;
  for (int i = 0; i < kPreshapeHalvings; ++i) {
    const double middle = 0.5 * (free + share);
    (is_free(product, limits, finger, bent(middle)) ? free : share) = middle;
  }
  return bent(free);
}

bool HandCloser::is_free(const HeldProduct& product, const DepthLimits& limits, hand::Finger finger,
                         const hand::Posture& posture) const {
  const SkinGroup& group = groups_[index_of(finger)][0];
  const std::vector<geometry::DistanceSample> samples =
      look_at_skin(group, product, posture).sample;
  return std::all_of(samples.begin(), samples.end(), [&](const geometry::DistanceSample& sample) {
    return sample.distance > -kSharedLimit * limits.finger;
  });
}

hand::Posture HandCloser::close_finger(const HeldProduct& product, const DepthLimits& limits,
                                       const ClosingStyle& style, hand::Finger finger,
                                       hand::Posture posture,
                                       std::array<SegmentStop, hand::kSegmentCount>& stops) const {
  std::vector<Obstacle> palm;
  for (const RoundCone& cone : cones_.posed(hand_->skeleton, posture)) {
    if (cone.level == 0) palm.push_back({cone, kPalmGive});
  }
  const auto segments = hand::segments_of(finger);
  const auto stop_of = [&](std::size_t level) -> SegmentStop& {
    return stops[index_of(*segments[level])];
  };
  const hand::JointDof& mcp = hand_->skeleton.dof(flexion_of(finger, 0));
  const hand::JointDof& pip = hand_->skeleton.dof(flexion_of(finger, 1));
  const hand::JointDof& dip = hand_->skeleton.dof(flexion_of(finger, 2));
  const auto coupled = [&](double off) {
    return std::clamp(kDipPerPipFlexion * posture[pip.dof] + off, dip.lower, dip.upper);
  };
  const auto advance = [&](std::size_t level, const hand::Posture& to) {
    const SkinGroup& group = groups_[index_of(finger)][level];
    // A proximal phalanx can't meet the palm.
    const Advance way = advance_skin(
        group, product, limits, level == 0 ? std::vector<Obstacle>{} : palm, posture, to, care_);
    posture = way.posture;
    stop_of(level).segment = *segments[level];
    stop_of(level).reason = way.reason_for(*segments[level]);
    return way;
  };
  for (SegmentStop* stop : {&stop_of(0), &stop_of(1), &stop_of(2)}) stop->penetration = -kSkinRange;
  hand::Posture to = posture;
  to[mcp.dof] = style.hook ? std::clamp(*style.hook + kHookGive, mcp.lower, mcp.upper) : mcp.upper;
  const Advance first = advance(0, to);
  stop_of(0).penetration = first.deepest[0];
  stop_of(1).penetration = first.deepest[1];
  // DIP follows PIP. If it brings the tip to the product before the middle phalanx lies on
  // it, it gives way.
  to = posture;
  to[pip.dof] = pip.upper;
  to[dip.dof] = std::max(posture[dip.dof],
                         std::clamp(kDipPerPipFlexion * pip.upper - kDipLag, dip.lower, dip.upper));
  Advance way = advance(1, to);
  if (way.is_stopped && way.by_product && way.segment == *segments[2] &&
      way.deepest[1] < limits.finger) {
    const double back = coupled(-kDipLeave);
    if (back < posture[dip.dof]) {
      posture[dip.dof] = back;
      to = posture;
      to[pip.dof] = pip.upper;
      to[dip.dof] = std::max(
          back, std::clamp(kDipPerPipFlexion * pip.upper - kDipLeave, dip.lower, dip.upper));
      advance(1, to);
    }
  }
  to = posture;
  to[dip.dof] = std::max(posture[dip.dof], coupled(kDipLeave));
  advance(2, to);
  return posture;
}

hand::Posture HandCloser::reach_and_close(
    const HeldProduct& product, const DepthLimits& limits, const ClosingStyle& style,
    hand::Finger finger, const hand::Posture& start,
    std::array<SegmentStop, hand::kSegmentCount>& stops) const {
  if (style.hook) {
    hand::Posture straight = start;
    const hand::JointDof& mcp = hand_->skeleton.dof(flexion_of(finger, 0));
    straight[mcp.dof] = std::clamp(*style.hook, mcp.lower, mcp.upper);
    return close_finger(product, limits, style, finger, straight, stops);
  }
  // Bent too much, the fingertip meets the product first and the rest hangs in the air.
  for (const double share : {kPreshape, 0.5 * kPreshape, 0.0}) {
    const hand::Posture shaped = preshaped(product, limits, finger, product.diameter, share, start);
    const hand::Posture closed = close_finger(product, limits, style, finger, shaped, stops);
    const auto segments = hand::segments_of(finger);
    const SegmentStop& proximal = stops[index_of(*segments[0])];
    if (share == 0.0 || proximal.reason != StopReason::kDistalStop || proximal.penetration > 0.0 ||
        stops[index_of(*segments[1])].penetration > 0.0) {
      return closed;
    }
  }
  return start;
}

hand::Posture HandCloser::close_fingers(const HeldProduct& product, const DepthLimits& limits,
                                        const ClosingStyle& style, hand::Posture start, int rounds,
                                        std::array<SegmentStop, hand::kSegmentCount>& stops) const {
  hand::Posture posture = start;
  for (const hand::Finger finger : kFingers) {
    posture = reach_and_close(product, limits, style, finger, posture, stops);
  }
  for (int round = 0; round < rounds; ++round) {
    // Flexing fingers converge; where two would share space, spread them at the knuckle and close
    // again. The middle finger stays, the others give way outwards.
    const std::vector<RoundCone> cones = cones_.posed(hand_->skeleton, posture);
    const auto crossing = [&](hand::Finger a, hand::Finger b) {
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
      return deepest < -kUsualGap && style.spread == 0.0 ? (deepest + kUsualGap) / arm : 0.0;
    };
    const double index = crossing(hand::Finger::kIndex, hand::Finger::kMiddle);
    const double ring = crossing(hand::Finger::kMiddle, hand::Finger::kRing);
    const double little = crossing(hand::Finger::kRing, hand::Finger::kLittle);
    bool is_changed = false;
    const auto spread = [&](hand::Finger finger, double angle) {
      if (std::abs(angle) < kLeastSpread) return;
      const hand::JointDof& dof = hand_->skeleton.dof(abduction_of(finger));
      const double next = std::clamp(posture[dof.dof] + angle, dof.lower, dof.upper);
      if (std::abs(next - posture[dof.dof]) < 0.5 * kLeastSpread) return;
      is_changed = true;
      hand::Posture aside = posture;
      aside[dof.dof] = next;
      for (int level = 0; level < 3; ++level) {
        aside[flexion_of(finger, level)] = start[flexion_of(finger, level)];
      }
      posture = reach_and_close(product, limits, style, finger, aside, stops);
    };
    spread(hand::Finger::kIndex, index);
    spread(hand::Finger::kRing, -ring);
    spread(hand::Finger::kLittle, -ring - little);
    if (!is_changed) break;
  }
  rest_idle_fingers(product, limits, posture);
  return posture;
}

hand::Posture HandCloser::with_thumb(hand::Posture posture,
                                     const std::array<double, hand::kDigitDofs>& share) const {
  const auto dofs = hand::digit_dofs(hand::Finger::kThumb);
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const hand::JointDof& dof = hand_->skeleton.dof(dofs[i]);
    posture[dof.dof] = dof.lower + share[i] * (dof.upper - dof.lower);
  }
  return posture;
}

bool HandCloser::has_room_for_thumb(const HeldProduct& product, const DepthLimits& limits,
                                    const hand::Posture& posture) const {
  const SkinGroup& skin = groups_[index_of(hand::Finger::kThumb)][0];
  const SkinLook look = look_at_skin(skin, product, with_thumb(posture, kThumbOut));
  for (std::size_t k = 0; k < look.sample.size(); ++k) {
    const double limit = skin.segment[k] == hand::Segment::kPalm ? limits.palm : limits.finger;
    if (look.sample[k].distance < -limit) return false;
  }
  return true;
}

hand::Posture HandCloser::close_thumb(const HeldProduct& product, const DepthLimits& limits,
                                      const ClosingStyle& style, hand::Posture start,
                                      std::array<SegmentStop, hand::kSegmentCount>& stops) const {
  std::vector<Obstacle> fingers;
  for (const RoundCone& cone : cones_.posed(hand_->skeleton, start)) {
    if (cone.finger == hand::Finger::kThumb || cone.level == 0) continue;
    fingers.push_back({cone, kNeighbourGive});
  }
  // Out beside the palm, in front of it, across it; a hook's thumb stays beside.
  const auto thumb_at = [&](std::array<double, hand::kDigitDofs> share, double abduction) {
    share[1] = abduction;
    return with_thumb(start, share);
  };
  const double abduction = style.hook ? kThumbBeside : kThumbOut[1];
  const SkinGroup& skin = groups_[index_of(hand::Finger::kThumb)][0];
  Advance way;
  way.posture = thumb_at(kThumbOut, abduction);
  // What was taken in between thumb and fingers isn't swept aside by the thumb.
  if (style.hook || !has_room_for_thumb(product, limits, start)) {
    way = advance_skin(skin, product, limits, fingers, thumb_at(kThumbOut, kThumbBeside),
                       way.posture, care_);
  }
  if (!way.is_stopped) {
    way = advance_skin(skin, product, limits, fingers, way.posture,
                       thumb_at(kThumbAcross, abduction), care_);
  }
  std::size_t level = 0;
  for (const auto& segment : hand::segments_of(hand::Finger::kThumb)) {
    if (!segment) continue;
    SegmentStop& stop = stops[index_of(*segment)];
    stop.segment = *segment;
    stop.reason = way.reason_for(*segment);
    stop.penetration = way.deepest[level++];
  }
  return way.posture;
}

// A finger that meets nothing isn't clenched in the air: it goes with its neighbour.
void HandCloser::rest_idle_fingers(const HeldProduct& product, const DepthLimits& limits,
                                   hand::Posture& posture) const {
  const auto is_idle = [&](hand::Finger finger) {
    const SkinGroup& group = groups_[index_of(finger)][0];
    const std::vector<geometry::DistanceSample> samples =
        look_at_skin(group, product, posture).sample;
    return std::all_of(samples.begin(), samples.end(), [](const geometry::DistanceSample& sample) {
      return sample.distance > kIdleGap;
    });
  };
  using Pair = std::pair<hand::Finger, hand::Finger>;
  for (const auto& [finger, neighbour] : {Pair{hand::Finger::kIndex, hand::Finger::kMiddle},
                                          Pair{hand::Finger::kRing, hand::Finger::kMiddle},
                                          Pair{hand::Finger::kLittle, hand::Finger::kRing}}) {
    if (!is_idle(finger)) continue;
    hand::Posture resting = posture;
    for (int level = 0; level < 3; ++level) {
      const hand::JointDof& dof = hand_->skeleton.dof(flexion_of(finger, level));
      resting[dof.dof] =
          std::clamp(std::min(posture[dof.dof], posture[flexion_of(neighbour, level)] + kIdleMore),
                     dof.lower, dof.upper);
    }
    if (is_free(product, limits, finger, resting)) posture = resting;
  }
}

double HandCloser::make_room(const HeldProduct& whole, const DepthLimits& limits,
                             hand::Posture& posture) const {
  double left = 0.0;
  for (const hand::Finger finger : kFingers) {
    const auto depth_in = [&](const hand::Posture& at) {
      const SkinLook look = look_at_skin(groups_[index_of(finger)][0], whole, at);
      double deepest = 0.0;
      for (const geometry::DistanceSample& sample : look.sample) {
        deepest = std::max(deepest, -sample.distance - limits.finger);
      }
      return deepest;
    };
    double depth = depth_in(posture);
    for (int round = 0; round < kRoomRounds && depth > 0.0; ++round) {
      hand::Posture best = posture;
      double least = depth;
      for (const int level : {0, 1}) {
        for (const double by : {kRoomStep, -kRoomStep}) {
          hand::Posture next = posture;
          const hand::JointDof& dof = hand_->skeleton.dof(flexion_of(finger, level));
          next[dof.dof] = std::clamp(next[dof.dof] + by, dof.lower, dof.upper);
          if (level == 1) {
            const hand::JointDof& dip = hand_->skeleton.dof(flexion_of(finger, 2));
            next[dip.dof] =
                std::clamp(next[dip.dof] + kDipPerPipFlexion * by, dip.lower, dip.upper);
          }
          const double here = depth_in(next);
          if (here >= least) continue;
          least = here;
          best = next;
        }
      }
      if (least >= depth) break;
      posture = best;
      depth = least;
    }
    left = std::max(left, depth);
  }
  return left;
}

std::array<double, hand::kSegmentCount> HandCloser::depths(const HeldProduct& product,
                                                           const hand::Posture& posture) const {
  const std::vector<geometry::DistanceSample> samples =
      look_at_skin(palm_, product, posture).sample;
  std::array<double, hand::kSegmentCount> depth;
  depth.fill(-kSkinRange);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    double& deepest = depth[index_of(palm_.segment[k])];
    deepest = std::max(deepest, -samples[k].distance);
  }
  return depth;
}

HoldMeasure HandCloser::measure(const HeldProduct& product, const DepthLimits& limits,
                                const hand::Posture& posture, const Vec3& axis_in_hand) const {
  const SkinLook look = look_at_skin(all_, product, posture);
  const std::vector<geometry::DistanceSample>& samples = look.sample;
  HoldMeasure measure;
  measure.penetration.fill(-kSkinRange);
  const Vec3 u = axis_in_hand.unitOrthogonal();
  const Vec3 v = axis_in_hand.cross(u);
  std::vector<double> turns;
  Vec3 under_thumb = Vec3::Zero(), under_fingers = Vec3::Zero();  // normals times area
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double depth = -samples[k].distance;
    double& deepest = measure.penetration[index_of(all_.segment[k])];
    if (!is_palmar(all_.region[k])) {
      if (depth > 0.0) measure.other_area += all_.area[k];
      measure.deepest_other = std::max(measure.deepest_other, depth);
      continue;
    }
    deepest = std::max(deepest, depth);
    if (depth <= 0.0) continue;
    // Skin gives way beside the deepest place: as under a ball, about half of the overlap stays.
    const double limit = all_.segment[k] == hand::Segment::kPalm ? limits.palm : limits.finger;
    const double share = std::clamp((depth / limit - kLeastShare) / kShareRange, 0.0, 1.0);
    measure.contact_area += share * all_.area[k];
    const Vec3 normal = product.product_from_hand.rotation.conjugate() * samples[k].normal;
    if (const auto finger = hand::finger_of(all_.segment[k])) {
      (*finger == hand::Finger::kThumb ? under_thumb : under_fingers) +=
          share * all_.area[k] * normal;
    }
    if (Vec3(normal - axis_in_hand * axis_in_hand.dot(normal)).norm() > 0.5) {
      turns.push_back(std::atan2(v.dot(normal), u.dot(normal)));
    }
  }
  measure.opposed_area =
      std::max(0.0, -under_thumb.dot(under_fingers) / std::max(1e-9, under_fingers.norm()));
  std::array<bool, hand::kFingerCount> touches{};
  for (std::size_t s = 1; s < measure.penetration.size(); ++s) {
    measure.touching += std::clamp(0.25 * (measure.penetration[s] + 3.0), 0.0, 1.0);
    if (measure.penetration[s] <= 0.0) continue;
    ++measure.segments;
    touches[index_of(*hand::finger_of(static_cast<hand::Segment>(s)))] = true;
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

}  // namespace palmar::grasp
