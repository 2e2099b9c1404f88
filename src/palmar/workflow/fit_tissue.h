// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/contact/press/press.h"
#include "palmar/contact/tissue/tissue_fit.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// Tissue of skin from measured depths and forces of an indentation test.
struct TissueFitRequest {
  std::string curves;  ///< CSV (read_measured_curves())
  /// Specimen, indenter, tilt, spacing, Poisson's ratio, thickness of the layer if it is known; the
  /// depths are those of the readings.
  contact::PressOptions test;
  HandChoice hand;               ///< whose region was pressed
  bool is_layered = false;       ///< skin over bone; else tissue without end
  bool is_layer_fitted = false;  ///< of a plane or ellipsoid: its thickness is fitted as well
  contact::TissueFitOptions fit;
  /// What the tissue file gives the result to: "finger", "palm", "dorsum" or a region; "": the
  /// group of the region that was pressed, "finger" for a plane or ellipsoid.
  std::string group;
  std::string description;  ///< of the test, for the tissue file: "plane pressed by sphere:5"
  std::string out;          ///< tissue file to write, *.toml; "": none
  NoteSink note = {};       ///< columns and rows that are left out
  void check() const;       ///< throws UsageError: setting, value, what is allowed
};

struct TissueFitOutcome {
  contact::TissueFit fit;
  std::string group;
};

/// Throws UsageError, InputError naming file and line, OutputError; NumericalError if the fit
/// doesn't converge or gives no tissue that skin can have: then nothing is written.
TissueFitOutcome fit_tissue(const TissueFitRequest& request);

}  // namespace palmar::workflow
