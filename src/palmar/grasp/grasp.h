// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/hold_value.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// What ended the closing of a segment.
enum class StopReason {
  kLimitDepth,     ///< its penetration reached the limit
  kRangeOfMotion,  ///< its joint reached the end of its range without the limit depth
  kProximalStop,   ///< held by a joint nearer to the palm; itself not moved further
  kDistalStop,     ///< a segment nearer to the tip reached its limit first
  kOtherFinger,    ///< another finger is in the way
  kNotReached,     ///< no contact though its joint is fully closed
  kGiven,          ///< nothing was closed: the posture was measured or given
};
std::string name_of(StopReason reason);  ///< "limit_depth", "range_of_motion", ...

struct SegmentStop {
  hand::Segment segment{};
  StopReason reason = StopReason::kNotReached;
  double penetration = 0.0;  ///< largest penetration of its palmar skin, mm (negative: gap)
};

/// Where and how to hold; unset fields are found from the product's shape.
struct PlacementRequest {
  std::optional<Vec3> at;    ///< point of the grip axis that lies in mid-palm, product frame, mm
  std::optional<Vec3> axis;  ///< direction of the grip axis (towards the thumb side), product frame
  std::optional<double> turn;  ///< turn of the hand about the grip axis, rad
  std::optional<Box3> region;  ///< hold it by the surface that lies in this box, product frame, mm
  /// Placement in full; only the fingers close. Nothing else may be given with it.
  std::optional<geometry::Rigid3> product_from_hand;
};

struct PowerGraspOptions {
  std::optional<Grip> grip;         ///< a power grip; unset: the one that suits the shape
  double palm_limit_depth = 7.0;    ///< mm; Xie 2014, 5.5.1
  double finger_limit_depth = 4.0;  ///< mm; Xie 2014, 5.5.1
  PlacementRequest placement;
  int candidates = 200;  ///< placements that the search may try
  void check() const;    ///< throws UsageError: field, value, allowed range
};

enum class GraspStatus {
  kHeld,         ///< segments of at least three fingers in contact
  kPartlyHeld,   ///< contact, but fewer than three fingers
  kTooLarge,     ///< the fingers can't reach round it
  kTooSmall,     ///< the fist closes without holding it
  kNotGraspable  ///< no place on the product that a power grip can take (flat sheet ...)
};
std::string name_of(GraspStatus status);  ///< "held", "partly_held", "too_large", ...

/// One fingertip that a precision grip puts on the product.
struct FingertipContact {
  hand::Finger finger{};
  Vec3 target = Vec3::Zero();   ///< point of the product it is to touch, product frame, mm
  Vec3 reached = Vec3::Zero();  ///< where its pad is, product frame, mm
  Vec3 normal = Vec3::UnitZ();  ///< of the product's surface at the target, outwards
  double miss = 0.0;            ///< distance of the two, mm
};

/// Another way of holding the same product that the search found, best first.
struct GraspRunnerUp {
  Grip grip = Grip::kMediumWrap;
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  double score = 0.0;  ///< of the search; comparable within one search
  /// What another of the ranked holds is; nothing of another place of the same one.
  std::optional<Hold> hold = std::nullopt;
  std::string hold_words = {};
};

/// One hand holding one product.
struct Grasp {
  Grip grip = Grip::kMediumWrap;
  GraspStatus status = GraspStatus::kNotGraspable;
  std::string message;  ///< one sentence for people: why not held, which fingers are open
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  Vec3 grip_point = Vec3::Zero();  ///< product frame, mm
  Vec3 grip_axis = Vec3::UnitX();  ///< unit, product frame
  double grip_girth = 0.0;         ///< perimeter of the product's section at the grip, mm
  std::array<SegmentStop, hand::kSegmentCount> stops;
  std::vector<FingertipContact> fingertips;  ///< of a precision grip, else empty
  std::optional<Hold> hold;  ///< which hold it is; unset: placed by coordinates or given
  std::string hold_words;    ///< "medium wrap of the handle, 40 % along it"; empty without hold
  std::optional<product::PartKind> hold_kind;  ///< kind of the part that is held, with `hold`
  std::vector<HoldTerm> hold_terms;            ///< what speaks for and against it, if it was ranked
  double score = 0.0;                          ///< of the search that found it
  int candidates = 0;                          ///< placements that the search tried
  std::vector<GraspRunnerUp> runners_up;       ///< best first
};

}  // namespace palmar::grasp
