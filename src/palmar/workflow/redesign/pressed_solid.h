// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "palmar/core/progress.h"
#include "palmar/redesign/pressed_shape.h"
#include "palmar/workflow/redesign/held_original.h"

namespace palmar::workflow {

/// A pressed handle as a solid: one bicubic surface through its outlines.
struct PressedSolid {
  std::filesystem::path file;      ///< pressed.step: all of the product; pressed-handle.step: its
                                   ///< handle alone
  double volume = 0.0;             ///< mm^3
  double end_radius = 0.0;         ///< mm, of the edges round flat ends, as they are now
  double largest_deviation = 0.0;  ///< mm, of the solid from the pressed mesh, beside rounded ends
  double deviation = 0.0;          ///< root mean square, mm
  int faces = 0, poles = 0;        ///< of the handle's surface
};

/// Makes the solid of a pressed shape on grids of 3.5, 2.5 and 1.75 mm until it lies within 0.05 mm
/// (root mean square) of the mesh, and writes the nearest to the request's folder; or why there is
/// none, a sentence about the product. Throws Cancelled, InputError, OutputError.
std::variant<PressedSolid, std::string> write_pressed_solid(
    const RedesignRequest& request, const HeldOriginal& original, const product::Product& pressed,
    const redesign::PressedShapeOptions& options, const Progress& progress);

}  // namespace palmar::workflow
