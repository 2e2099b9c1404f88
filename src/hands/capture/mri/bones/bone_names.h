// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/bone_outline.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// Which bone is which.
struct BoneNames {
  std::vector<MarrowRegion> bones;  ///< those with a name, in the model's order, then the others
  std::vector<std::string> name;    ///< per bone; "" for none
  hand::Side side = hand::Side::kRight;
  double misfit = 0.0;        ///< mean cost of a bone of the model; 1 is that of a good guess
  double other_misfit = 0.0;  ///< the same as the other hand
  std::vector<std::string> notes;
};

/// What is known of the side beforehand (see SurfaceOptions).
struct KnownSide {
  std::optional<hand::Side> side = {};
  double doubted_below = 0.0;
};

/// Names bones after those of a model and finds the side.
///
/// The model, and its mirror image, are fitted into the skin (fit_posture_to_mesh()); that shows
/// where every bone must roughly be. Bones of the scan and of the model are paired (pair_bones()),
/// with the model as long as it came out and 6 % shorter, 6 % and 12 % longer: skin of a slender
/// hand doesn't show its length and its size. Whatever costs least is taken; so is the side, unless
/// it is known.
///
/// Regions that no bone of the model wants are left out unless they are larger than 150 mm^3 and
/// darkly enclosed.
BoneNames name_bones(const std::vector<MarrowRegion>& candidates, const ScanLevels& levels,
                     const geometry::TriangleMesh& skin, const hand::Hand& model,
                     const KnownSide& known = {}, const Progress& progress = {});

}  // namespace palmar::capture
