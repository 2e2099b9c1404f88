// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "palmar/geometry/distance/analytic_distance.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/precision/fingertip_ik.h"

namespace palmar::grasp {

/// Round a ball or a disc, fingers slide up to this far and touch with their sides.
inline constexpr double kBallSlide = 8.0;   // mm
inline constexpr double kBallSquare = 0.9;  // rad
/// Round less, five fingertips don't fit.
inline constexpr double kFiveFit = 25.0;  // mm

/// The fingers that take part in a precision or lateral grip, thumb first, and what of them
/// touches.
std::vector<FingertipPoint> fingertips_of(const hand::Hand& hand, Grip grip);

/// Where the long end of a pen leans in the writing tripod: the thumb's side of the index finger's
/// root, over the web.
FingertipGoal web_goal(const hand::Hand& hand);

/// How a hand likes to hold by a grip: the posture that the others are measured against. From the
/// stored postures (named_postures.h), with straighter end joints for a pinch of pads and spread
/// fingers round a ball.
hand::Posture natural_posture(const hand::Skeleton& skeleton, Grip grip);

/// A hand opened for a thing of some width between thumb and the other fingertips. Of a disc, the
/// width is its diameter and `others` the place opposite to the thumb.
struct GripOpening {
  double width = 0.0;  ///< mm
  hand::Posture posture;
  Vec3 thumb = Vec3::Zero();   ///< thumb's fingertip point, hand frame, mm
  Vec3 others = Vec3::Zero();  ///< mean of the others'
  double strain = 0.0;         ///< of the posture against natural_posture()
  /// Of the pen (towards its long end) or disc that it was opened for, hand frame; else zero.
  Vec3 axis = Vec3::Zero();
  Vec3 centre = Vec3::Zero();  ///< of that, between the fingertips, hand frame, mm
};

/// Openings from nearly closed to the widest that the hand can do with its fingertips perpendicular
/// to the thing (within 0.5 mm and 40 degrees). In between take the nearest.
class GripOpenings {
 public:
  GripOpenings(const FingertipIk& ik, Grip grip);

  Grip grip() const { return grip_; }
  const std::vector<FingertipPoint>& fingertips() const { return fingertips_; }
  const std::vector<GripOpening>& all() const { return openings_; }
  double widest() const { return openings_.empty() ? 0.0 : openings_.back().width; }
  const GripOpening& at(double width) const;

 private:
  Grip grip_;
  std::vector<FingertipPoint> fingertips_;
  std::vector<GripOpening> openings_;
  FingertipGoal web_;  ///< of the writing tripod

  /// A hand with its fingertips about something of `width`, before they are put on it.
  struct Start {
    FingertipProblem problem;
    geometry::DistanceFieldPtr thing;  ///< a ball, disc or pen; none: fingertips go to points in
                                       ///< thin air
  };
  Start start_for(const hand::Skeleton& skeleton, const hand::Posture& natural,
                  const hand::Posture& start, double width) const;
  std::optional<GripOpening> solved(const FingertipIk& ik, const Start& start, double width) const;
};

/// A hand with its openings in each grip, which are found when they are first asked for. For one
/// thread; the hand must outlive it.
class OpenedHand {
 public:
  explicit OpenedHand(const hand::Hand& hand) : ik_(hand) {}
  OpenedHand(const OpenedHand&) = delete;
  OpenedHand& operator=(const OpenedHand&) = delete;

  const hand::Hand& hand() const { return ik_.hand(); }
  const FingertipIk& ik() const { return ik_; }
  const GripOpenings& openings(Grip grip);

 private:
  FingertipIk ik_;
  std::map<Grip, GripOpenings> openings_;
};

}  // namespace palmar::grasp
