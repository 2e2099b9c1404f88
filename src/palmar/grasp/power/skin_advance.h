// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/power/finger_cones.h"
#include "palmar/grasp/power/posable_skin.h"
#include "palmar/grasp/power/site_distance.h"

namespace palmar::grasp {

constexpr double kSkinRange = kSiteBand;  ///< mm; farther skin needn't know how far
constexpr double kNeighbourGive = 1.5;    ///< mm; skin of two fingers pressed together
constexpr int kLongestAdvance = 60;       ///< steps

/// All but the thumb.
inline constexpr std::array<hand::Finger, 4> kFingers = {
    hand::Finger::kIndex, hand::Finger::kMiddle, hand::Finger::kRing, hand::Finger::kLittle};

/// How deep skin may go into the product, mm.
struct DepthLimits {
  double palm = 7.0;
  double finger = 4.0;
};

/// Where the product stands and what it is, seen from a closing hand.
struct HeldProduct {
  const geometry::DistanceField* distance = nullptr;
  geometry::Rigid3 product_from_hand;
  Vec3 grip_point = Vec3::Zero();  ///< on the grip axis, product frame, mm
  Vec3 grip_axis = Vec3::UnitX();  ///< unit, product frame
  double diameter = 35.0;       ///< of the circle with the grip's girth, mm; fingers preshape to it
  bool is_end_pressed = false;  ///< the thumb may press on a face across the grip axis
};

/// Skin that one joint moves.
struct SkinGroup {
  PosableSkin skin;
  std::vector<hand::Segment> segment;
  std::vector<hand::Region> region;
  std::vector<double> area;  ///< skin that the vertex stands for, mm^2
};

/// Per digit and joint level the skin that the joint moves; the thumb's third is the CMC's.
using DigitGroups = std::array<std::array<SkinGroup, 3>, hand::kFingerCount>;

/// Where the skin of a group stands in the hand, and what the product's distance says there.
struct SkinLook {
  std::vector<Vec3> in_hand, in_product;         ///< mm
  std::vector<geometry::DistanceSample> sample;  ///< normals in the product frame
};
SkinLook look_at_skin(const SkinGroup& group, const HeldProduct& product,
                      const hand::Posture& posture);

struct Obstacle {
  RoundCone cone;
  double give = 0.0;  ///< mm
};

/// How closely a movement is followed.
struct AdvanceCare {
  double tolerance = 0.02;  ///< mm; how near to a limit counts as there
  double glide = 1.5;       ///< mm; longest step along a surface between two looks
};

/// How far a movement got.
struct Advance {
  hand::Posture posture;
  double share = 0.0;  ///< of the way from `from` to `to`
  bool is_stopped = false;
  bool by_product = false;
  hand::Segment segment{};  ///< whose skin was at its limit
  /// Per phalanx from the palm, mm.
  std::array<double, 3> deepest = {-kSkinRange, -kSkinRange, -kSkinRange};

  /// Why a phalanx whose joint was to move stands where it does.
  StopReason reason_for(hand::Segment moved) const;
};

/// Moves skin from one posture towards another until some of it reaches its limit in the product
/// or meets an obstacle. Every step is so small that no skin point can pass through the product
/// unseen: the distance field changes by at most the way travelled.
Advance advance_skin(const SkinGroup& group, const HeldProduct& product, const DepthLimits& limits,
                     const std::vector<Obstacle>& obstacles, const hand::Posture& from,
                     const hand::Posture& to, const AdvanceCare& care = {});

/// Whether a sample says more than "far".
bool is_near(const geometry::DistanceSample& sample);

constexpr bool is_palmar(hand::Region region) { return region != hand::Region::kDorsum; }
/// 0, 1, 2 from the palm; -1 if the segment is none of the finger's.
int level_of(hand::Finger finger, hand::Segment segment);
/// The flexion of a finger's joint at level 0 (MCP, thumb MP), 1 (PIP, thumb IP), 2 (DIP).
hand::Dof flexion_of(hand::Finger finger, int level);
/// Abduction of a finger's MCP joint; of the CMC joint for the thumb.
hand::Dof abduction_of(hand::Finger finger);

}  // namespace palmar::grasp
