// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/prepared/coarse_hand.h"
#include "palmar/contact/response/skin_geometry.h"
#include "palmar/contact/response/skin_response.h"
#include "palmar/contact/self/skin_meetings.h"
#include "palmar/contact/solve/contact_system.h"
#include "palmar/contact/tissue/block_energy.h"
#include "palmar/contact/tissue/stiffening.h"
#include "palmar/core/enum_index.h"

namespace palmar::contact {

struct PreparedHand::Impl {
  std::shared_ptr<const hand::Hand> hand;
  ContactModel model;
  SkinGeometry skin;
  /// Of skin that was divided: areas of the skin before per vertex, at rest, mm^2; no pressure is
  /// told of less. Empty otherwise.
  std::vector<double> told_area;
  std::vector<double> layer_thickness;  ///< per vertex, mm; with TissueModel::kLayered
  SkinResponse response;  ///< with TissueModel::kBone among skin without tissue elements only
  SkinPatches blocks;     ///< of the preconditioner
  SkinStiffness stiffness;
  // With TissueModel::kBone.
  BoneTissueBlocks bone;
  std::shared_ptr<const SkinCompliance> compliance;  ///< of the hand or its family's base
  std::vector<double> scale;  ///< of a hand of a family, per vertex: see LoadedSkin
  std::optional<SkinMeetings> meetings;
  // Of the coarse hand.
  std::shared_ptr<const CoarseSkin> coarse_skin;  ///< of the family; null without one
  struct Coarse {
    std::once_flag once;
    std::unique_ptr<const CoarseHand> hand;
  };
  std::shared_ptr<Coarse> coarse = std::make_shared<Coarse>();

  bool is_on_bone() const { return model.tissue == TissueModel::kBone; }
  bool is_as_printed() const { return model.bulge == BulgeLaw::kPrinted; }

  /// Blocks of the preconditioner and stiffness, from hand, skin, response and model.
  void set_patches();

  const hand::RegionTissue& tissue(hand::Region r) const {
    return hand->tissue.region[index_of(r)];
  }
};

}  // namespace palmar::contact
