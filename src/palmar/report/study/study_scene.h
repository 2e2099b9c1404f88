// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/report/picture/colour_bar.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/study/statistics/mean_maps.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/study/study_hand_maker.h"
#include "palmar/study/study_run.h"

namespace palmar::report {

/// Colour scales of a study; one for all products of each kind of map.
struct StudyScales {
  ColourScale grasp;  ///< of single grasps: 0 to 0.70 MPa (Xie 2014, fig. 5-12) where that fits
  ColourScale mean, sd;
  ColourScale above;  ///< share of hands above the threshold, 0 to 100 %
};
/// 0.70 MPa fits if the 95th percentile of the grasps' peak on sensor cells is 0.30 to 0.80 MPa;
/// else the scale ends at that percentile, rounded up. Maps end at their largest value.
StudyScales study_scales(const study::StudyResults& results,
                         const std::vector<study::StudyMaps>& maps);

/// Which hands the 3-D view shows: all, or if there are too many those that stand evenly in the
/// order of hand length, the shortest and the longest among them. Ascending.
std::vector<int> shown_hands(const study::StudyPlan& plan, const study::StudyCondition& condition,
                             int most_grasps);
/// The hand whose length and circumference lie nearest to the means, in standard deviations; the
/// first one if no sizes are known. `hands` not empty.
int typical_hand(const study::StudyPlan& plan, const std::vector<int>& hands);

/// The skin as the report shows it: posed, in the product's frame, what would be inside the product
/// placed on its surface. The bulge beside the contact isn't shown. mm
std::vector<Vec3> displayed_skin(const hand::Hand& hand, const study::StudyRecord& record,
                                 const product::Product& product);

struct StudySceneInput {
  const study::StudyResults& results;
  const study::StudyInputs& inputs;
  const std::vector<study::StudyMaps>& maps;  ///< of `condition`, one per product
  const study::StudyCondition& condition;     ///< whose grasps are shown
  const study::RecordSource& records;
  const study::StudyHandMaker& hand_of;
  const StudyScales& scales;
  const std::vector<study::FaceStatistics>&
      faces;              ///< of `condition` at least, of products that have any
  int most_grasps = 200;  ///< some 35 kB each in the page
  Language language = Language::kEnglish;
};

/// Data of the report's 3-D view (StudySceneData in apps/workbench/viewer/study_view.ts) as JSON:
/// the template's triangles once, every product once, then per grasp the skin and pressures, each
/// packed by itself so that the browser unpacks only what is looked at.
std::string study_scene_json(const StudySceneInput& input);

}  // namespace palmar::report
