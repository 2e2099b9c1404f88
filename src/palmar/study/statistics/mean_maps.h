// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/grasp/pressure_thresholds.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// A pressure field over hands, vertex by vertex. Hands of different size share the template's
/// triangles, so vertex k is the same place of every hand; on the product every hand presses where
/// it holds it, in the product's own frame.
struct PressureMap {
  std::vector<double> mean;   ///< MPa; hands that don't touch there count with 0
  std::vector<double> sd;     ///< MPa; 0 of one hand
  std::vector<double> above;  ///< share of hands whose pressure is above the threshold, 0 to 1
};

/// Maps of one product under one condition, over the hands that have it in the hand.
struct StudyMaps {
  StudyCondition condition;
  int product = 0;
  int hands = 0;
  PressureMap skin;        ///< per vertex of the template's skin
  PressureMap on_product;  ///< per vertex of product_map()
};

struct MeanMapOptions {
  /// MPa. Blood-flow family: at more the skin's blood flow stops if the grip is held long. The only
  /// family of thresholds that speaks of the pressure at a point; the onsets of pain and discomfort
  /// hold for their probes' areas (pressure_thresholds.h).
  double threshold = grasp::kBloodFlowStop;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// Maps of all conditions and products, conditions first, from records that come one by one: memory
/// is that of the maps alone (20 bytes per vertex, product and condition). `skin_vertices` of the
/// template; `product_vertices` of the product_map() of every product. Throws UsageError if a field
/// names a vertex that isn't there.
std::vector<StudyMaps> mean_maps(const StudyPlan& plan, const RecordSource& records,
                                 int skin_vertices, const std::vector<int>& product_vertices,
                                 const MeanMapOptions& options = {});

}  // namespace palmar::study
