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

namespace palmar {

/// Colour scales of a study; one for all products of each kind of map.
struct StudyScales {
  ColourScale grasp;  ///< of single grasps: 0 to 0.70 MPa (Xie 2014, fig. 5-12) where that fits
  ColourScale mean, sd;
  ColourScale above;  ///< share of hands above the threshold, 0 to 100 %
};
/// 0.70 MPa fits if the 95th percentile of the grasps' peak on sensor cells is 0.30 to 0.80 MPa;
/// else the scale ends at that percentile, rounded up. Maps end at their largest value.
StudyScales study_scales(const StudyResults& results, const std::vector<StudyMaps>& maps);

/// Which hands the 3-D view shows: all, or if there are too many those that stand evenly in the
/// order of hand length, the shortest and the longest among them. Ascending.
std::vector<int> shown_hands(const StudyPlan& plan, const StudyCondition& condition,
                             int most_grasps);
/// The hand whose length and circumference lie nearest to the means, in standard deviations; the
/// first one if no sizes are known. `hands` not empty.
int typical_hand(const StudyPlan& plan, const std::vector<int>& hands);

/// The skin as the report shows it: posed, in the product's frame, what would be inside the product
/// placed on its surface. The bulge beside the contact isn't shown. mm
std::vector<Vec3> displayed_skin(const Hand& hand, const StudyRecord& record,
                                 const Product& product);

struct StudySceneInput {
  const StudyResults& results;
  const StudyInputs& inputs;
  const std::vector<StudyMaps>& maps;  ///< of `condition`, one per product
  const StudyCondition& condition;     ///< whose grasps are shown
  const RecordSource& records;
  const StudyHandMaker& hand_of;
  const StudyScales& scales;
  const std::vector<FaceStatistics>& faces;  ///< of `condition` at least, of products that have any
  int most_grasps = 200;                     ///< some 35 kB each in the page
  Language language = Language::kEnglish;
};

/// Data of the report's 3-D view (StudySceneData in apps/workbench/viewer/study_view.ts) as JSON:
/// the template's triangles once, every product once, then per grasp the skin and pressures, each
/// packed by itself so that the browser unpacks only what is looked at.
std::string study_scene_json(const StudySceneInput& input);

}  // namespace palmar
