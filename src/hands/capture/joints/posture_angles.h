// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "hands/capture/joints/joint_measures.h"
#include "palmar/hand/skeleton.h"

namespace palmar::capture {

/// Angles within the ranges of `skeleton` at which it comes nearest to the bones of a posture:
/// min sum_b sum_i |T_b(theta) x_bi - N_b x_bi|^2 over the moments' points x of the bones b of each
/// finger, T_b from pose_skeleton(). What no bone shows stays at the reference posture. The wrist's
/// angles come from radius and ulna, if these are seen whole enough.
hand::Posture fit_angles(const hand::Skeleton& skeleton, const ReferenceHand& hand,
                         const PostureMotions& motions);

/// Where the model puts the thumb's bones in a posture if its CMC joint has two fixed axes; the
/// angles are fitted likewise. A limit posture of the CMC joint turns about its own axis only.
std::map<std::string, geometry::Rigid3> fit_fixed_axis_thumb(const hand::Skeleton& skeleton,
                                                             const FixedAxisCmc& cmc,
                                                             const ReferenceHand& hand,
                                                             const PostureMotions& motions,
                                                             hand::ScanPosture posture);

/// Where a posed skeleton puts a finger's bones (metacarpal of the thumb and phalanges), by name.
std::map<std::string, geometry::Rigid3> bones_of_finger(const hand::PosedSkeleton& posed,
                                                        hand::Finger finger);

}  // namespace palmar::capture
