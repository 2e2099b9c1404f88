// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/hand/hand.h"

namespace palmar::grasp {

inline constexpr double kForcePower = 2.0;  ///< of depth, with which contact forces grow
inline constexpr double kAngleStep = 1e-3;  ///< rad; of differences
inline constexpr double kLeastDepth = 0.3;  ///< mm; shallower contacts count as that deep

/// How the angles of the digits move the skin of a hand.
class SkinMotion {
 public:
  /// Keeps a reference to the hand.
  explicit SkinMotion(const hand::Hand& hand);

  /// d(posed vertex)/d(angle), hand frame, of those vertices that the angle moves.
  struct Column {
    std::vector<int> row;     ///< index into the vertices
    std::vector<Vec3> speed;  ///< mm/rad
  };
  /// By a difference; `posed`: the whole skin in `posture`, hand frame, mm.
  Column column(const hand::Posture& posture, const std::vector<Vec3>& posed, int joint,
                const std::vector<int>& vertices) const;

  /// Adds the forces of skin on skin of a solved contact [N mm], and how they stiffen the angles
  /// [N mm/rad]; marks the angles that move such skin.
  void add_touches(const contact::ContactResult& contact, const GripState& state,
                   const std::vector<Vec3>& posed, GripVector& force, GripMatrix& stiffness,
                   std::array<bool, kGripJoints>& is_loaded) const;

 private:
  const hand::Hand* hand_;
  std::array<std::vector<char>, kGripJoints> is_moved_;  ///< per joint and skin vertex
};

}  // namespace palmar::grasp
