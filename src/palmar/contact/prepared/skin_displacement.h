// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// The solved contact problem of a hand's skin.
struct SkinLoad {
  std::vector<int> vertex;            ///< that took part in the problem, ascending
  std::vector<double> depth;          ///< d_max or local depth, mm
  std::vector<double> shear_modulus;  ///< MPa
  std::vector<double> force;          ///< N
  std::vector<double> gap;            ///< after deformation, mm
  std::vector<char> in_contact;
  hand::TissueLevel level = hand::TissueLevel::kNominal;
  /// Square roots of the shear moduli; of tissue on bone only. Responses are
  /// then f_ij / (root_i root_j) (block_energy.h), else f_ij / G_i in the solution.
  std::vector<double> root_modulus;
  std::vector<Vec3> direction;  ///< of each force in the reference posture, inwards; on bone only
};

/// Loaded skin of one region (of the dorsum: one connected patch), Xie 2014, A4.
struct LoadedPart {
  hand::Region region{};
  std::vector<int> row;  ///< in the SkinLoad, ascending
  double force = 0.0;    ///< N
};

/// Splits the loaded skin by the 19 regions, and the dorsum by connected patches.
std::vector<LoadedPart> loaded_parts(const PreparedHand::Impl& prepared, const SkinLoad& load);

/// Normal displacement of the whole skin, positive into the hand, mm; one value per vertex.
struct SkinDisplacement {
  std::vector<double> elastic;     ///< without the bulge
  std::vector<double> with_bulge;  ///< the same as `elastic` if there is no swelling
  std::vector<char> is_active;     ///< within reach of a loaded part
};

/// Displacement of the skin around its loaded vertices, which lie on the product. Each part k of
/// the loaded skin moves the vertices around it by
///
///     u_k = sum_j R_ij p_j / G_j,   bulge_k = h_k g_k,
///     g_k = ramp(r_k) (R_Gau p_k) / max(R_Gau p_k)
///
/// with the height h_k of swelling_height_at() and r_k the distance on the skin to the loaded
/// vertices of the part. ramp() rises from 0 at the edge of the contact to 1 at half the radius b
/// of the bulge, so that the skin leaves the contact without a step. f_k fades u_k to zero over the
/// last third of the part's neighbourhood. Parts that were solved together add up; parts that were
/// solved one by one are blended with weights f_k / (r_k^2 + 1 mm^2), as bulges always are. A bulge
/// that would enter the product is held on its surface, without force (Xie 2014, eq. 3-7). On bone
/// only loaded and penetrating skin is moved here, and the rest told that is in reach.
SkinDisplacement skin_displacement(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                                   const SkinLoad& load, const std::vector<LoadedPart>& parts,
                                   bool swelling);

}  // namespace palmar::contact
