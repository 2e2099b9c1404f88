// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/cad/model/cad_model.h"

namespace palmar::cad {

/// How far a changed model's surface lies from the surface before, mm.
struct SurfaceChange {
  double largest = 0.0;   ///< over both surfaces' points: to the nearest point of the other one
  double of_faces = 0.0;  ///< over the points of the given faces before, to the surface after
};

/// Measured on triangles within 0.02 mm of the surfaces, at their corners (dense where a surface is
/// bent) and at points not farther apart than a fiftieth of the model's size (at most 3 mm): a
/// Hausdorff distance. `faces`: numbers in
/// `before`.
SurfaceChange surface_change(const CadModel& before, const CadModel& after,
                             const std::vector<int>& faces = {});

}  // namespace palmar::cad
