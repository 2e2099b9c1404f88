// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/precision/reach.h"
#include "palmar/workflow/grasp/grasp.h"

namespace palmar::workflow {

/// Buttons of a product, or its whole surface, to be reached while it is held.
struct ReachRequest {
  GraspRequest grasp;
  std::vector<grasp::Button> buttons;
  std::string map;       ///< VTP file to write: who reaches every point of the surface; "": none
  int map_points = 500;  ///< places of the surface that the map tries
  void check() const;    ///< throws UsageError: setting, value, what is allowed
};

struct ReachOutcome {
  GraspOutcome held;
  std::vector<grasp::ButtonReach> buttons;
  std::optional<grasp::ReachMap> map;
  double surface_area = 0.0;  ///< of the product, mm^2
};

/// Throws as grasp_product() and reach_buttons(), and OutputError.
ReachOutcome reach_of_grasp(const ReachRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
