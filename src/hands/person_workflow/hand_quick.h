// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/capture/sheet/outline_person.h"
#include "palmar/core/progress.h"
#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/population/population.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

/// A person's hand from a few measures, or from one photograph of it flat on a sheet of paper or
/// beside a bank card, and the people whom it belongs to (docs/method/outline.md).
struct HandQuickRequest {
  /// PNG or JPEG: the hand palm down on a white sheet, fingers spread, the crease of the wrist over
  /// the sheet's edge; or on a plain table, an edge of a bank card level with that crease. Empty:
  /// none.
  std::string photo;
  std::string sheet;          ///< "a4", "letter", "card"; empty: a sheet, A4 or letter by its shape
  double wrist_inside = 0.0;  ///< how far inside of the sheet's edge the crease of the wrist
                              ///< lies, or beyond the card's, mm
  bool palm_up = false;       ///< the palm looks at the camera
  std::optional<hand::Side> side;  ///< nothing: as photographed, else right; a photograph must
                                   ///< agree
  std::vector<hand::SizedDimension> sizes;  ///< what was measured by hand
  std::string known;   ///< file of what is known of the person (read_person()): its sizes count
                       ///< beside `sizes`, its side where none is set; empty: none
  double error = 1.5;  ///< standard error of those, mm: what people reach with a ruler
                       ///< or a tape
  std::string population = "ansur2";  ///< whose proportions fill in the rest: a built-in name or a
                                      ///< .toml file
  std::string picture;      ///< PNG to write: the photograph with what was found; empty: none
  std::string out;          ///< the hand, *.hand.glb; empty: none is written
  workflow::NoteSink note;  ///< gets every note once it is known; may be empty

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

/// What a photograph shows.
struct PhotographedHand {
  geometry::RgbImage image;
  capture::OutlineScene scene;
  capture::HandOutline outline;  ///< as measured, before a model corrects it
};

struct HandQuickOutcome {
  hand::Side side = hand::Side::kRight;
  capture::OutlinePerson person;  ///< every dimension with how well it is known, and the hand;
                                  ///< without a photograph its outline is empty
  population::Population population;
  std::optional<PhotographedHand> photograph;
};

/// Makes the hand and writes it. Throws UsageError, also if nothing is known of the hand or the
/// photograph shows the other one; InputError naming the photograph: no sheet, no hand, fingers
/// that touch; OutputError; Cancelled.
HandQuickOutcome make_hand_quick(const HandQuickRequest& request, const Progress& progress = {});

/// The outcome as JSON; keys carry the unit.
std::string hand_quick_json(const HandQuickOutcome& outcome);

/// How a dimension is known: "measured", or on what evidence it follows from the rest.
std::string how_known(const population::EstimatedDimension& dimension);

}  // namespace palmar::person_workflow
