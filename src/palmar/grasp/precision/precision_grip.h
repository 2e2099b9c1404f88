// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/grip.h"

namespace palmar::grasp {

/// Where a fingertip is to touch the product.
struct FingertipTarget {
  hand::Finger finger{};
  Vec3 point = Vec3::Zero();  ///< product frame, mm; on the surface
};

/// A hand opened to the distance of two opposite points of a product, its pads beside them. Product
/// frame, mm.
struct OpposedPlace {
  Vec3 thumb = Vec3::Zero(), others = Vec3::Zero();  ///< on the surface
  geometry::Rigid3 product_from_hand;
};

struct PrecisionGripOptions {
  Grip grip = Grip::kTripod;             ///< a precision or the lateral grip
  std::vector<FingertipTarget> targets;  ///< empty: found from the product's shape
  /// Fingertips come down on the surface from here, and nothing is searched; goes without
  /// `targets`.
  std::optional<OpposedPlace> from;
  /// With `targets`: where the wrist likes to be, from the middle between the fingertips; unit,
  /// product frame. Unset: where the hand is least bent.
  std::optional<Vec3> wrist;
  double fingertip_depth = 2.0;  ///< mm; how deep pads are pressed into the product
  PlacementRequest placement;    ///< hints for the search where `targets` is empty
  int candidates = 200;          ///< placements to try, coarse to fine
  void check() const;            ///< throws UsageError: field, value, allowed range
};

/// Precision grip (docs/method/precision.md): pads of the grip's fingers on points of the product
/// by inverse kinematics under the ranges of motion, fingers not crossing, near their natural
/// coordination. Deterministic. Not being able to reach is a status with a message that says which
/// finger misses by how much, never an exception. Throws UsageError (bad options, a target farther
/// than 2 mm from the surface), Cancelled.
Grasp close_precision_grip(const hand::Hand& hand, const product::Product& product,
                           const PrecisionGripOptions& options, const Progress& progress = {});

class OpenedHand;
/// The same by a hand whose openings are kept, for several grips or places.
Grasp close_precision_grip(OpenedHand& hand, const product::Product& product,
                           const PrecisionGripOptions& options, const Progress& progress = {});

/// Makes one of a precision grip's runners-up the grasp itself; what it was becomes that runner-up.
void take_runner_up(const hand::Hand& hand, const product::Product& product, std::size_t index,
                    Grasp& grasp);

}  // namespace palmar::grasp
