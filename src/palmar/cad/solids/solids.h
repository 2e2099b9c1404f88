// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/cad/model/cad_model.h"
#include "palmar/product/parametric_kinds.h"

namespace palmar::cad {

/// The solid of a kind of product (product/parametric_kinds.h), mm: one closed body whose faces
/// have names ("front", "fillet 1", "top"). Long kinds lie along z, all about the origin. The same
/// values give the same solid, face by face; faces of cylinder and prism have the names and numbers
/// of those in product/primitives.h.
///
/// `values`: of complete_values(). Throws NumericalError naming kind and values if OpenCASCADE
/// makes no valid closed solid of them.
CadModel make_kind_solid(const product::ParametricKind& kind, const product::KindValues& values);

}  // namespace palmar::cad
