// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/hand/hand.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// A point of a product that is pressed while it is held.
struct Button {
  std::string name;
  Vec3 point = Vec3::Zero();  ///< product frame, mm; on the surface
  /// Force of the finger on the product, product frame, N. Zero: 1 N straight into the surface.
  Vec3 force = Vec3::Zero();
};

/// One finger sent to one button.
struct FingerReach {
  hand::Finger finger{};
  bool is_reached = false;  ///< its pad comes within 1 mm, not tilted by more than 60 degrees, and
                            ///< nothing is in its way
  bool is_blocked = false;  ///< it would be more than 3 mm in the product or in another finger
  double miss = 0.0;        ///< pad to button, mm
  double tilt = 0.0;        ///< of the pad against the direction of pressing, rad
  double margin = 0.0;      ///< smallest distance of the finger's joints to the ends of their
                            ///< ranges, rad; 0 at an end
  hand::Dof tightest{};     ///< the joint with that margin
  bool is_awkward = false;  ///< reached with less than 8 degrees of margin, a pad tilted by more
                            ///< than 35 degrees, or DIP more than 25 degrees from 2/3 PIP
  bool is_grip_kept = false;  ///< the rest of the hand still holds; see is_grip_kept_without()
  hand::Posture posture;      ///< of the whole hand, pressing
};

/// Who presses a button.
struct ButtonReach {
  Button button;
  std::vector<FingerReach> fingers;  ///< thumb to little finger
  std::optional<hand::Finger> best;  ///< reached, grip kept, not awkward if possible, most margin
  std::string message;               ///< one sentence for people
};

/// Which fingers reach buttons with their pads while the rest of the hand stays where it is. The
/// finger's joints alone move (fingertip_ik.h), from four starting postures; it may not pass
/// through the product nor its neighbours at the end, the way there isn't looked at. Where
/// several postures reach, that with the most margin counts. Throws UsageError for a button more
/// than 2 mm off the surface (naming it) or a force that is not finite.
std::vector<ButtonReach> reach_buttons(const hand::Hand& hand, const product::Product& product,
                                       const Grasp& grasp, const std::vector<Button>& buttons,
                                       const Progress& progress = {});

/// Skin of one segment on the product.
struct TouchingSegment {
  hand::Segment segment{};
  Vec3 point = Vec3::Zero();    ///< centre of the touching skin, product frame, mm
  Vec3 normal = Vec3::UnitZ();  ///< mean outward normal of the product there, unit
  double depth = 0.0;           ///< deepest skin, mm
};
std::vector<TouchingSegment> touching_segments(const hand::Hand& hand,
                                               const product::Product& product, const Grasp& grasp);

/// A simple rule for whether a product stays in a hand of which one finger has left: two of the
/// other digits or one and the palm touch, two of their normals are at least 120 degrees apart
/// (they oppose with friction of 0.58), and at least one contact doesn't face away from the push:
/// some part of the hand stands behind. No balance of forces is computed.
bool is_grip_kept_without(hand::Finger finger, const std::vector<TouchingSegment>& touching,
                          const Vec3& force);

/// Who reaches what on the whole surface.
struct ReachMap {
  std::vector<int> finger;     ///< per vertex of the product: 0 thumb ... 4 little, -1 nobody
  std::vector<double> margin;  ///< of that finger, rad; 0 where nobody reaches
  std::vector<double> miss;    ///< of the nearest finger that may leave, mm, at least; 0 where one
                               ///< reaches, 50 at most
  double reached_area = 0.0;   ///< of the surface, mm^2
  int points = 0;              ///< that were tried; vertices take the values of the nearest one
};

/// About `points` places spread over the surface, each pressed straight in by every finger with
/// the grip kept. The value of a vertex is that of the nearest place that faces the same way.
ReachMap map_reach(const hand::Hand& hand, const product::Product& product, const Grasp& grasp,
                   int points = 500, const Progress& progress = {});

}  // namespace palmar::grasp
