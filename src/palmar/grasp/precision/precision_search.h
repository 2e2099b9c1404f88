// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/precision/opposing_points.h"
#include "palmar/grasp/precision/precision_grip.h"
#include "palmar/grasp/precision/precision_shape.h"

namespace palmar::grasp {

/// A hand with its fingertips on a product, not pressed yet.
struct PrecisionHold {
  FingertipProblem problem;  ///< goals where the fingertips came down
  FingertipSolution solution;
  double width = 0.0;  ///< between thumb and the other fingertips, mm
  double cost = 0.0;   ///< smaller is better
};

struct PrecisionSearch {
  std::vector<PrecisionHold> holds;  ///< best first, each unlike the ones before
  int candidates = 0;                ///< placements looked at
  double widest = 0.0;               ///< between the points of a pair, mm
  int pairs = 0;                     ///< opposing pairs on the product within the hand's width
};

/// Where a product's shape offers itself to a grip. Every opposing pair of points is tried with the
/// thumb on either side and the hand in twelve turns about the line between them, the fingers
/// opened to its width: how deep would the hand be in the product (FingertipIk::clash_of)? The
/// best two dozen get their fingertips set down on the surface by inverse kinematics. Costs:
///
///     where people take such a thing (opposing_points.h), strain / 10 of the posture,
///     (tilt / 40 deg)^2 / 2 per fingertip, (clash / 1 mm)^2, (miss / 0.5 mm)^2,
///     (balance / 30 deg)^2: thumb's force against the mean of the others',
///     (offset / 10 mm)^2: of the thumb's line of action from the middle of
///     the others, a pen's long end over the web of the thumb: up to 0.8
PrecisionSearch search_precision_grip(const FingertipIk& ik, const GripOpenings& openings,
                                      const product::Product& product,
                                      const PrecisionGripOptions& options,
                                      const Progress& progress);

/// Fingertips on given goals, in the openings' order of fingers; started from several turns.
/// `wrist`: as PrecisionGripOptions has it.
PrecisionSearch solve_precision_targets(const FingertipIk& ik, const GripOpenings& openings,
                                        const product::Product& product,
                                        const std::vector<FingertipGoal>& goals,
                                        const std::optional<Vec3>& wrist, const Progress& progress);

/// Turns of the hand about the line between two points that a search looks at.
inline constexpr int kOpposedTurns = 12;

/// The hand opened to two points and turned about their line by `turn` of kOpposedTurns, which are
/// counted from that of the product's axes which is most nearly across the line.
OpposedPlace opposed_place(const hand::Hand& hand, const GripOpening& opening,
                           const PinchShape& shape, const Vec3& thumb, const Vec3& others,
                           int turn);

/// Fingertips come down on the surface from where an opened hand has them: `cost` is that of the
/// posture, the skin's tilt, what is missed and run into, and of how well thumb and fingers oppose.
PrecisionHold set_down(const FingertipIk& ik, const GripOpenings& openings,
                       const product::Product& product, const OpposedPlace& place);

}  // namespace palmar::grasp
