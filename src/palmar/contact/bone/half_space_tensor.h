// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// How far forces on the surface of an incompressible half-space move it, times its shear modulus,
/// as a tensor: displacement [mm] = tensor [1/mm] force [N] / G [MPa]. Between points at the
/// distance r along the unit vector e a point force gives
///
///     (I + e e^T) / (4 pi r)
///
/// (Boussinesq, Cerruti; Johnson 1985, eq. 3.19, 3.77 at nu = 1/2: no coupling of normal and
/// tangential). It is also the response inside an endless solid of twice the stiffness, so on a
/// curved skin it stays symmetric and positive definite.

/// Forces on discs of radius a_i, a_j [mm] (the mean of both), with unit normals n_i, n_j: normal
/// part disc_response(), tangential part tangential_response().
Eigen::Matrix3d disc_tensor(const Vec3& between, double a_i, double a_j, const Vec3& n_i,
                            const Vec3& n_j);

/// A force spread by S about one point and averaged with S about another, where S = 1 - (1 - g)^3
/// and g is the mean with Gaussian weights of width w_i, w_j [mm]. From the terms of S, in Hankel
/// space exp(-a k^2),
///
///     4 pi normal: B = 1/2 sqrt(pi / a) exp(-y) I0(y),    y = r^2 / 8 a
///     along e:     B + T,   T = 1/4 sqrt(pi / a) exp(-y) (I0(y) + I1(y))
///     across e:    2 B - T
Eigen::Matrix3d spread_tensor(const Vec3& between, double w_i, double w_j, const Vec3& n_i,
                              const Vec3& n_j);

/// Share of a half-space that is taken from the elements' response between two nodes, and put back
/// between two vertices: 1 up to 3 widths (the mean of both), 0 from 6 on, smooth between.
double near_share(double r, double w_i, double w_j);

}  // namespace palmar::contact
