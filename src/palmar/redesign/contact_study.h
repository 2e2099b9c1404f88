// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/contact_region.h"
#include "palmar/redesign/ridge_relief.h"

namespace palmar::redesign {

/// Where the hands of a study touch a product, and how deep they reach in.
struct ContactStudy {
  study::ProductMap map;
  ContactCount count;
  std::vector<double> imprint;  ///< mean over hands, per vertex of the map, mm
};

/// Over all hands that hold product `product` (index) under `condition`. Throws as
/// for_each_held_hand().
ContactStudy study_contact(const study::StudyPlan& plan, const study::StudyInputs& inputs,
                           const study::RecordSource& records,
                           const study::StudyCondition& condition, int product,
                           double threshold = 0.0, const Progress& progress = {});

/// Redesign 2 as a product to be held, where no CAD kernel is at hand: the original's mesh with the
/// reliefs of plan_reliefs() (relieved_mesh()).
product::Product relieved_product(const product::Product& original, const ReliefPlan& plan,
                                  const std::string& name);

}  // namespace palmar::redesign
