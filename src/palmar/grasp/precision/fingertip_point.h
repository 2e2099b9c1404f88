// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// Which part of a fingertip touches the product.
enum class FingertipPart {
  kPad,         ///< middle of the pulp of the distal phalanx
  kTip,         ///< end of the pulp, below the nail's edge
  kRadialSide,  ///< thumb side of the middle phalanx near its end, where a key is pressed
  kTipSide,     ///< thumb side of the distal phalanx, where a pen lies
  kWeb,         ///< thumb side of the finger's root, where a pen's long end leans
  kMiddlePad    ///< palmar side of the middle phalanx, on which a ring of scissors lies
};
std::string_view name_of(FingertipPart part);  ///< "pad", "tip", "radial_side", ...

/// A point of the skin by which a finger touches things. Reference posture, hand frame, mm.
struct FingertipPoint {
  hand::Finger finger{};
  hand::Segment segment{};  ///< phalanx that carries it
  FingertipPart part{};
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();  ///< unit, out of the skin
  Triangle triangle{};          ///< of the skin, vertices ...
  Vec3 weight = Vec3::Zero();   ///< ... and their shares in the point, summing to 1
};

/// Where the ray from the phalanx' bone line meets the skin. The line runs from the phalanx' joint
/// to the next one or the fingertip; palmar is where the tip goes when the joint flexes, radial
/// along the joint's axis towards the thumb's side. Found from the joints alone, so it holds for
/// any hand, left or right:
///
///     pad          from 55 % of the distal phalanx, palmar
///     tip          from 72 %, half way between palmar and distal (50 degrees)
///     radial side  from 65 % of the middle phalanx, radial and 20 degrees palmar
///     tip side     from 40 % of the distal phalanx, radial and 30 degrees palmar
///     web          from 25 % of the proximal phalanx (farther where the palm's skin is there),
///                  radial and 20 degrees dorsal
///     middle pad   from 55 % of the middle phalanx, palmar
///
/// The shares are our choice. Throws Error naming the finger where the ray meets no skin, or for a
/// side or a middle phalanx of the thumb.
FingertipPoint fingertip_point(const hand::Hand& hand, hand::Finger finger, FingertipPart part);

}  // namespace palmar::grasp
