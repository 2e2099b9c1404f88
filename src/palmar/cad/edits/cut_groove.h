// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gp_Ax1.hxx>

#include "palmar/cad/edits/groove.h"
#include "palmar/cad/edits/solid_edit.h"

namespace palmar::cad {

/// Cuts a groove with a ball cutter: the solid less a round bar of the groove's radius whose axis
/// runs `radius - depth` above the surface along its normals; beyond both ends of an open line it
/// leaves the surface along a parabola. `axis`: the model's longest direction through the middle of
/// its box. Throws NumericalError naming the groove: no surface near its line, a line bent more
/// sharply than the cutter, nothing cut.
void cut_groove(SolidEdit& edit, const GrooveEdit& groove, const gp_Ax1& axis);

}  // namespace palmar::cad
