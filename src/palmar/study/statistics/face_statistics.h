// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/product/product.h"
#include "palmar/statistics/proportion.h"
#include "palmar/statistics/summary.h"
#include "palmar/study/statistics/mean_maps.h"
#include "palmar/study/statistics/study_results.h"

namespace palmar::study {

/// One face of a product over the hands that have it in the hand.
struct FaceSummary {
  int face = 0;                     ///< index into ProductFaces::face
  statistics::Proportion touched;   ///< hands that touch the face
  statistics::Proportion has_peak;  ///< hands whose highest pressure on the product is on this face
  statistics::Proportion above;     ///< hands whose peak on the face is above the threshold
  statistics::Summary peak;         ///< MPa, over the hands that touch the face
  double peak_p95 = 0.0;            ///< MPa; 95th percentile of those peaks (type 7)
  double force = 0.0;               ///< N, mean over hands; those that don't touch count with 0
  double force_share = 0.0;         ///< of the product's force, mean over hands; likewise
  double area = 0.0;                ///< mm^2 under pressure, mean over hands; likewise
};

/// The faces of one product under one condition.
struct FaceStatistics {
  StudyCondition condition;
  int product = 0;
  int hands = 0;                   ///< that have it in the hand
  std::vector<FaceSummary> faces;  ///< touched by anybody, ascending
};

/// Of all conditions and products that have faces, conditions first, from records that come one by
/// one, on product_map() at the fineness of the study's maps (inside a glove on the glove's
/// surface). Pressures are those of face_contacts(). The same whatever the number of threads.
std::vector<FaceStatistics> face_statistics(const StudyPlan& plan,
                                            const std::vector<product::Product>& products,
                                            const RecordSource& records,
                                            const MeanMapOptions& options = {});

/// The face that has the product's peak in most hands; null if nobody touches one.
const FaceSummary* hottest_face(const FaceStatistics& statistics);

}  // namespace palmar::study
