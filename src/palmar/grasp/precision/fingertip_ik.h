// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/power/finger_cones.h"
#include "palmar/grasp/precision/fingertip_point.h"

namespace palmar::grasp {

/// One fingertip and where it is to go. Product frame, mm.
struct FingertipGoal {
  FingertipPoint fingertip;
  Vec3 point = Vec3::Zero();
  std::optional<Vec3> normal;  ///< unit, out of the product there; the skin's is to oppose it
  double depth = 0.0;          ///< how far below `point` the fingertip ends up, mm
  /// May come down elsewhere on the product's surface; `point` is where it would like to be.
  bool is_sliding = false;
  double square = 0.3;  ///< spread of its skin's normal about the product's, rad
  double slide = 6.0;   ///< how far it likes to go from there, mm
  /// The product only leans there: no part of what thumb and fingers press against each other.
  bool is_rest = false;
};

struct FingertipProblem {
  std::vector<FingertipGoal> goals;
  const geometry::DistanceField* product = nullptr;  ///< not to run into; none: thin air
  hand::Posture natural;                             ///< the hand likes to be near this one
  hand::Posture start;
  geometry::Rigid3 product_from_hand;  ///< at the start
  bool is_hand_free = true;            ///< whether the hand may move against the product
  std::array<bool, hand::kFingerCount> is_finger_free = {true, true, true, true, true};
  bool is_refining = false;  ///< start is near the answer: only the last, sharpest stage
  int max_iterations = 60;
};

struct FingertipSolution {
  hand::Posture posture;
  geometry::Rigid3 product_from_hand;
  std::vector<Vec3> reached;  ///< where the fingertips are, product frame, mm, per goal
  std::vector<Vec3> normal;   ///< of the product there, as far as known (else zero), per goal
  std::vector<double> miss;   ///< to what was asked (sliding: to the surface), mm, per goal
  std::vector<double> tilt;   ///< of the skin's normal against the product's, rad, per goal
  double worst_miss = 0.0;    ///< mm
  double strain = 0.0;        ///< how unnatural the posture is: sum of its squared terms
  double clash = 0.0;         ///< deepest a finger or the palm is in the product or a finger, mm
  int iterations = 0;
};

/// Inverse kinematics of the whole hand: 6 degrees of freedom of the hand against the product and
/// the 20 of thumb and fingers, held to their ranges of motion. Levenberg-Marquardt with exact
/// derivatives (finger_motion.h) and active bounds on
///
///     sum |x_i - (t_i - depth_i m_i)|^2 / s^2          fingertips to their points
///   + sum |n_i + m_i|^2 / square_i^2                   skin perpendicular to the product
///   + |m_thumb + mean m of the others|^2 / 0.3^2       they push against each other (sliding only)
///   + sum (q - q_nat)^2 / s_q^2                        near the natural posture of the grip
///   + sum (q_DIP - 2/3 q_PIP)^2 / 0.2^2                tendons bend both joints together
///   + sum (difference of neighbours' MCP, PIP)^2       fingers move together
///   + sum max(0, overlap)^2 / 0.7^2                    fingers and product don't cross (in mm)
///
/// first with s = 3 mm, then
/// 0.5 and 0.05 mm, so that reaching comes first in the end. Fingers are round cones
/// (finger_cones.h), against the product rows of balls along them; so are palm and forearm.
/// Deterministic. All weights are our choice.
class FingertipIk {
 public:
  explicit FingertipIk(const hand::Hand& hand);  ///< keeps a pointer to the hand

  const hand::Hand& hand() const { return *hand_; }

  /// From the problem's start. What can't be reached is missed: see `miss`.
  FingertipSolution solve(const FingertipProblem& problem) const;

  /// How deep balls of fingers, palm and forearm are in the product beyond what they may be: the
  /// sum, mm. A quick look at a placement. Fingers of `contacts` may touch with their last phalanx.
  double clash_of(const geometry::DistanceField& product, const hand::Posture& posture,
                  const geometry::Rigid3& product_from_hand,
                  const std::vector<FingertipPoint>& contacts) const;

 private:
  friend class FingertipSystem;
  /// Ball of flesh about a bone.
  struct Ball {
    Vec3 centre = Vec3::Zero();  ///< reference posture, mm
    double radius = 0.0;
    std::optional<hand::Segment> phalanx;
    std::optional<hand::Finger> finger;  ///< of a phalanx or metacarpal; none: forearm
  };

  const hand::Hand* hand_;
  FingerCones cones_;
  std::vector<Ball> balls_;
};

}  // namespace palmar::grasp
