// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/product/product_faces.h"
#include "palmar/study/statistics/face_statistics.h"
#include "palmar/workflow/redesign/feature_run.h"

namespace palmar::workflow {

/// A change of features that is worth trying, because of what hands touch.
struct Proposal {
  std::string words;   ///< as feature_setting() reads them: "fillet:face=7+8=6"
  std::string reason;  ///< "face 7 (fillet r 3) has the highest pressure in 63 % of hands"
};

/// Everything that may help where a tenth of hands or more touch, the hottest first: convex fillets
/// of one radius together, and each that carries peaks, with twice and four times their radius;
/// sharp edges likewise with a first and a second radius; faces, each with those that it runs into
/// smoothly, and all of them together, moved in and out. As far as the budget of change allows;
/// none twice, at most 24.
std::vector<Proposal> proposals_for(const product::ProductFaces& faces,
                                    std::vector<study::FaceSummary> touched,
                                    const FeatureLimits& limits);

}  // namespace palmar::workflow
