// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// Model bones for a hand that has none of its own: 14 phalanges, 5 metacarpals, 8 carpals, and the
/// ends of radius and ulna in the stub of the forearm. Closed 2-manifold meshes with outward
/// triangles, hand frame, reference posture, mm. The order is fixed: per finger from thumb to
/// little finger metacarpal and phalanges, then carpals, radius, ulna. Radius and ulna have no
/// segment: they move with the forearm.
///
/// Shapes are drawn, not measured: flared base, slender shaft, head with two condyles and a groove
/// between; tuft at the distal phalanges; carpals are ellipsoids. What is held to measurements:
/// - Phalanges run from the head of the next proximal bone (joint centre plus head radius, and a
///   joint space of 1.2 mm) to their own head; distal phalanges end 3.8 mm before the skin (thumb
///   5.7 mm; Buryanov & Kotiuk 2010, Table I).
/// - Metacarpals of the fingers have the lengths of the same table, scaled by the distance from
///   wrist to third MCP joint against 92.5 mm (64.6 mm of metacarpal, 35 mm of carpus, less the
///   radius of the head). That of the thumb fills the way from CMC to MP joint.
/// - Widths are shares of the finger's breadth at its interphalangeal joints; the tuft is 7 mm wide
///   in a typical hand.
///
/// Bones sit nearer to the dorsal skin than to the palmar skin. Wherever a shape would come nearer
/// to the skin than `kLeastSkinOverBone`, or to a bone before it than `kLeastJointSpace`, it is
/// shrunk towards its axis.
std::vector<Bone> make_bones(const geometry::TriangleMesh& skin, const Skeleton& skeleton);

inline constexpr double kLeastSkinOverBone = 1.5;  ///< mm; nail bed 1.6 mm
inline constexpr double kLeastJointSpace = 0.8;    ///< mm; cartilage of two bones

}  // namespace palmar::hand
