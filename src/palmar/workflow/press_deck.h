// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/press/press.h"
#include "palmar/records/fe/inp_file.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar::workflow {

/// The indentation test of one region of a hand as a finite-element deck for CalculiX: what the
/// contact is compared with (docs/developing/finite-elements.md).
struct PressDeckRequest {
  HandChoice hand;  ///< its tissue isn't used
  hand::Region region = hand::Region::kMiddleDistal;
  contact::PressIndenter indenter = {.kind = contact::PressIndenter::Kind::kPlane};
  double tilt = 0.0;  ///< of the indenter, rad, towards the fingertip
  std::vector<double> depths = {0.5, 1.0, 1.5, 2.0};  ///< mm from first touch, ascending
  double shear_modulus = 0.01;                        ///< of the tissue, MPa
  double poisson = 0.495;  ///< of the tissue, below 0.5: tetrahedra lock near it
  records::DeckMaterial material = records::DeckMaterial::kLinear;
  double largest_tet = 2.0;          ///< mm^3
  std::optional<double> cut_offset;  ///< where the finger is cut off (TissueBlockOptions)
  std::string indenter_words;        ///< for the title: "sphere:5 at 30 deg"; "": made of the above
  std::string out;                   ///< folder that gets press.inp and the mesher's files
  void check() const;                ///< throws UsageError: field, value, what is allowed
};

struct PressDeckOutcome {
  std::filesystem::path file;  ///< the deck
  records::PressDeck deck;     ///< what it holds
};

/// Puts the indenter where the region is first touched, fills the tissue with tetrahedra
/// (mesh_by_tetgen()) and writes the deck. Throws UsageError: settings, a hand without bones,
/// punches; InputError naming the file; ProgramMissing without TetGen; NumericalError; OutputError.
PressDeckOutcome write_press_deck(const PressDeckRequest& request);

}  // namespace palmar::workflow
