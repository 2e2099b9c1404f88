// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "palmar/geometry/rigid3.h"
#include "palmar/hand/skeleton.h"

namespace palmar::hand {

/// Four degrees of freedom in every digit.
inline constexpr int kDigitDofs = 4;

/// Bodies of a digit from the palm (0) to the distal phalanx. Of a finger: 1 what the MCP's first
/// axis moves, without bone of its own, 2 proximal, 3 middle, 4 distal phalanx. Of the thumb: 1
/// metacarpal, 2 proximal, 3 distal phalanx.
inline constexpr int kDigitBodies = 5;
int body_count(Finger finger);
int distal_body(Finger finger);

/// Rate of a rigid motion per radian of one angle: the point x moves with omega cross x + v.
struct Twist {
  Vec3 omega = Vec3::Zero();
  Vec3 v = Vec3::Zero();  ///< mm/rad

  Vec3 at(const Vec3& x) const { return omega.cross(x) + v; }
};

/// One digit in a posture, hand frame.
struct PosedDigit {
  Finger finger = Finger::kIndex;
  std::array<geometry::Rigid3, kDigitBodies> body;  ///< posed_from_reference
  std::array<Dof, kDigitDofs> dof{};                ///< from the palm outwards
  std::array<Twist, kDigitDofs> twist;              ///< of everything that the angle moves
  std::array<int, kDigitDofs> moves{};              ///< bodies from this one on move with the angle

  Vec3 place(int b, const Vec3& reference_point) const { return body[b] * reference_point; }
  /// Velocity of a posed point of a body per radian of the k-th angle.
  Vec3 velocity(int k, int b, const Vec3& posed_point) const {
    return b < moves[k] ? Vec3(Vec3::Zero()) : twist[k].at(posed_point);
  }
};

/// Same displacements as pose_skeleton(); hinges turn about their axes, the thumb's CMC along its
/// interpolated limit postures, whose rate is a central difference (exact to 1e-8). At the
/// reference posture, where the CMC passes from one limit to the other, it is the mean of both
/// sides.
PosedDigit pose_digit(const Skeleton& skeleton, Finger finger, const Posture& posture);

/// Whether the angle flexes a joint (and doesn't abduct or turn it).
bool is_flexion(Dof dof);

/// The angles of a digit from the palm outwards: flexion and abduction of CMC or MCP, then MP and
/// IP or PIP and DIP. The order of PosedDigit::dof.
std::array<Dof, kDigitDofs> digit_dofs(Finger finger);
/// The digit that an angle moves; not of the wrist's.
Finger finger_of(Dof dof);

/// The digit's body on which a segment's skin lies; the palm: 0.
int body_of(Segment segment);

}  // namespace palmar::hand
