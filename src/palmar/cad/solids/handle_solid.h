// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/cad/model/cad_model.h"
#include "palmar/redesign/handle_shape.h"

namespace palmar::cad {

/// A handle shaped anew as a solid, product frame, mm: one bicubic B-spline surface through few
/// sections round it, parted into the faces "right", "palm", "left" and "fingers" (by where they
/// look in the handle's frame: +x, +y, -x, -y), plane ends "bottom" and "top", and the edges round
/// these, rounded with the shape's end radius over kEndAngle in the same surface, in four faces,
/// too ("bottom fillet, palm"). A handle that is only a part of its product ends in planes where it
/// runs into it, with sharp edges. Throws NumericalError if OpenCASCADE makes no valid closed solid
/// of it.
CadModel make_handle_solid(const redesign::HandleShape& shape);

}  // namespace palmar::cad
