// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <vector>

#include "hands/capture/joints/joint_measures.h"
#include "hands/capture/joints/posture_angles.h"

namespace palmar::capture {

/// Errors of the finger bones and the thumb's metacarpal in every posture (Xie 2014, tables 2-2 to
/// 2-4): mean distance of the reference bone's vertices from the surface of its counterpart after
/// each of the motions: the registered one, that of fixed axes, and for the thumb that of the
/// skeleton with interpolated CMC joint at `postures`' angles. `tracked` names the counterparts.
std::vector<BoneError> bone_errors(
    const ReferenceHand& hand, const std::map<hand::ScanPosture, ScanSurfaces>& scans,
    const std::map<hand::ScanPosture, std::vector<BoneMotion>>& tracked,
    const MotionsByPosture& motions, const std::map<hand::ScanPosture, hand::Posture>& postures,
    const hand::Skeleton& skeleton, const FixedAxisCmc& fixed_cmc);

}  // namespace palmar::capture
