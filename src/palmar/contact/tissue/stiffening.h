// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/contact/response/skin_response.h"
#include "palmar/contact/solve/contact_system.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// What the shear modulus of a hand's skin depends on, besides the depth of a contact.
struct SkinStiffness {
  /// Per level (low, nominal, high) and vertex. With coupled regions the laws of neighbouring
  /// regions run into each other over 6 mm, else each vertex has its region's. Empty with
  /// TissueModel::kBone, which has a law of its own (block_energy.h).
  std::array<std::vector<hand::StiffeningLaw>, 3> law;
  // Spots of a few vertices, by which local_depth() looks around.
  SkinPatches spots;
  std::vector<Eigen::Vector3f> spot_centre;  ///< reference posture, mm
  std::vector<int> spot_finger;              ///< 0 to 4; -1 on the palm
  // Larger patches, to leave out what is far from a spot.
  SkinPatches blocks;
  std::vector<Eigen::Vector3f> block_centre;  ///< mm
  std::vector<float> block_radius;            ///< mm
  std::vector<int> finger;                    ///< per vertex
};

SkinStiffness skin_stiffness(const hand::Hand& hand, const SkinGeometry& skin,
                             const SkinResponse& response, const SkinPatches& spots,
                             const SkinPatches& blocks, const ContactModel& model);

/// Depth of the contact around each of `vertices`: the deepest penetration within 8 mm, fading to
/// nothing at 16 mm (8 mm is the width of a contact at the fingers' limit depth),
///
///     D_i = max_j d_j phi(|x_i - x_j|),   phi = 1 up to 8 mm, (256 - r^2) / 192 up to 16 mm
///
/// looking from spot to spot, so that D changes continuously in a motion. It takes the place of
/// d_max (Xie 2014, eq. 3-3), which knows the borders of regions only and jumps there.
std::vector<double> local_depth(const SkinStiffness& stiffness, const SkinGeometry& skin,
                                const std::vector<int>& vertices, const std::vector<int>& collision,
                                const std::vector<geometry::DistanceSample>& sample);

}  // namespace palmar::contact
