// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/contact.h"
#include "palmar/hand/skin/skin_sampling.h"

namespace palmar::contact {

struct SkinGeometry;

inline constexpr double kCoarseSpacing = 3.0;  ///< mm; our choice

/// A hand with a coarse skin, for searches that ask many times: vertices kCoarseSpacing apart, each
/// of which stands for the skin around it. On bone forces lie there evenly and displacements are
/// means,
///
///     C_IJ = sum over i in I, j in J of w_i C_ij w_j,
///
/// w_i the vertex' share in the area of its neighbourhood; other tissue is prepared anew. Skinning,
/// regions and blocks are those of the vertex itself. A contact takes a fifth of the time; forces
/// are a few per cent off.
struct CoarseHand {
  hand::SkinSample sample;  ///< of the whole skin: vertex by vertex the coarse one
  PreparedHand prepared;
};

/// What the coarse hands of a family share.
struct CoarseSkin {
  hand::SkinSample sample;
  std::shared_ptr<const SkinCompliance> compliance;  ///< null for other tissue
};
/// `compliance`: of this skin, null for other tissue.
CoarseSkin coarse_skin(const hand::Hand& hand, const SkinGeometry& skin,
                       const SkinCompliance* compliance);

/// `skin`: of the hand or its family.
CoarseHand coarse_hand(const PreparedHand::Impl& hand, const CoarseSkin& skin);

}  // namespace palmar::contact
