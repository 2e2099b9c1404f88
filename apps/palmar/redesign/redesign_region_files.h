// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "palmar/formats/figure/drawing_file.h"
#include "palmar/records/region_json.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/ridge_relief.h"
#include "palmar/redesign/surface_fit.h"
#include "palmar/redesign/unrolled_outline.h"
#include "palmar/study/study_record.h"

namespace palmar::cli {

/// One patch of a part's region with the simple surfaces that suit it.
struct FittedPatch {
  const ContactRegion* region = nullptr;
  int number = 0;           ///< from 1, in the region
  int piece = 0;            ///< from 1, where the patch goes over edges and was cut; 0: whole
  SurfaceChoice product;    ///< fitted to the product's own surface there
  SurfaceChoice target;     ///< fitted to it less the share of the imprint
  double mean_depth = 0.0;  ///< mm; mean imprint over hands in the patch
  std::vector<Vec3> target_points;
  const RegionPatch& patch() const { return region->patches[static_cast<std::size_t>(number - 1)]; }
  std::string name() const;  ///< "contact palm, half of 30 hands, patch 1, piece 2"
};

/// Everything that `palmar redesign region` found.
struct RegionFindings {
  ProductMap map;
  Vec3 axis = Vec3::UnitZ();  ///< along the handle, unit
  ContactCount count;
  std::vector<double> imprint;         ///< mean over hands, per vertex of the map, mm
  std::vector<ContactRegion> regions;  ///< whole hand, fingers, thumb, palm
  std::vector<FittedPatch> patches;    ///< of the parts
  std::optional<ReliefPlan> plan;
  std::optional<UnrolledOutline> sheet;
};

/// Outlines of all regions and the fitted target surfaces, as CAD is told them.
std::vector<NamedCurve> curves_of(const RegionFindings& findings);
std::vector<NamedSurface> surfaces_of(const RegionFindings& findings);

nlohmann::ordered_json region_json(const RegionFindings& findings, const Product& product);
/// Faces with their share of area in each region; "" if the product has no faces.
std::string region_csv(const RegionFindings& findings, const Product& product);
Drawing region_drawing(const UnrolledOutline& sheet, const std::vector<ContactRegion>& regions,
                       const std::string& product);

}  // namespace palmar::cli
