// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// Normal displacement of an incompressible (nu = 0.5) elastic half-space under a normal force,
/// times its shear modulus G: u [mm] = response [1/mm] * force [N] / G [MPa], positive inwards.
/// Distances are geodesic, on the skin in the reference posture.

constexpr double kMinDistance = 0.5;  // mm; r0 of Xie 2014, eq. (3-2)

/// Point force (Xie 2014, eq. 3-1, 3-2): 1 / (4 pi max(r, r0)), r0 = 0.5 mm; r [mm], result [1/mm].
double point_response(double r);

/// The same force as uniform pressure on a disc of radius a [mm], seen at the distance r [mm] from
/// its centre; result [1/mm]. With rho = r / a and the complete elliptic integrals E, K:
///
///     rho <= 1:  E(rho) / (pi^2 a)
///     rho >  1:  rho (E(1/rho) - (1 - 1/rho^2) K(1/rho)) / (pi^2 a)  ->  1 / (4 pi r)
///
/// so 1 / (2 pi a) in the centre and 1 / (pi^2 a) on the edge. Tabulated; relative error below
/// 1e-5. Source: Johnson 1985, Contact Mechanics, section 3.4, eq. (3.29).
double disc_response(double r, double a);

/// Entry of R_Bou between two vertices r [mm] apart that stand for discs of radii a_i, a_j [mm]
/// (a = sqrt(Voronoi area / pi)); the mean of the two discs' responses, so that the matrix is
/// symmetric (Betti). Kernel::kPoint ignores the radii.
double boussinesq_response(Kernel kernel, double r, double a_i, double a_j);

/// Entry of R_Gau (Xie 2014, eq. 3-5, 3-11): exp(-(r - b)^2 / (2 c^2)); r, b, c in mm, no unit.
double gaussian_response(double r, double b, double c);

/// Shear modulus of a region at the largest penetration d_max [mm] (Xie 2014, eq. 3-3), MPa:
/// G0 + (G_lim - G0) d_max / d_lim, held at G_lim beyond d_lim.
double shear_modulus_at(const hand::StiffeningLaw& law, double d_max);

/// Height of the bulge around a contact that carries `force` [N] in all, mm: a0 min(1, F / 1 N).
/// Eq. (3-6), a(d_max) = a0 G0 / G, is meant to keep the height of the bulge while the force grows
/// (measured change: 0.1 mm; Xie 2014, section 3.3.1), but force grows faster than G, and a wide
/// palm contact would bulge by 20 mm; so the height itself is held at a0, measured at 1 N.
double swelling_height_at(const hand::RegionTissue& tissue, double force);

/// Area [mm^2] shared by two discs of radii a, b [mm] whose centres are r [mm] apart. Used to
/// average vertex pressures over a sensor cell.
double disc_overlap(double r, double a, double b);

}  // namespace palmar::contact
