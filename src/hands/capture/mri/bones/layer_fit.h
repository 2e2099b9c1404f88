// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Signal along the normal of a surface, from inside outwards.
struct LayerProfile {
  double first = 0.0;         ///< place of the first sample, mm along the normal from the vertex
  double step = 0.25;         ///< between samples, mm
  std::vector<double> value;  ///< samples; none: this vertex shows nothing
  double blur = 0.4;          ///< standard deviation of the image's blur along the normal, mm
  double known = 0.0;         ///< signal of the layer itself
};

/// Where a thin layer between two others is looked for. Places in mm along the normal.
struct LayerSearch {
  double bright = 1.0;  ///< signal that the inside is expected to have
  double usual = 0.5;   ///< signal that the outside is expected to have
  double scale = 0.05;  ///< misfit of one sample that is expected: noise and model
  double outer_first = -1.6, outer_step = 0.2;  ///< candidates for the shell's outer side
  int outers = 19;
  double thickness_first = 0.2, thickness_step = 0.2;  ///< for its thickness
  int thicknesses = 14;
  double usual_thickness = 0.9;
  double loose_tie = 1.0, tight_tie = 0.3;  ///< standard deviations of the thickness from the
                                            ///< usual one, and from that of the surroundings
  double surroundings = 6.0;                ///< radius of these
  double farthest_inner = 0.5;  ///< largest place of the inner side: what begins farther out is
                                ///< another layer
};

/// Where the outer side of a layer lies, for a surface near it.
struct LayerFit {
  geometry::TriangleMesh mesh;    ///< outer surface; adjacency of the input
  std::vector<double> thickness;  ///< of the layer, per vertex, mm
  double residual = 0.0;          ///< rms of the profiles' misfit over LayerSearch::scale
};

/// Moves a closed surface to the outer side of the layer next to it, to a fraction of a voxel.
/// The signal of a layered body, blurred by the voxels' size, is along a normal
///
///     I(s) = I_1 (1 - P((s - a) / h)) + I_2 (P((s - a) / h) - P((s - b) / h)) + I_3 P((s - b) / h)
///
/// with P the normal distribution, I_1 the inside, I_2 the layer, I_3 the outside, a and b the
/// inner and outer side of the layer and h the blur. A layer thinner than a voxel shows as a dip
/// whose depth, not its width, shows its thickness; knowing I_2, both sides are still found. I_1
/// and I_3 are solved for each (a, b) (linear, tied weakly to what is expected), the misfit is
/// tabulated over a grid of (a, b), summed over a vertex and its neighbours, and its least value
/// taken; the thickness is found twice, first nearly free, then near the median of the
/// surroundings, as where the outside is as dark as the layer only the inner side can be seen.
/// Deterministic.
LayerFit fit_layers(const geometry::TriangleMesh& near, const LayerSearch& search,
                    const std::function<LayerProfile(int vertex, const Vec3& normal)>& profile_at);

}  // namespace palmar::capture
