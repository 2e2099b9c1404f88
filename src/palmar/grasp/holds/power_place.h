// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/grasp.h"
#include "palmar/grasp/holds/hold_site.h"
#include "palmar/grasp/power/closing.h"
#include "palmar/grasp/power/placement.h"

namespace palmar::grasp {

/// Distance between the skin vertices that a search looks at, mm.
constexpr double kSearchSpacing = 4.2;

/// A place on a product and the way in which a hand holds it there, before the hand is closed on
/// all of its skin: what close_power_grasp() finds first.
struct PowerPlace {
  bool is_found = false;  ///< there is something to close the hand on; else `grasp` says why not
  Grasp grasp;            ///< grip, score and runners-up; nothing closed yet
  GripSite site;
  std::shared_ptr<const geometry::DistanceField> quick;  ///< distance_near() the site
  /// What all skin has to keep out of where fingers close on a part alone; null: nothing more.
  std::shared_ptr<const geometry::DistanceField> whole;
  ClosedPose pose;          ///< closed on a sparse skin
  bool is_fixed = false;    ///< the placement was given in full: only the fingers close
  bool is_carried = false;  ///< over from another hand: fewer rounds of closing, same limits
  bool may_shift = true;    ///< the hand may go along the product's axis
};

/// A product that offers a hand nothing: the hand is shown beside it.
Grasp no_place(const hand::Hand& hand, const product::Product& product);

/// The ways in which fingers go round a body of that diameter [mm].
std::vector<ClosingStyle> styles_for(Grip grip, double diameter, double hand_length);

PowerPlace find_power_place(const hand::Hand& hand, const product::Product& product,
                            const PowerGraspOptions& options, const Progress& progress);

/// Closes the hand there on all of its skin and by the exact distance. `fine`: a closer that
/// looks at all of the skin.
Grasp close_at(const PowerPlace& place, const HandCloser& fine, const product::Product& product,
               const PowerGraspOptions& options, const Progress& progress);

/// The same way of holding by another hand (`coarse`): its pose differs from the usual pose as that
/// of `reference` does (lengths in hand lengths). Of a place that was searched without a hold the
/// best of a few near it is kept; of a hold, which that hand has at `at`, that pose itself, so that
/// hands that differ little hold little differently.
PowerPlace carried_over(const PowerPlace& place, const hand::Hand& reference,
                        const HandCloser& coarse, const HoldSite* at,
                        const PowerGraspOptions& options, const Progress& progress);

}  // namespace palmar::grasp
