// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/report/chart/study_figures.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/page/report_extras.h"
#include "palmar/report/study/study_answer.h"
#include "palmar/report/study/study_scene.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/study/statistics/study_analysis.h"

namespace palmar::report {

/// Everything that the page of a study shows, computed beforehand.
struct StudyPage {
  const study::StudyResults& results;
  const study::StudyAnalysis& analysis;
  const hand::Hand& base;
  const std::vector<study::StudyWarning>& warnings;
  const std::vector<StudyFigure>& figures;
  const StudyScales& scales;
  const std::vector<std::vector<EncodedPicture>>& pictures;  ///< of the maps, by product; or empty
  const std::vector<product::Product>& products;
  const std::vector<study::FaceStatistics>& faces;  ///< of products that have any
  std::string scene;                                ///< study_scene_json(); "": no 3-D view
  std::vector<int> shown_hands;                     ///< in the 3-D view, its order
  double threshold = 0.0;                           ///< of the maps, MPa
  std::string program;                              ///< that ran the study
  std::string digest;                               ///< of the store; "": not finished
  Language language = Language::kEnglish;
  StudyAnswer answer;
  ReportExtras extras = {};
};

/// The study as one HTML document that needs no other file and no network (its content policy
/// forbids both), and holds no time: same results, same bytes. Verdict in words and what to be
/// careful with first; then figures, comparisons, regions, who is left out, sizes, the 3-D view,
/// maps, indices, methods, provenance.
std::string study_page(const StudyPage& page);

/// The verdict in plain words: which product has the lower peak pressure, by how much, whether that
/// is shown, and whether the grip forces are equal; which suits how many hands and whom it leaves
/// out; how many sizes are needed. It speaks of the first condition and says so; a sentence for
/// each other one says whom products exclude and whether the differences still stand.
std::vector<std::string> study_verdict(const study::StudyResults& results,
                                       const study::StudyAnalysis& analysis);

}  // namespace palmar::report
