// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/capture/bone_regions.h"
#include "palmar/hand/hand.h"

namespace palmar {

/// What a bone looks like from far: enough to tell which one it is.
struct BoneOutline {
  Vec3 centre = Vec3::Zero();  ///< of the volume, mm
  Vec3 axis = Vec3::UnitX();   ///< unit, along the bone; either way round
  double length = 0.0;         ///< along it, mm
  double width = 0.0;          ///< mean extent across, mm
  std::array<Vec3, 2> ends = {Vec3::Zero(), Vec3::Zero()};  ///< where the axis leaves the bone
};
BoneOutline outline_of(const TriangleMesh& mesh);
BoneOutline outline_of(const MarrowRegion& marrow);

/// Which bone is which.
struct BoneNames {
  std::vector<MarrowRegion> bones;  ///< those with a name, in the model's order, then the others
  std::vector<std::string> name;    ///< per bone; "" for none
  Side side = Side::kRight;
  double misfit = 0.0;        ///< mean cost of a bone of the model; 1 is that of a good guess
  double other_misfit = 0.0;  ///< the same as the other hand
  std::vector<std::string> notes;
};

/// What is known of the side beforehand (see SurfaceOptions).
struct KnownSide {
  std::optional<Side> side = {};
  double doubted_below = 0.0;
};

/// Names bones after those of a model and tells the side.
///
/// 1. The model, and its mirror image, are laid into the skin (fit_posture_to_mesh()); that tells
///    where every bone must roughly be.
/// 2. Bones of the scan and of the model are paired one to one with least cost in all (Hungarian
///    method, Kuhn 1955): squares of the distance of centres over 5 mm, of the angle between the
///    axes of long bones over 0.35 rad, of the logarithm of the lengths' ratio over 0.3; a bone
///    that stays alone costs 16.
/// 3. The bones know better than the skin where their neighbours are: the model's bones are moved
///    by what their pairs and the pairs of those next in the chain were off, and 2 is repeated.
/// 4. Where a shaft's marrow is too thin to be seen, a bone comes in two parts: parts without a
/// name
///    are joined to one within 10 mm that has a name, if that lowers its cost by 1 at least.
/// 5. The side is that with the lower cost, unless it is known.
///
/// Regions that no bone of the model wants are left out unless they are larger than 150 mm^3 and
/// darkly enclosed.
BoneNames name_bones(std::vector<MarrowRegion> candidates, const ScanLevels& levels,
                     const TriangleMesh& skin, const Hand& model, const KnownSide& known = {},
                     const Progress& progress = {});

/// Least-cost pairing: column of each row, -1 for rows that stay alone at `alone` each. `cost` is
/// rows x columns.
std::vector<int> least_cost_pairs(const std::vector<std::vector<double>>& cost, double alone);

}  // namespace palmar
