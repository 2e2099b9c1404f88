// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/product/parts/product_parts.h"
#include "palmar/records/study/study_file.h"
#include "palmar/redesign/handle_body.h"
#include "palmar/study/statistics/study_results.h"
#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar::workflow {

/// The original in the hands.
struct HeldOriginal {
  records::LoadedStudy study;               ///< with one product, one condition
  std::vector<study::StudyRecord> records;  ///< with fields, ascending
  const product::Product& product() const { return study.inputs.products.front(); }
  study::RecordSource source() const;  ///< of `records`, which must outlive it
  /// The hold in which it is held, if its place wasn't given by coordinates.
  std::optional<grasp::Hold> hold() const;
  /// Parts of the product, found when first asked for.
  const product::ProductParts& parts() const { return *shared_parts(); }
  /// The part that a hold is of.
  const product::ProductPart& part_of(const grasp::Hold& hold) const {
    return parts().parts.at(static_cast<std::size_t>(hold.part - 1));
  }
  std::shared_ptr<const product::ProductParts> shared_parts() const;
  mutable std::shared_ptr<const product::ProductParts> found_parts =
      nullptr;  ///< by shared_parts()
};
/// Loads, draws and grasps; the place is that of the populations' mean hand. Throws as
/// RedesignRequest::check() and load_study(), NumericalError if no hand holds the product: no
/// answer; Cancelled.
HeldOriginal grasp_original(const RedesignRequest& request, const Progress& progress);

/// How hands in this hold lie on the original: place, thumb's side and palm; the rest as it is by
/// default.
redesign::HandsOnHandle hands_in_hold(const HeldOriginal& original, const grasp::Hold& hold);

/// Where hands hold the original, product frame, mm.
Vec3 held_place(const RedesignRequest& request, const HeldOriginal& original);

/// The hands that judge a redesign: as many others of the same populations as it was made for, in
/// the same hold.
struct JudgingHands {
  HeldOriginal original;
  bool are_others = false;  ///< given hands (a table) can't be drawn anew: they are the same
};
JudgingHands judging_hands(const RedesignRequest& request, const HeldOriginal& made_for,
                           const Progress& progress);

}  // namespace palmar::workflow
