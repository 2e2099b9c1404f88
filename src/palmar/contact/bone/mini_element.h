// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// Stiffness of one tetrahedron of an elastic solid that may be incompressible: displacement
/// linear with a bubble 256 xi_0 xi_1 xi_2 xi_3 in the middle, pressure linear (the MINI element;
/// Arnold, Brezzi, Fortin 1984). With the bubble eliminated, for the shear modulus 1 MPa,
///
///     | stiffness   divergence^T |  | u |     | f |
///     | divergence      -slack   |  | p |  =  | 0 |
///
/// u: 12 displacements (3 per corner), mm; p: 4 pressures, MPa, positive in tension. `slack` is
/// positive semidefinite (definite below nu = 1/2), so the assembled matrix is quasi-definite and
/// can be factored without pivoting in every order that takes a corner's u before its p (Vanderbei
/// 1995). Doesn't lock for nu -> 1/2.
struct MiniElement {
  Eigen::Matrix<double, 12, 12> stiffness;  ///< N/mm
  Eigen::Matrix<double, 4, 12> divergence;  ///< mm^2
  Eigen::Matrix4d slack;                    ///< mm^3/MPa
};

/// `corner`: mm, right-handed. 0 <= poisson <= 0.5. A flat tetrahedron gives entries that aren't
/// finite.
MiniElement mini_element(const std::array<Vec3, 4>& corner, double poisson);

}  // namespace palmar::contact
