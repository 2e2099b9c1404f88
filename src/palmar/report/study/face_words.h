// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/records/csv.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/study/study_run.h"

namespace palmar::report {

// Results by face of a CAD product, as its designer knows the faces.

/// "face 5 “fillet 1” (fillet r 3): peak 0.41 MPa in the mean, highest of the product in 63 % of 30
/// hands"; `summary` null: nobody touches it.
std::string face_words(const product::ProductFace& face, const study::FaceSummary* summary);

/// "Prism: face 5 “fillet 1” (fillet r 3): peak 0.41 MPa, highest of the product in 63 % of 30
/// hands." For the face that has the product's peak in most hands; "" if nobody touches one.
std::string face_words(const study::StudyPlan& plan, const product::Product& product,
                       const study::FaceStatistics& statistics);

/// That of every product that has faces, under one condition.
std::vector<std::string> face_sentences(const study::StudyPlan& plan,
                                        const std::vector<product::Product>& products,
                                        const std::vector<study::FaceStatistics>& faces,
                                        const study::StudyCondition& condition);

/// All of them as a table: faces.csv.
records::CsvTable face_statistics_csv(const study::StudyPlan& plan,
                                      const std::vector<product::Product>& products,
                                      const std::vector<study::FaceStatistics>& faces,
                                      double threshold);

}  // namespace palmar::report
