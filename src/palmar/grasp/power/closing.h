// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/power/finger_cones.h"
#include "palmar/grasp/power/posable_skin.h"
#include "palmar/grasp/power/skin_advance.h"
#include "palmar/hand/tendons/digit_pose.h"

namespace palmar::grasp {

/// What a posed hand and a product do to each other, before skin gives way.
struct HoldMeasure {
  double contact_area = 0.0;   ///< palmar skin that will stay in contact, estimated, mm^2
  double opposed_area = 0.0;   ///< of that the thumb's phalanges against the fingers', mm^2
  double other_area = 0.0;     ///< dorsal or side skin inside the product, mm^2
  double deepest_other = 0.0;  ///< how deep that goes, mm
  int segments = 0;            ///< phalanges whose palmar skin touches
  double touching = 0.0;       ///< the same without steps: from 0 to 1 each over 4 mm of approach
  int fingers = 0;             ///< fingers (thumb included) with such a segment
  std::array<double, hand::kSegmentCount>
      penetration{};  ///< deepest palmar skin, mm; negative: gap
  double wrap = 0.0;  ///< share of a turn about the grip axis between the outermost contacts
};

/// How fingers go round a product.
struct ClosingStyle {
  /// Share of their range of abduction by which fingers are fanned out before closing; 0: they lie
  /// side by side. For round bodies.
  double spread = 0.0;
  /// MCP joints stay within 20 degrees of this flexion, rad; PIP and DIP close: a hook.
  std::optional<double> hook;
  /// A hook's thumb rests on the product, too: on top of a cup's handle.
  bool has_thumb = false;

  bool uses_thumb() const { return !hook || has_thumb; }
};

/// Closes one hand round a product, joint by joint, MCP -> PIP -> DIP, until the deepest skin of a
/// finger reaches its limit or the joint the end of its range (Xie 2014, 5.5.1). DIP goes along
/// with PIP at two thirds of its angle (Rijkpema & Girard 1991) and may leave that by 25 degrees to
/// lie on the product: back, so that the middle phalanx comes down to it, or further on.
///
/// Every step is so small that no skin point can pass through the product unseen: the distance
/// field changes by at most the way travelled. Fingers stop at each other's round cones (at most
/// 1.5 mm of give) and at the palm's.
class HandCloser {
 public:
  /// Looks at skin vertices `spacing` [mm] apart (0: at all of them). Keeps a pointer to `hand`.
  HandCloser(const hand::Hand& hand, double spacing);
  HandCloser(const HandCloser&) = delete;
  HandCloser& operator=(const HandCloser&) = delete;

  const hand::Hand& hand() const { return *hand_; }

  /// Fingers straight and a little spread, thumb out to the side.
  const hand::Posture& open_posture() const { return open_posture_; }

  /// Largest travel [mm] of the product along `direction` (unit, hand frame) before palmar skin
  /// reaches a limit, the hand open. Phalanges hold back a part of theirs, to be used in closing;
  /// for a hook all of it is theirs.
  double free_travel(const HeldProduct& product, const DepthLimits& limits,
                     const ClosingStyle& style, const Vec3& direction, double longest) const;

  /// Closes the four fingers; the thumb stays as in `start`. Fingers begin with the abduction that
  /// `start` gives them and are then spread or drawn together up to `rounds` times, until they lie
  /// side by side. `stops` says what stopped them.
  hand::Posture close_fingers(const HeldProduct& product, const DepthLimits& limits,
                              const ClosingStyle& style, hand::Posture start, int rounds,
                              std::array<SegmentStop, hand::kSegmentCount>& stops) const;
  /// The posture from which close_fingers() starts: open, fanned out as the style says.
  hand::Posture start_posture(const ClosingStyle& style) const;

  /// Brings the thumb one way from in front of the palm across it, until skin of its phalanges
  /// reaches its limit or a finger; where it has no room there, from beside the palm. A thing a
  /// little larger has a thumb a little less bent. A hook's thumb comes beside the palm, on top of
  /// what is hooked.
  hand::Posture close_thumb(const HeldProduct& product, const DepthLimits& limits,
                            const ClosingStyle& style, hand::Posture start,
                            std::array<SegmentStop, hand::kSegmentCount>& stops) const;

  /// Whether the thumb, stretched out in front of the palm, is nowhere in the product beyond its
  /// limit. Other digits as in `posture`.
  bool has_room_for_thumb(const HeldProduct& product, const DepthLimits& limits,
                          const hand::Posture& posture) const;

  /// Fingers that were closed on a part of the product alone go out of the way of the whole of it,
  /// back and sides included, until no skin is deeper than a finger's limit. How much deeper some
  /// still is, mm.
  double make_room(const HeldProduct& whole, const DepthLimits& limits,
                   hand::Posture& posture) const;

  /// HoldMeasure::penetration alone.
  std::array<double, hand::kSegmentCount> depths(const HeldProduct& product,
                                                 const hand::Posture& posture) const;
  /// Contact and penetrations in a posture. `axis_in_hand`: grip axis, unit.
  HoldMeasure measure(const HeldProduct& product, const DepthLimits& limits,
                      const hand::Posture& posture, const Vec3& axis_in_hand) const;

 private:
  /// Fingers reach out already bent to the handle's curvature, as far as it is out of the way.
  hand::Posture preshaped(const HeldProduct& product, const DepthLimits& limits,
                          hand::Finger finger, double diameter, double share,
                          const hand::Posture& start) const;
  bool is_free(const HeldProduct& product, const DepthLimits& limits, hand::Finger finger,
               const hand::Posture& posture) const;
  /// Reaches out and closes; several tries if the tip meets the product too early.
  hand::Posture reach_and_close(const HeldProduct& product, const DepthLimits& limits,
                                const ClosingStyle& style, hand::Finger finger,
                                const hand::Posture& start,
                                std::array<SegmentStop, hand::kSegmentCount>& stops) const;
  hand::Posture close_finger(const HeldProduct& product, const DepthLimits& limits,
                             const ClosingStyle& style, hand::Finger finger, hand::Posture posture,
                             std::array<SegmentStop, hand::kSegmentCount>& stops) const;

  /// `posture` with the thumb at shares of its ranges.
  hand::Posture with_thumb(hand::Posture posture,
                           const std::array<double, hand::kDigitDofs>& share) const;
  void rest_idle_fingers(const HeldProduct& product, const DepthLimits& limits,
                         hand::Posture& posture) const;

  const hand::Hand* hand_;
  AdvanceCare care_;
  hand::Posture open_posture_;
  DigitGroups groups_;
  SkinGroup palm_;  ///< palmar skin of the whole hand
  SkinGroup all_;
  std::vector<Vec3> open_palm_;  ///< palm_ in the open posture, hand frame, mm
  FingerCones cones_;
};

/// Range of one degree of freedom.
inline double lower_of(const hand::Hand& hand, hand::Dof dof) {
  return hand.skeleton.dof(dof).lower;
}
inline double upper_of(const hand::Hand& hand, hand::Dof dof) {
  return hand.skeleton.dof(dof).upper;
}

}  // namespace palmar::grasp
