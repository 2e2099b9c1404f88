// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/grasp_reach.h"

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/records/reach_json.h"

namespace palmar::workflow {

void ReachRequest::check() const {
  if (buttons.empty() && map.empty()) {
    throw UsageError("setting \"buttons\" or setting \"map\" is needed; neither is given");
  }
  grasp.check();
}

ReachOutcome reach_of_grasp(const ReachRequest& request, const Progress& progress) {
  request.check();
  ReachOutcome outcome{.held = grasp_product(request.grasp, progress), .buttons = {}, .map = {}};
  const auto& [product, hand, grasp] = outcome.held;
  outcome.buttons = grasp::reach_buttons(*hand, product, grasp, request.buttons, progress);
  outcome.surface_area = geometry::surface_area(product.mesh);
  if (request.map.empty()) return outcome;
  outcome.map = grasp::map_reach(*hand, product, grasp, request.map_points, progress);
  formats::write_file(request.map, records::format_reach_map(product.mesh, *outcome.map));
  return outcome;
}

}  // namespace palmar::workflow
