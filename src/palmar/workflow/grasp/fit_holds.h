// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/fit_holds.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::workflow {

/// Weights of the choice of a hold from how people were seen to hold objects.
struct FitHoldsRequest {
  std::string table;     ///< CSV (records::read_people_holds())
  std::string products;  ///< folder with OBJECT.obj, .stl or .ply for each object, mm
  HandChoice hand;       ///< a right hand of the people's median size
  std::string out;       ///< TOML of the weights to write; "": none
};

/// Throws UsageError, InputError naming the file, OutputError, Cancelled.
grasp::HoldFit fit_holds(const FitHoldsRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
