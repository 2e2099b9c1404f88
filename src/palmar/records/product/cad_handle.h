// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "palmar/records/product/cad_features.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/redesign/handle_shape.h"

namespace palmar::records {

/// A handle as a solid: valid, closed, read back from its STEP file.
struct HandleSolid {
  std::string step;     ///< bytes of a STEP file, mm
  FaceMesh mesh;        ///< mm
  double volume = 0.0;  ///< mm^3
  int faces = 0;
  int poles = 0;  ///< of the surface that the side's faces lie on
};

/// A handle made, alone and in its product.
struct MadeHandle {
  HandleSolid handle;
  std::optional<HandleSolid> whole;  ///< the product with it, if a source was given; no poles
  std::string failure;               ///< why there is no whole one though a source was given
};

/// Made in the child process (run_cad()). `source`: of the product that goes on beyond the handle,
/// if it has a solid. Throws NumericalError if no valid solid comes out, Cancelled. `object` names
/// the product in messages.
MadeHandle make_handle(const redesign::HandleShape& shape, const std::string& object,
                       const std::optional<CadSource>& source = {}, double chordal_error = 0.01,
                       const CadLimits& limits = {}, const Progress& progress = {});

}  // namespace palmar::records
