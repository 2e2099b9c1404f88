// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/cad/model/cad_model.h"
#include "verbs.h"

namespace palmar::cad_worker {

/// The solid of a source: {file, millimetres_per_unit?} or {kind, parameters}. What was found in a
/// file is added to `notes`. Throws InputError if there is no solid.
cad::CadModel model_of(const Json& source, Json& notes);

}  // namespace palmar::cad_worker
