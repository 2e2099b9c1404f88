// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "hands/capture/scan/found_creases.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/posture/posture_from_mesh.h"

namespace palmar::capture {

/// Joints of a person of whom a scan shows the skin.
struct PlacedSkeleton {
  hand::Skeleton skeleton;          ///< the scan's posture is its reference; hand frame of the scan
  geometry::Rigid3 scan_from_hand;  ///< mm
  hand::Side side = hand::Side::kRight;
  hand::MeshFit fit;  ///< where the model was in the scan at first
};

/// Places a model's joints into a scan by what lies round them:
/// 1. fit_posture_to_mesh() with one overall size shows posture and place, the model as it is or
///    with fingers 8 % shorter, 8, 16 or 24 % longer: whatever lies nearest;
/// 2. the skin of the model, posed so, is bent onto the scan (register_skin());
/// 3. every joint goes with the skin round it: an affine map of the vertices within a finger's
///    breadth, least squares with weights exp(-d^2 / 2 h^2), held towards a rigid motion so that
///    skin that slid along itself doesn't shear it.
/// `mesh`: mm, oriented outwards, may have holes; any frame. `side`: of the hand, if known; a
/// scan's axes may have been mirrored on the way, so what is known is held against what is found.
/// `model` may be of either side. Throws InputError "`name`: ..." if no hand, or that of the other
/// side, lies in it.
PlacedSkeleton place_skeleton(const hand::Hand& model, const geometry::TriangleMesh& mesh,
                              std::optional<hand::Side> side, const std::string& name,
                              const Progress& progress = {});

/// Moves the fingers' hinges along their fingers to where the creases over them say: a joint lies
/// distal of its crease by a share of the phalanx (HandCreases). Creases differ between people by
/// about a millimetre; the skin of a slim finger hardly shows the place (two to four millimetres on
/// synthetic persons). So 0.85 of the difference counts.
/// The wrist goes with its crease. The hand frame, and so `laid.scan_from_hand`, follows.
void shift_to_creases(PlacedSkeleton& placed, const FoundCreases& creases);

}  // namespace palmar::capture
