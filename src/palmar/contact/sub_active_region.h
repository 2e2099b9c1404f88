// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/contact/prepared_hand.h"
#include "palmar/contact/skin_product.h"

namespace palmar {

/// One region's share of the penetrating skin (Xie 2014, A4), with its solution.
struct SubActiveRegion {
  Region region{};
  std::vector<int> collision;   ///< penetrating vertices, ascending
  RegionResponse own_response;  ///< dorsum only
  const RegionResponse* response = nullptr;
  std::vector<int> columns;    ///< of the collision vertices in the response
  double d_max = 0.0;          ///< mm
  double shear_modulus = 0.0;  ///< MPa
  Eigen::VectorXd force;       ///< of the collision vertices, N
  Eigen::VectorXd gap;         ///< of the collision vertices, mm
};

/// Normal displacement of the whole skin, positive into the hand, mm; one value per vertex.
struct SkinDisplacement {
  std::vector<double> elastic;     ///< without the bulge
  std::vector<double> with_bulge;  ///< the same as `elastic` if there is no swelling
  std::vector<char> is_active;     ///< within reach of a loaded part
};

/// Displacement of the skin from the solutions of all parts. Loaded vertices lie on the product.
/// For every other vertex each part k tells
///
///     u_k = (R_Bou / G_k) p_k - h_k g_k,   g_k = ramp(r_k) (R_Gau p_k) / max(R_Gau p_k)
///
/// with the height h_k of swelling_height_at() and r_k the distance on the skin to the loaded
/// vertices of the part. ramp() rises from 0 at the edge of the contact to 1 at half the radius b
/// of the bulge, so that the skin leaves the contact without a step. Where parts meet, their
/// answers are blended with weights f_k / (r_k^2 + 1 mm^2); f_k fades to zero over the last third
/// of the neighbourhood of the part's active region. So u is continuous across the borders of
/// regions although they are solved independently. A bulge that would enter the product is held
/// on its surface, without force (Xie 2014, eq. 3-7).
SkinDisplacement skin_displacement(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                                   const std::vector<SubActiveRegion>& parts, bool swelling);

}  // namespace palmar
