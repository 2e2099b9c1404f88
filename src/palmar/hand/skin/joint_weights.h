// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// The two weights of eq. 2-7 for every joint, on the skin of the reference posture.
///
/// w1 runs along the bone: with y the coordinate along the joint (mm, distal positive, 0 at the
/// centre) it is 0 at y <= -h, 1 at y >= h and linear between. The half width h differs between the
/// palmar (contracting) and dorsal (extending) side and changes smoothly between. When a joint of
/// palmar depth R bends by theta, skin on the palmar side keeps the share 1 - theta R / (2 h) of
/// its length, so the palmar band must be wider than theta R, or the skin turns over; h is chosen
/// from the depth measured on the skin and the joint's range.
///
/// w2 is the share of a finger in a vertex: 1 where the finger's own bones are nearer than any
/// other's (in distances scaled by an ellipse about each bone), 0 where they are not; smooth across
/// webs and palm. Shares of the five fingers and the palm add up to 1, so that skin between two
/// fingers bent together goes with both, and a finger never drags its neighbour.
///
/// Throws InputError if the mesh is not closed and 2-manifold.
///
/// Source: Xie 2014, eq. 2-7; shares that add up to 1 are an addition.
std::vector<JointWeights> make_joint_weights(const geometry::TriangleMesh& skin,
                                             const Skeleton& skeleton);

}  // namespace palmar::hand
