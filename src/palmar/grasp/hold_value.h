// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/grip.h"
#include "palmar/hand/anatomy.h"
#include "palmar/product/parts/part_place.h"

namespace palmar::grasp {

/// A fingertip of a precision grip, in the coordinates of the part that is held.
struct HoldFingertip {
  hand::Finger finger{};
  product::PartPlace place;
};

/// Where a hold's part lay in the product's frame, so that it means the same on the product's next
/// version, whose part may be counted from its other end. Unit vectors.
struct HoldAnchor {
  Vec3 along = Vec3::UnitX();  ///< from the part's beginning to its end
  Vec3 zero = Vec3::UnitZ();   ///< from which turns are counted, where the hand is
};

/// How people take hold of a product: by which part of it, in which grip, where along it and how
/// turned about it. It says nothing of a hand: hands of every size and both sides can take the same
/// hold, so hands differ in size and not in how they hold.
///
/// A left hand takes the mirror image: the same part, place and direction, its palm on the same
/// side of the part.
struct Hold {
  int part = 1;           ///< number of the part (ProductPart::number)
  std::string part_name;  ///< for people: "handle", "body"; not used to find the part
  Grip grip = Grip::kMediumWrap;
  double along = 0.5;  ///< where on the part the hand is, a fraction of its length
  /// What of the hand is there, a share of the breadth of the four fingers: 0 their middle, 0.5 the
  /// index finger's outer edge, -0.5 the little finger's. Hands of other size keep that edge there.
  double edge = 0.0;
  /// +1: the thumb's side of the hand points to growing `along`; -1: to where it starts.
  int toward = 1;
  double turn = 0.0;  ///< about the part's axis from its turn 0: where the palm lies, rad
  /// The palm lies over the end of the part that `along` is nearer to (a knob, a lid); `turn` then
  /// says where the thumb's side points, and `toward` nothing.
  bool is_over_end = false;
  std::vector<HoldFingertip> fingertips;  ///< of a precision grip; empty of a power grip
  /// Of a precision grip: from the middle between the fingertips to the wrist, unit, product frame;
  /// unset: where the hand is least bent.
  std::optional<Vec3> wrist;
  std::optional<HoldAnchor> anchor;  ///< where it was found; unset: not said
};

/// One reason for or against a hold. Scores add up; each is the natural logarithm of how much
/// rarer people are taken to choose such a hold, so none is above 0. Of a hold to hand a product
/// over: rarer than the likeliest one, so some may be.
struct HoldTerm {
  std::string name;    ///< "girth", "room for fingers", ...
  double value = 0.0;  ///< what was measured
  std::string unit;    ///< of the value: "mm", "N mm", "deg", ... ; "" for a share or a count
  double score = 0.0;  ///< 0 at best
  std::string words;   ///< the value for people, a clause: "44 mm thick, 23 % of hand length"
};

}  // namespace palmar::grasp
