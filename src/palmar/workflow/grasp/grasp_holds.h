// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/grasp/holds/hold.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"
#include "palmar/workflow/product/product_choice.h"

namespace palmar::workflow {

/// Ways to hold a product, to be looked at and chosen from.
struct GraspHoldsRequest {
  ProductChoice product;
  HandChoice hand;             ///< a median hand of those who use the product
  grasp::HoldOptions options;  ///< which holds to rank, and how many
  std::string picture;         ///< PNG of the sheet; "": none
  std::string out;             ///< folder for hold-1.toml, hold-2.toml, ... and sheet.png; "": none
  NoteSink note = {};          ///< what was found in the product
  void check() const;          ///< throws UsageError: field, value, what is allowed
};

struct GraspHoldsOutcome {
  product::Product product;
  std::shared_ptr<const hand::Hand> hand;
  grasp::RankedHolds ranked;
  std::vector<std::string> files;  ///< that were written
};

/// Reads product and hand, ranks the ways to hold it (rank_holds()) and writes what is asked for.
/// Throws UsageError (also for a part that the product doesn't have), InputError naming the file,
/// OutputError, Cancelled.
GraspHoldsOutcome find_holds(const GraspHoldsRequest& request, const Progress& progress = {});

}  // namespace palmar::workflow
