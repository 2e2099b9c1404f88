// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// A surface that is bent onto another one, or that other one. Points of different parts are never
/// partners, but part 0 goes with every part: fingers that touch aren't mixed.
struct FitSurface {
  geometry::TriangleMesh mesh;  ///< oriented outwards, mm
  std::vector<int> part;        ///< per vertex
  std::vector<char> is_silent;  ///< per vertex: has no partner (a cap, a marker, a fixture)
};

/// A point of the moving surface whose place is known.
struct FitPin {
  Triangle vertex{};
  std::array<double, 3> share{};  ///< barycentric
  Vec3 place = Vec3::Zero();      ///< mm
};

struct NonrigidFitOptions {
  double reach = 12.0;         ///< of partners, at the beginning, mm
  double last_reach = 4.0;     ///< at the end, mm
  double normals_agree = 0.5;  ///< least cosine between partners' normals
  double stiffness = 30.0;     ///< at the beginning; against one vertex' pull
  double last_stiffness = 0.3;
  int levels = 9;           ///< of stiffness
  int rounds = 3;           ///< of partners at each level
  double pin_weight = 8.0;  ///< of a pin, against one vertex' pull
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// Bends `moving` onto `fixed`; returns its vertices. Each round pairs vertices of both surfaces
/// with the nearest points of the other, as far as parts and normals agree and nothing silent is
/// met, and solves (pins among the second sum)
///
///     min_x  sum_i w_i |x_i - t_i|^2 + sum_k w_k |sum_c b_kc x_c - t_k|^2
///            + mu sum_i |L x_i - s_i R_i L p_i|^2 ,
///
/// t the foot of a point on its partner's tangent plane, w = (1 + (r/c)^2)^-2, L the mean of the
/// neighbours minus the vertex, p the vertices at the start, s_i R_i the similarity that takes the
/// vertex' surroundings from p to x. The stiffness mu falls from level to level: the surface goes
/// over as a whole first, then in detail; what has no partner follows its surroundings.
///
/// Source: Amberg, Romdhani, Vetter 2007 (falling stiffness); Sorkine et al. 2004 (Laplacian
/// coordinates). Deterministic.
std::vector<Vec3> fit_nonrigidly(const FitSurface& moving, const FitSurface& fixed,
                                 const std::vector<FitPin>& pins = {},
                                 const NonrigidFitOptions& options = {},
                                 const Progress& progress = {});

}  // namespace palmar::capture
