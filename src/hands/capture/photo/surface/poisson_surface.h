// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/photo/surface/depth_fusion.h"
#include "hands/imaging/volume.h"
#include "palmar/core/progress.h"

namespace palmar::capture {

struct PoissonOptions {
  double spacing = 0.8;     ///< mm between grid points
  double screening = 4.0;   ///< pull of the points on the field, against its gradient
  double tolerance = 1e-4;  ///< of the residual of the linear system
  int max_iterations = 60;  ///< of conjugate gradients
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// The field whose zero is the surface, and how densely points lie on it.
struct PoissonField {
  imaging::Volume field;    ///< about 1/2 inside, -1/2 outside
  imaging::Volume density;  ///< points per mm^2 of surface where it passes
  int iterations = 0;
  double residual = 0.0;  ///< relative
  bool has_converged = false;
};

/// Smoothest field that steps from -1/2 to 1/2 across oriented points: least
///
///     sum over faces (chi_j - chi_i - g_ij)^2 + sum over cells w_i (chi_i - t_i)^2
///
/// on a regular grid. g is the step over a face that the points ask for: each stands for an area a
/// (1 over the density of points) and gives -n a / h^2 to the faces round it, shared trilinearly. w
/// is the screening: each point asks the cells round it for the value of a unit step smoothed over
/// a cell at their distance from its plane, with weight `screening` a / h^2. Cells where `bound` is
/// below 0.001 are outside (t = -1/2), whatever the points say. The sides of the box bind nothing.
///
/// Solved by conjugate gradients, a multigrid cycle as preconditioner; any number of threads gives
/// the same. Throws InputError without points.
/// Source: Kazhdan, Hoppe 2013, "Screened Poisson surface reconstruction", the system on a regular
/// grid instead of an octree; targets by distance as in Calakli, Taubin 2011.
PoissonField fit_poisson_field(const std::vector<SurfacePoint>& points,
                               const imaging::Volume& bound, const PoissonOptions& options = {},
                               const Progress& progress = {});

}  // namespace palmar::capture
