// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold_site.h"
#include "palmar/grasp/holds/power_place.h"
#include "palmar/grasp/power/closing.h"

namespace palmar::grasp {

/// What fingers close on, quickly asked.
struct GraspedSurface {
  std::shared_ptr<const geometry::DistanceField> quick;  ///< distance_near() a site of the hold
  std::shared_ptr<const geometry::DistanceField> whole;  ///< the product, exactly
  double wall = 1e3;  ///< how thick the solid is under the grip's surface there, mm
};
GraspedSurface grasped_surface_near(const Hold& hold, const product::ProductParts& parts,
                                    const product::Product& product, const HoldSite& at,
                                    const hand::Hand& hand);

/// A power grip's hold by one hand, closed on a sparse skin (`coarse`), thumb included. The hand
/// lies on the part in the usual pose of its grip: nothing is searched but the way of the thumb, so
/// that a product that differs a little is held a little differently.
PowerPlace place_of_hold(const HoldSite& at, Grip grip, const GraspedSurface& surface,
                         const HandCloser& coarse, const PowerGraspOptions& options,
                         const Progress& progress = {});

}  // namespace palmar::grasp
