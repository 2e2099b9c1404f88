// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/press/press.h"
#include "palmar/records/press_json.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// An indentation test on a plane, an ellipsoid or one region of a hand.
struct PressRequest {
  contact::PressOptions test;  ///< its kernel and, with a tissue file, its tissue are set here
  HandChoice hand;  ///< whose region is pressed; its tissue file also serves plane and ellipsoid
  contact::ContactModel model =
      contact::palmar_model();  ///< the equations; a plane or ellipsoid takes the kernel
  std::string out;              ///< file to write, .json, .csv or .svg (the curve); "": none
  NoteSink note = {};           ///< when something takes long
  void check() const;           ///< throws UsageError: setting, value, what is allowed
};

struct PressOutcome {
  contact::PressOptions test;  ///< as it ran
  records::PressSetting setting;
  std::vector<contact::PressStep> steps;
};

/// Throws UsageError, InputError naming the file, NumericalError, OutputError.
PressOutcome run_press(const PressRequest& request);

}  // namespace palmar::workflow
