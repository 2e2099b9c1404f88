// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/records/csv.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/study/study_run.h"

namespace palmar {

// Results by face of a CAD product, as its designer knows the faces.

/// "face 5 “fillet 1” (fillet r 3): peak 0.41 MPa in the mean, highest of the product in 63 % of 30
/// hands"; `summary` null: nobody touches it.
std::string face_words(const ProductFace& face, const FaceSummary* summary);

/// "Prism: face 5 “fillet 1” (fillet r 3): peak 0.41 MPa, highest of the product in 63 % of 30
/// hands." For the face that has the product's peak in most hands; "" if nobody touches one.
std::string face_words(const StudyPlan& plan, const Product& product,
                       const FaceStatistics& statistics);

/// That of every product that has faces, under one condition.
std::vector<std::string> face_sentences(const StudyPlan& plan, const std::vector<Product>& products,
                                        const std::vector<FaceStatistics>& faces,
                                        const StudyCondition& condition);

/// All of them as a table: faces.csv.
CsvTable face_statistics_csv(const StudyPlan& plan, const std::vector<Product>& products,
                             const std::vector<FaceStatistics>& faces, double threshold);

}  // namespace palmar
