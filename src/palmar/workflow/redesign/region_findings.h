// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/ridge_relief.h"
#include "palmar/redesign/surface_fit.h"
#include "palmar/redesign/unrolled_outline.h"
#include "palmar/study/study_record.h"

namespace palmar::workflow {

/// One patch of a part's region with the simple surfaces that suit it.
struct FittedPatch {
  int region = 0;  ///< index into RegionFindings::regions
  int number = 0;  ///< from 1, in the region
  int piece = 0;   ///< from 1, where the patch goes over edges and was cut; 0: whole
  redesign::SurfaceChoice product;  ///< fitted to the product's own surface there
  redesign::SurfaceChoice target;   ///< fitted to it less the share of the imprint
  double mean_depth = 0.0;          ///< mm; mean imprint over hands in the patch
  std::vector<Vec3> target_points;
};

/// Where hands touch a product, and what suits these places.
struct RegionFindings {
  study::ProductMap map;
  Vec3 axis = Vec3::UnitZ();  ///< along the handle, unit
  redesign::ContactCount count;
  std::vector<double> imprint;                   ///< mean over hands, per vertex of the map, mm
  std::vector<redesign::ContactRegion> regions;  ///< whole hand, fingers, thumb, palm
  std::vector<FittedPatch> patches;              ///< of the parts
  std::optional<redesign::ReliefPlan> plan;
  std::optional<redesign::UnrolledOutline> sheet;
};

/// "contact palm, half of 30 hands, patch 1, piece 2".
std::string name_of(const RegionFindings& findings, const FittedPatch& patch);

}  // namespace palmar::workflow
