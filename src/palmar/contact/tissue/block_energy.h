// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "palmar/contact/response/skin_geometry.h"
#include "palmar/hand/hand.h"

namespace palmar::contact {

/// Stiffening of tissue on bone, from one energy.
///
/// The tissue below each region of the skin is a block b of volume V_b with the modulus lambda_b
/// G0, lambda_b >= 1. With the responses C at the modulus 1 (skin_compliance.h) forces p move the
/// skin by
///
///     u = T C T p,   T = diag tau_i,   tau_i = (sum_b w_ib lambda_b^(-1/2)) / sqrt(G0_i)
///
/// w_ib: smooth shares of the blocks at vertex i. lambda_b follows from the work that the forces on
/// b have stored there: W_b is the energy that the same displacements would store at the modulus
/// G0, so W_b / V_b G0_b is the mean square of its strains, and the modulus grows linearly with
/// their root, as it does with the depth in Xie 2014, eq. (3-3):
///
///     lambda_b = 1 + k_b sqrt(W_b / V_b G0_b),
///     W_b = 1 / (2 lambda_b) sum_i p_i u_i w_ib lambda_b^(-1/2) / (tau_i sqrt(G0_i)).
///
/// These are the conditions for
///
///     U*(p) = 1/2 (T p)' C (T p) + sum_b chi_b(lambda_b),   chi_b' = W_b
///
/// to be stationary in every lambda_b; thus u is the gradient of U*, the Hessian is symmetric,
/// responses are reciprocal, and no work is gained on a closed path. On one block U* is the dual of
/// W + 2/3 k W^1.5 / sqrt(V G0), which is convex in the displacements.
struct BoneTissueBlocks {
  /// Shares of the blocks (Region) at each vertex: begin[v] to begin[v + 1] - 1.
  std::vector<std::size_t> begin;
  std::vector<std::pair<int, double>> share;
  std::array<std::vector<double>, 3> g0;                             ///< per level and vertex, MPa
  std::array<std::array<double, hand::kRegionCount>, 3> block_g0{};  ///< per level, MPa
  std::array<std::array<double, hand::kRegionCount>, 3>
      per_energy{};  ///< k_b^2 / (V_b G0_b), 1/(N mm)
};

using BlockStiffening = std::array<double, hand::kRegionCount>;  ///< lambda_b
BlockStiffening no_stiffening();                                 ///< all 1

/// Blocks and moduli mix over 6 mm where regions meet, as laws do in stiffening.h. `volume`: V_b,
/// mm^3; a block without any doesn't stiffen.
BoneTissueBlocks bone_tissue_blocks(const hand::Hand& hand, const SkinGeometry& skin,
                                    const std::array<double, hand::kRegionCount>& volume);

/// lambda_b^(-1/2) of each block.
struct BlockRoots {
  BlockRoots(
      const BlockStiffening& lambda);  // NOLINT(google-explicit-constructor): the same, again
  BlockStiffening inverse;
};

/// 1 / tau of a vertex, sqrt(MPa).
double root_modulus(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                    const BlockRoots& roots, int vertex);

/// The lambda_b that belong to the work of these forces [N] and displacements [mm, inwards] under
/// the present ones. A fixed point of this is the solution.
BlockStiffening stiffening_of(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                              const BlockStiffening& lambda, const std::vector<int>& vertex,
                              const std::vector<double>& force,
                              const std::vector<double>& displacement);

/// sum_b chi_b(lambda_b), N mm: with K = k^2 / (V G0), chi = (lambda - 1)^3 / 3 K.
double stiffening_energy(const BoneTissueBlocks& blocks, hand::TissueLevel level,
                         const BlockStiffening& lambda);

}  // namespace palmar::contact
