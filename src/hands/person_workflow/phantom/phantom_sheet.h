// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "hands/phantom/photo/sheet_photograph.h"
#include "palmar/core/progress.h"

namespace palmar::person_workflow {

/// A photograph of a synthetic hand flat on a sheet of paper or beside a bank card, with the truth
/// beside it (docs/method/phantom.md).
struct PhantomSheetRequest {
  std::string out;           ///< folder; photo.jpg, truth.json and the true shape go into it
  std::string sheet = "a4";  ///< "a4", "letter", "card" (a bank card beside the hand)
  bool is_free = false;      ///< the person, by kFreePerson
  phantom::SheetPhotographOptions photograph;  ///< its seed chooses the person, too; size and
                                               ///< thickness follow from `sheet`
  hand::Side side = hand::Side::kRight;
  double together = 0.0;  ///< 0: fingers spread; 1: side by side
  bool has_exif = true;   ///< the photograph says what lens took it
  std::string hand;       ///< one of Palmar's hands instead of a person of its own: "template"
                          ///< or a *.hand.glb file; empty: a person
  std::string base = "template";  ///< whose skin's outline the person starts from, likewise

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct PhantomSheetOutcome {
  std::string photograph, truth;  ///< files
  std::string shape;              ///< truth.hand.glb of a hand of Palmar's, truth.ply of a person
};

/// Makes the hand, its photograph and the truth. Throws UsageError, InputError for `base` or
/// `hand`, OutputError, Cancelled.
PhantomSheetOutcome make_phantom_sheet(const PhantomSheetRequest& request,
                                       const Progress& progress = {});

}  // namespace palmar::person_workflow
