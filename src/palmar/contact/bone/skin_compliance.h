// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "palmar/contact/bone/node_compliance.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// How the skin of a hand gives way as the elasticity of the incompressible tissue between it and
/// the bones has it. Times the shear modulus, forces [N] in any direction move the skin by
///
///     C = w H + P (R - w S H S^T) P^T   [1/mm],   R = S C_e S^T
///
/// R: the elements' (node_compliance.h), at nodes; H: half-space (half_space_tensor.h), which has
/// what is narrower than an element, over the share w near by; P: interpolation from the nodes to
/// the vertices, of something smooth. C fades with the distance over the depth of the tissue, as
/// the bones hold it; pairs further apart than `reach` are left out.
struct SkinCompliance {
  std::vector<int> vertex;         ///< skin vertices that have it, ascending
  std::vector<std::size_t> begin;  ///< per entry of `vertex`, one more at the end
  std::vector<int> other;          ///< index into `vertex`, at most the entry's own, ascending
  /// By how much a force on `other` moves the entry, x, y, z of the hand frame, 1/mm; what isn't
  /// listed follows by symmetry.
  std::vector<Eigen::Matrix3f> tensor;
  /// Tissue nearest to the skin of each region, mm^3.
  std::array<double, hand::kRegionCount> volume{};
};

struct SkinComplianceOptions {
  hand::TissueMeshOptions mesh;
  /// mm; our choice: see docs/method/tissue-on-bone.md for what it leaves out.
  double reach = 18.0;
};

/// The skin of fingers and palm, up to kBackOfHand beyond the border of the palm's regions. The
/// back of the hand and the forearm have none. Throws as make_tissue_mesh(), surface_compliance().
SkinCompliance skin_compliance(const hand::Hand& hand, const SkinGeometry& skin,
                               const SkinComplianceOptions& options = {});

/// Of the mirrored hand (template_hand.h): x turns its sign.
SkinCompliance mirrored(const SkinCompliance& compliance);

inline constexpr double kBackOfHand = 12.0;  ///< mm; our choice

/// From the nodes to pairs of vertices up to `reach` [mm] apart. Without volumes.
SkinCompliance skin_compliance(const SkinGeometry& skin, const NodeCompliance& nodes, double reach);

}  // namespace palmar::contact
