// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hands/phantom/person/person_dispersion.h"
#include "palmar/hand/hand.h"

namespace palmar::phantom {

/// Fingers as broad as a survey's (surveyed_widenings(); seven tenths of that in depth), fingertips
/// that are slimmer or blunter, joints thicker than the shafts beside them, webs that
/// lie elsewhere: `skin` is that of `hand`, vertex by vertex, in its own posture.
void shape_fingers(geometry::TriangleMesh& skin, const hand::Hand& hand, std::uint64_t seed,
                   const PersonDispersion& dispersion);

/// Sixty bumps and hollows of an outline of one's own, 8 to 22 mm wide and 0.35 mm times `relief`
/// high (deviation).
void give_relief(geometry::TriangleMesh& skin, const hand::Skeleton& skeleton, std::uint64_t seed,
                 double relief);

/// Draws the stub of the forearm out until no field of view shows its end, which becomes square.
void lengthen_forearm(geometry::TriangleMesh& skin, const Vec3& wrist);

}  // namespace palmar::phantom
