// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/distance_transform.h"
#include "hands/imaging/volume.h"

namespace palmar::capture {

/// What holds the hand in the scanner and shows in the image.
struct Fixture {
  imaging::VoxelMask mask;  ///< its voxels; empty if there is none
  double signal = 0.0;      ///< its mean
  double boundary = 0.0;    ///< signal that parts it from skin
  double volume = 0.0;      ///< mm^3
};

/// Finds paper clay, foam or the like that touches a hand. It is known by five things together:
/// - nothing bright within 5 mm, and in its middle not even within 12 mm: a hand has skin of 1 to
///   3 mm over fat, and fat or marrow near any of its muscle;
/// - it lies open to the air;
/// - it has no skin: 2 mm below its surface the signal is that of its inside, within 15 %;
/// - its inside is even: the signal deviates by 15 % at most, where a finger has bone and fat;
/// - more than 1 cm^3; of several pieces those that have the largest one's signal, within 15 %.
/// From there it reaches through all that connects to it, is thicker than 2.4 mm and is darker than
/// half way between its own signal and the skin's; if the two are too alike to be distinguished, to
/// 2 mm from the fat.
///
/// `tissue`: hand and fixture; `air`: what is round it; `bright`, `skin`, `noise`: signals.
Fixture find_fixture(const imaging::Volume& smooth, const imaging::VoxelMask& tissue,
                     const imaging::VoxelMask& air, double bright, double skin, double noise);

}  // namespace palmar::capture
