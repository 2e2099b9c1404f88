// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/product/product.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/ridge_relief.h"
#include "palmar/workflow/redesign/redesign_outcome.h"
#include "palmar/workflow/redesign/redesign_request.h"
#include "palmar/workflow/redesign/region_findings.h"

namespace palmar::workflow {

struct RedesignRegionOutcome;

/// Redesign 2: where hands touch, for CAD; ridges rounded there.
struct RedesignRegionRequest {
  RedesignRequest redesign;
  redesign::RegionOptions region;
  double threshold = 0.0;  ///< MPa, 0 or more; a hand touches where it presses more
  /// Share of the mean imprint, 0 to 1, by which the surface is set back before simple surfaces are
  /// fitted to it.
  double pressed_share = 0.5;
  double smallest_patch = 40.0;  ///< mm^2; smaller ones are listed but get no surface
  bool relieves = true;          ///< rounds ridges; else the region is only exported
  double relief_share = 0.0;     ///< of the hands that must touch a ridge, 0 to 1; 0: any
  redesign::ReliefOptions relief;
  double junction_radius = 0.0;  ///< mm, 0 to 50; rounds the edges in which the cutter leaves
  bool draws = true;             ///< a picture
  bool compares = true;          ///< in the end the same hands hold original and redesign
  /// Called when everything but the comparison is written; json and comparison of the outcome are
  /// still empty.
  std::function<void(const RedesignRegionOutcome&)> on_region;

  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
};

/// `json` is what region.json holds.
struct RedesignRegionOutcome : RedesignOutcome {
  std::shared_ptr<const product::Product> product;  ///< the original
  RegionFindings findings;
};

/// Hands hold the product; finds, exports and rounds. Writes to OUT: region.step, region.json,
/// region.csv (CAD faces), region.ply (the surface in the regions' colours), outline.dxf and
/// outline.svg (if the side can be unrolled), region.png, redesign.step and redesign.stl (if ridges
/// were rounded) and what compare_redesigns() writes. Throws UsageError, InputError, NumericalError
/// if no hand holds the original, Cancelled.
RedesignRegionOutcome redesign_region(const RedesignRegionRequest& request,
                                      const Progress& progress = {});

}  // namespace palmar::workflow
