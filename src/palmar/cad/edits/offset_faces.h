// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gp_Ax1.hxx>
#include <map>
#include <string>
#include <vector>

#include "palmar/cad/edits/solid_edit.h"

namespace palmar::cad {

/// Moves faces along their outward normals by a distance each, mm, positive outwards; the faces
/// beside are extended or cut back until they meet. Planes, cylinders, cones, spheres, tori and
/// freeform faces whose neighbours meet them at an edge. Throws NumericalError naming `feature`.
void offset_faces(SolidEdit& edit, const std::map<int, double>& distance,
                  const std::string& feature);

/// Tilts planes, cylinders and cones about the line in which they meet the plane through `neutral`
/// across its direction: by `angle` rad, positive so that the body gets thinner along it. Throws
/// NumericalError naming `feature`.
void taper_faces(SolidEdit& edit, const std::vector<int>& faces, double angle,
                 const gp_Ax1& neutral, const std::string& feature);

}  // namespace palmar::cad
