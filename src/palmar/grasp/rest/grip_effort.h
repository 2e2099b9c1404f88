// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "palmar/grasp/equilibrium/thumb_meeting.h"
#include "palmar/grasp/rest/grip_mechanics.h"
#include "palmar/grasp/rest/muscle_step.h"
#include "palmar/hand/tendons/hand_muscles.h"

namespace palmar::grasp {

/// The activations of all muscles of a hand that holds a product, one problem in every step of the
/// search for rest:
///
///     min sum a_i^3   so that the joints and the product come to rest and the squeeze is the one
///                     asked for,   0 <= a_i <= the largest allowed,
///
/// with contact forces linear in the coordinates about the state last looked at. Joints that flex
/// fingers go where muscles and product bring them. The thumb's joints and all abduction are held
/// where they were closed, by whatever moments their muscles can give; where these are too weak
/// they give way, together and within bounds, and the muscles are asked once more with that; where
/// they aren't any more, they come back. What gives way stretches its muscles, which then hold more
/// than they can pull: by 23.4 times the stretch over the fibres' length (short-range stiffness,
/// Cui et al. 2008), at most 30 % (Cook & McDonagh 1995). Fingers and thumb that meet press on each
/// other (ThumbMeeting). The wrist's muscles, with those of the digits that cross it, hold the load
/// and what the fingers' flexors pull at the wrist. Squeeze that the muscles can't give is what is
/// missed first; the wrist doesn't give way.
class GripEffort {
 public:
  /// `limit`: largest activation, times the muscles of HandMuscles.
  /// `closed`: the posture from which held angles give way and to which they come back.
  GripEffort(const hand::Hand& hand, double limit, const hand::Posture& closed,
             const hand::WristPosture& wrist = {});

  /// Muscles and passive moments of the loaded digits in a posture; `wrist`: moment of the load
  /// in the sense of the wrist's flexion, N mm.
  void look(const hand::Posture& posture, const std::array<bool, kGripJoints>& is_loaded,
            std::vector<ThumbPress> presses = {}, double wrist = 0.0);

  /// Moments of ligaments, of slack muscles and of thumb and fingers on each other, onto forces and
  /// stiffness of the coordinates.
  void add_passive(GripVector& force, GripMatrix& stiffness) const;
  /// Moments of the muscles as last solved for and of the stops about the angles.
  GripVector moments() const;
  /// Largest moment of the muscles among the angles, N mm.
  double strongest() const;
  /// Whether the angle has an equation: skin beyond it is loaded, its muscles take part, and no
  /// ligament holds it both ways.
  bool is_judged(int joint) const;
  /// An angle that muscles and product turn; else it is held.
  static bool is_free(int joint) {
    return grip_finger(joint) != hand::Finger::kThumb && joint % hand::kDigitDofs != 1;
  }

  struct Step {
    GripVector way = GripVector::Zero();  ///< of the coordinates
    bool is_short = false;                ///< the squeeze asked for can't be reached
  };
  /// Solves for the activations in the state last looked at (MuscleStep).
  Step solve(const GripEquations& equations);

  /// What the contact forces of the state last looked at take of the muscles, all digits and the
  /// wrist in one problem.
  struct Strength {
    double share =
        0.0;  ///< least share of `limit` (least_strength_share()); infinite if none could
    bool is_by_wrist = false;  ///< the fingers alone would need less
    hand::HandLoad load;       ///< of contact, of thumb and fingers on each other, on the wrist
  };
  Strength strength_of(const GripVector& contact_force) const;

  /// As last solved for: activations, of `limit`, and moments of stops.
  struct Activations {
    Eigen::VectorXd activation;  ///< of the digits' muscles, then the wrist's
    GripVector stops = GripVector::Zero();
  };
  const Activations& activations() const { return now_; }
  void set(const Activations& activations) { now_ = activations; }

 private:
  void stretch(const hand::Posture& posture, Eigen::Index first_muscle, hand::DigitMuscles& digit);

  hand::HandMuscles muscles_;
  hand::Posture closed_;
  double limit_;
  std::array<std::optional<hand::DigitMuscles>, hand::kFingerCount>
      digits_;  ///< those that take part
  std::array<bool, kGripJoints> is_loaded_{};
  std::vector<ThumbPress> presses_;
  double wrist_load_ = 0.0;
  GripVector given_way_ = GripVector::Zero();  ///< of held angles, rad
  /// Of held angles, by the muscles that they stretch, N mm/rad.
  Eigen::Matrix<double, kGripJoints, kGripJoints> stretch_stiffness_ =
      Eigen::Matrix<double, kGripJoints, kGripJoints>::Zero();
  Eigen::MatrixXd at_limit_;           ///< moments at the limit, angles x muscles, N mm
  Eigen::RowVectorXd wrist_at_limit_;  ///< about the wrist, N mm
  Activations now_;
};

}  // namespace palmar::grasp
