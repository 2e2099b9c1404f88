// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar {

/// What ended the closing of a segment.
enum class StopReason {
  kLimitDepth,     ///< its penetration reached the limit
  kRangeOfMotion,  ///< its joint reached the end of its range without the limit depth
  kProximalStop,   ///< held by a joint nearer to the palm; itself not moved further
  kDistalStop,     ///< a segment nearer to the tip reached its limit first
  kOtherFinger,    ///< another finger is in the way
  kNotReached,     ///< no contact though its joint is fully closed
};
std::string name_of(StopReason reason);  ///< "limit_depth", "range_of_motion", ...

struct SegmentStop {
  Segment segment{};
  StopReason reason = StopReason::kNotReached;
  double penetration = 0.0;  ///< largest penetration of its palmar skin, mm (negative: gap)
};

/// Where and how to hold; unset fields are found from the product's shape.
struct PlacementRequest {
  std::optional<Vec3> at;    ///< point of the grip axis that lies in mid-palm, product frame, mm
  std::optional<Vec3> axis;  ///< direction of the grip axis (towards the thumb side), product frame
  std::optional<double> turn;  ///< turn of the hand about the grip axis, rad
};

struct PowerGraspOptions {
  double palm_limit_depth = 7.0;    ///< mm; Xie 2014, 5.5.1
  double finger_limit_depth = 4.0;  ///< mm; Xie 2014, 5.5.1
  PlacementRequest placement;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

enum class GraspStatus {
  kHeld,         ///< segments of at least three fingers in contact
  kPartlyHeld,   ///< contact, but fewer than three fingers
  kTooLarge,     ///< the fingers can't reach round it
  kTooSmall,     ///< the fist closes without holding it
  kNotGraspable  ///< no place on the product that a power grip can take (flat sheet ...)
};
std::string name_of(GraspStatus status);  ///< "held", "partly_held", "too_large", ...

/// One hand holding one product.
struct Grasp {
  GraspStatus status = GraspStatus::kNotGraspable;
  std::string message;  ///< one sentence for people: why not held, which fingers are open
  Posture posture;
  Rigid3 product_from_hand;
  Vec3 grip_point = Vec3::Zero();  ///< product frame, mm
  Vec3 grip_axis = Vec3::UnitX();  ///< unit, product frame
  double grip_girth = 0.0;         ///< perimeter of the product's section at the grip, mm
  std::array<SegmentStop, kSegmentCount> stops;
};

/// Power grasp (METHOD.md section 3; Xie 2014, 5.5.1). Deterministic. Not being able to hold the
/// product is a status, never an exception. Throws UsageError on bad options, Cancelled.
Grasp close_power_grasp(const Hand& hand, const Product& product,
                        const PowerGraspOptions& options = {}, const Progress& progress = {});

}  // namespace palmar
