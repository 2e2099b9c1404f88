// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/cad/model/named_solid.h"
#include "palmar/product/parametric_kinds.h"

namespace palmar::cad {

// One function per kind of product (product/parametric_kinds.h), for solids.cpp only: complete
// values in, a solid with named faces out; not yet checked.

NamedSolid make_cylinder(const product::KindValues& values);
NamedSolid make_tapered_handle(const product::KindValues& values);
NamedSolid make_bottle(const product::KindValues& values);
NamedSolid make_bicycle_grip(const product::KindValues& values);

NamedSolid make_pistol_grip(const product::KindValues& values);
NamedSolid make_knife_handle(const product::KindValues& values);
NamedSolid make_screwdriver_handle(const product::KindValues& values);

NamedSolid make_elliptic_handle(const product::KindValues& values);
NamedSolid make_prism(const product::KindValues& values);
NamedSolid make_phone(const product::KindValues& values);
NamedSolid make_sphere(const product::KindValues& values);
NamedSolid make_ellipsoid(const product::KindValues& values);

}  // namespace palmar::cad
