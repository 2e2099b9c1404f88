// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/cad/model/cad_model.h"
#include "palmar/cad/model/named_solid.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::cad {

/// A solid that was made, as a model of one body called `name`, its faces in the order of their
/// names. `to` is where it is moved. Throws NumericalError saying what is wrong if it isn't one
/// valid, closed solid with something inside. For the sources of module cad only.
CadModel finished_solid(const NamedSolid& made, const std::string& name,
                        const geometry::Rigid3& to = {});

}  // namespace palmar::cad
