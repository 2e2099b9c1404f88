// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/geometry/distance_field.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/grasp/finger_cones.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/posable_skin.h"

namespace palmar {

/// How deep skin may go into the product, mm.
struct DepthLimits {
  double palm = 7.0;
  double finger = 4.0;
};

/// Where the product stands and what it is, seen from a closing hand.
struct HeldProduct {
  const DistanceField* distance = nullptr;
  Rigid3 product_from_hand;
  Vec3 grip_point = Vec3::Zero();  ///< on the grip axis, product frame, mm
  Vec3 grip_axis = Vec3::UnitX();  ///< unit, product frame
  double diameter = 35.0;  ///< of the circle with the grip's girth, mm; fingers preshape to it
};

/// What a posed hand and a product do to each other, before skin gives way.
struct HoldMeasure {
  double contact_area = 0.0;   ///< palmar skin inside the product, mm^2
  double thumb_area = 0.0;     ///< of that the thumb's phalanges and its ball, mm^2
  double other_area = 0.0;     ///< dorsal or side skin inside the product, mm^2
  double deepest_other = 0.0;  ///< how deep that goes, mm
  int segments = 0;            ///< phalanges whose palmar skin touches
  double touching = 0.0;       ///< the same without steps: from 0 to 1 each over 2 mm of approach
  int fingers = 0;             ///< fingers (thumb included) with such a segment
  std::array<double, kSegmentCount> penetration{};  ///< deepest palmar skin, mm; negative: gap
  double wrap = 0.0;  ///< share of a turn about the grip axis between the outermost contacts
};

/// Closes one hand round a product, joint by joint, MCP -> PIP -> DIP, until the deepest skin of a
/// finger reaches its limit or the joint the end of its range (Xie 2014, 5.5.1).
///
/// Every step is so small that no skin point can pass through the product unseen: the distance
/// field changes by at most the way travelled. Fingers stop at each other's round cones (at most
/// 1.5 mm of give) and at the palm's.
class HandCloser {
 public:
  /// Looks at skin vertices `spacing` [mm] apart (0: at all of them). Keeps a pointer to `hand`.
  HandCloser(const Hand& hand, double spacing);

  const Hand& hand() const { return *hand_; }

  /// Fingers straight and a little spread, thumb out to the side.
  Posture open_posture() const;

  /// Largest travel [mm] of the product along `direction` (unit, hand frame) before palmar skin
  /// reaches a limit. Phalanges hold back a part of theirs, to be used in closing.
  double free_travel(const HeldProduct& product, const DepthLimits& limits, const Posture& posture,
                     const Vec3& direction, double longest) const;

  /// Closes the four fingers; the thumb stays as in `start`. `stops` tells what stopped them.
  Posture close_fingers(const HeldProduct& product, const DepthLimits& limits, Posture start,
                        std::array<SegmentStop, kSegmentCount>& stops) const;

  /// Opposes the thumb: of several ways for its metacarpal the one after which its pads hold most.
  /// Answers the CMC angles to ask wrap_thumb() for.
  struct ThumbWay {
    double cmc_flexion = 0.0;    ///< rad
    double cmc_abduction = 0.0;  ///< rad
  };
  ThumbWay find_thumb_way(const HeldProduct& product, const DepthLimits& limits,
                          const Posture& start, const Vec3& grip_axis_in_hand) const;

  /// Brings the thumb's metacarpal as far as it can go towards the given CMC angles [rad], then
  /// bends MP and IP.
  Posture wrap_thumb(const HeldProduct& product, const DepthLimits& limits, const Posture& start,
                     double cmc_flexion, double cmc_abduction,
                     std::array<SegmentStop, kSegmentCount>& stops) const;

  /// Contact and penetrations in a posture. `axis_in_hand`: grip axis, unit.
  HoldMeasure measure(const HeldProduct& product, const Posture& posture,
                      const Vec3& axis_in_hand) const;

 private:
  struct Group {
    PosableSkin skin;
    std::vector<Segment> segment;
    std::vector<Region> region;
    std::vector<double> area;  ///< skin that the vertex stands for, mm^2
  };
  struct Advance;
  struct Obstacle {
    RoundCone cone;
    double give = 0.0;  ///< mm
  };

  Advance advance(const Group& group, const HeldProduct& product, const DepthLimits& limits,
                  const std::vector<Obstacle>& obstacles, const Posture& from,
                  const Posture& to) const;
  std::vector<Obstacle> thumb_obstacles(const Posture& posture) const;
  /// Fingers reach out already bent to the handle's curvature, as far as it is out of the way.
  Posture preshaped(const HeldProduct& product, const DepthLimits& limits, Finger finger,
                    double diameter, double share, const Posture& start) const;
  bool is_free(const HeldProduct& product, const DepthLimits& limits, Finger finger,
               const Posture& posture) const;
  Posture close_finger(const HeldProduct& product, const DepthLimits& limits, Finger finger,
                       Posture posture, std::array<SegmentStop, kSegmentCount>& stops) const;
  double thumb_score(const HeldProduct& product, const Posture& posture,
                     const Vec3& grip_axis_in_hand) const;

  const Hand* hand_;
  std::vector<Group> groups_;  ///< per finger and joint level: what the joint moves
  Group palm_;                 ///< palmar skin of the whole hand
  Group all_;
  FingerCones cones_;
};

/// Range of one degree of freedom.
inline double lower_of(const Hand& hand, Dof dof) { return hand.skeleton.dof(dof).lower; }
inline double upper_of(const Hand& hand, Dof dof) { return hand.skeleton.dof(dof).upper; }

/// The flexion of a finger's joint at level 0 (MCP, thumb MP), 1 (PIP, thumb IP), 2 (DIP).
Dof flexion_of(Finger finger, int level);
/// Abduction of a finger's MCP joint; of the CMC joint for the thumb.
Dof abduction_of(Finger finger);

}  // namespace palmar
