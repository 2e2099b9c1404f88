// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/friction/friction.h"
#include "palmar/study/assessment/grasp_indices.h"
#include "palmar/study/study_record.h"

namespace palmar::study {

/// Smallest share s of its ranges of motion, taken about the relaxed posture, with which the hand
/// can take the posture: every angle lies within with_range_share(hand, s). `hand` has its whole
/// range. Above 1 for a posture that even that hand can't take.
double range_share_of(const hand::Hand& hand, const hand::Posture& posture);

/// Smallest grip strength of a dynamometer [N], as the measure of a person's muscles, with which a
/// hand can hold the task's force. That is the grip force that is stated, or what friction needs to
/// hold the load where the hand touches the product, whichever is more: of all normal forces whose
/// friction cones balance the load those of least sum (least_grip_force(), stability.h), however
/// the fingers would share them out.
///
/// In a power grip that came to rest its muscles say what that force takes: the share of strength
/// at rest (Balance::strength_use), in proportion to the force,
///
///     strength = use x (task's force / grip force at rest) x strength of the muscles at rest.
///
/// Elsewhere, and where no muscles could hold the hand as it rests: task's force /
/// strength_share(grip), what people reach on a dynamometer. Weaker people can't hold it, and
/// stronger ones may still fail. Infinite where no forces hold the load; 0 without load and force.
struct StrengthQuestion {
  double friction = 0.5;  ///< of skin on the product
  contact::ProductLoad load;
  Vec3 mass_centre = Vec3::Zero();  ///< product frame, mm; unless the load has its own
  grasp::Grip grip = grasp::Grip::kMediumWrap;
  double stated_force = 0.0;     ///< N, grip force that the task asks for; 0: none
  double muscle_strength = 1.0;  ///< at rest, over that of HandMuscles (BalanceOptions::strength)
};
/// `rest`: how the grasp came to rest; nothing: it didn't.
double strength_needed(const hand::Hand& hand, const contact::ContactResult& contact,
                       const StrengthQuestion& question, const grasp::Balance* rest = nullptr);

/// Longest nail that the posture allows [mm], at most kLongestNail: of the nails of all fingers the
/// one with the least room. A nail is a flat strip, two thirds of the distal segment wide, that
/// leaves the fingertip straight along the distal phalanx, four tenths of the segment's thickness
/// dorsal of the most distal skin; its room ends where it meets the product or the palm's skin. 0
/// where pressing the pulp in has brought the product there already. Curved nails, nails that bend,
/// and fingers that give way to them have more.
inline constexpr double kLongestNail = 30.0;  // mm
double nail_room_of(const hand::Hand& hand, const hand::Posture& posture,
                    const std::vector<Vec3>& posed_skin, const geometry::Rigid3& product_from_hand,
                    const product::Product& product);

/// All three of one grasp. `hand` has its whole range of motion, even where the grasp was found
/// with less of it.
GraspDemand demand_of(const hand::Hand& hand, const product::Product& product,
                      const HeldProductState& held, const StrengthQuestion& question);

}  // namespace palmar::study
