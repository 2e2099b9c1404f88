// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::contact {

/// Tangential displacement of an incompressible (nu = 0.5) elastic half-space under a tangential
/// force, times its shear modulus G. A point force Q along x gives, at the distance r,
///
///     u_x = Q / (4 pi G r) (1 + x^2 / r^2),   u_y = Q / (4 pi G r) x y / r^2,   u_z = 0,
///
/// so displacement = (I + e e^T) / (4 pi G r) force with the unit vector e along the line between
/// the two points; and a normal force has no tangential displacement: friction and pressure are
/// independent problems where the product is rigid.
///
/// Source: Cerruti 1882; Johnson 1985, Contact Mechanics, section 3.6, eq. (3.77).

/// Part of the response along e of a force that is spread evenly over a disc of radius a [mm], at r
/// [mm] from its centre; result [1/mm]: 1 / (pi a^2) times the integral of cos(2 phi) / (4 pi s)
/// over the disc, s and phi the polar coordinates of its points seen from there. With k = r / a <=
/// 1
///
///     ((2 - k^2) E(k) - 2 (1 - k^2) K(k)) / (3 pi^2 a k^2),
///
/// 0 in the centre, and 1 / (4 pi r) far away. Tabulated; error below 1e-4 / (4 pi a).
double directed_disc_response(double r, double a);

/// The tensor by which a force spread over a disc of radius a_j round one point moves another, of
/// radius a_i, `between` [mm] apart; the mean of both discs, so that it is symmetric (Betti):
///
///     (3/2 D(r) - 1/2 g(r)) I + g(r) e e^T   ->   (I + e e^T) / (4 pi r),
///
/// D = disc_response() (response.h), g = directed_disc_response(); 1/mm. Applied to vectors in
/// space, of which each point takes the part in its own tangent plane: exact on a plane, the
/// response inside an incompressible solid in general, and positive definite like that.
Eigen::Matrix3d tangential_response(const Vec3& between, double a_i, double a_j);

}  // namespace palmar::contact
