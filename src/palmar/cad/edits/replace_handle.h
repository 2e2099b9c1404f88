// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/cad/model/cad_model.h"
#include "palmar/redesign/handle_shape.h"

namespace palmar::cad {

/// The product with its handle shaped anew: what lies within the handle's outlines between its ends
/// (HandleBody::bottom, top) is cut out, and make_handle_solid() united with the rest, which it
/// meets in planes, 0.1 mm within the outlines that were there: in a step as high. Names of
/// faces that remain are kept; those of the handle are its own.
///
/// Throws NumericalError saying why there is no such solid: several bodies, or no valid closed
/// solid of the volume of both parts.
CadModel replace_handle(const CadModel& product, const redesign::HandleShape& shape);

}  // namespace palmar::cad
