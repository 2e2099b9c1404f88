// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/redesign/handle_shape.h"

namespace palmar {

/// A handle as a solid: valid, closed, read back from its STEP file.
struct HandleSolid {
  std::string step;     ///< bytes of a STEP file, mm
  FaceMesh mesh;        ///< mm
  double volume = 0.0;  ///< mm^3
  int faces = 0;
  int poles = 0;  ///< of the surface that the side's faces lie on
};

/// Made in the child process (run_cad()). Throws NumericalError if no valid solid comes out,
/// Cancelled. `object` names the product in messages.
HandleSolid make_handle(const HandleShape& shape, const std::string& object,
                        double chordal_error = 0.01, const CadLimits& limits = {},
                        const Progress& progress = {});

}  // namespace palmar
