// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::redesign {

/// Smooths values at the vertices of a mesh along its surface: heat diffusion
///
///     (M + t L) u = M u0,   solved twice with t = length^2 / 4,
///
/// M the vertices' areas, L the cotangent Laplacian (linear finite elements). Nearly a Gaussian of
/// standard deviation `length` on a plane. Values are held within the range of the input; but for
/// that the sum of M u stays. Uneven triangles don't matter; walls that are near but not joined
/// don't mix. A border lets nothing through.
///
/// Source: Desbrun, Meyer, Schroeder, Barr 1999, "Implicit fairing of irregular meshes using
/// diffusion and curvature flow", section 3.
class SurfaceDiffusion {
 public:
  /// `length` in mm; 0 leaves values as they are. Throws NumericalError if the system can't be
  /// factorised (coordinates that aren't finite).
  SurfaceDiffusion(const geometry::TriangleMesh& mesh, double length);
  ~SurfaceDiffusion();

  /// One value per vertex. Vertices without triangles keep theirs.
  std::vector<double> smooth(const std::vector<double>& values) const;
  std::vector<Vec3> smooth(const std::vector<Vec3>& values) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::redesign
