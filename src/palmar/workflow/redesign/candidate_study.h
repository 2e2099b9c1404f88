// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/workflow/redesign/held_original.h"

namespace palmar::workflow {

/// Stops when the user asks for it, says nothing: for what is done once per candidate.
Progress silent(const Progress& progress);

/// A redesigned product with what is to be said of it.
struct RedesignedProduct {
  product::Product product;
  std::string name;  ///< "pressed", "fillet 8 mm"
  std::string file;  ///< that was written
};

/// Original and redesigns as one study, held alike: redesigns in the hold of the original, or in
/// its posture.
records::LoadedStudy with_redesigns(const RedesignRequest& request, const HeldOriginal& original,
                                    const std::vector<RedesignedProduct>& redesigns);

/// The original's grasps in a study of more products: they depend on hand and product alone.
std::vector<study::StudyRecord> renumbered(const HeldOriginal& original,
                                           const study::StudyPlan& plan);

/// Results of all hands with one more product beside the original: what a search evaluates. Product
/// 0 is the original, 1 the candidate, whose records come without fields, and without indices
/// unless asked for.
study::StudyResults assess_candidate(const RedesignRequest& request, const HeldOriginal& original,
                                     const product::Product& candidate, bool with_indices,
                                     const Progress& progress);

}  // namespace palmar::workflow
