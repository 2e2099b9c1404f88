// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/solve/skin_product.h"

namespace palmar::contact {

/// The skin as it lies on the product, where its pressure acts: skin that is near is put on the
/// product's surface (loaded skin ends there anyway, lifted skin below its nearest point), the rest
/// stays where the posture has it. Positions in the product's frame; areas, radii and normals are
/// those of that surface. They don't depend on the forces. The solver's own responses and distances
/// are those of the reference posture, in which the tissue is at rest.
///
/// The thesis counts areas in the reference posture, and so does its preset, `xie2014`.
SkinGeometry pressed_skin(const PreparedHand::Impl& prepared, const SkinOnProduct& skin,
                          const std::vector<Vec3>& undeformed);

/// Pressure of every vertex, MPa: its force [N] over its area on the product. Where skin is crowded
/// together there (in a crease, or on a ridge narrower than its mesh) it is the mean over a disc of
/// the vertex' area at rest: nothing finer than the mesh is told. `at_rest`: those areas, mm^2.
std::vector<double> pressure_on_skin(const SkinGeometry& pressed,
                                     const std::vector<double>& at_rest,
                                     const std::vector<double>& force);

}  // namespace palmar::contact
