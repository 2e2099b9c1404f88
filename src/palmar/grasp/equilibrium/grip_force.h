// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/geometry/types.h"

namespace palmar::grasp {

/// How hard a product is squeezed.
struct Squeeze {
  double force = 0.0;           ///< N; half the sum of |f . across|
  Vec3 across = Vec3::UnitZ();  ///< unit direction in which the squeeze is largest
  double sum_of_normals = 0.0;  ///< N; sum of |f|: between 2 and pi times the grip force for
                                ///< forces in one plane
};

/// Grip force across the plane of largest squeeze: what two halves of the product, cut there, would
/// press on a load cell between them, if the forces were in balance. A dynamometer's reading is
/// one such force; the sum of normal forces is 2 (two opposed fingers) to pi times it (even
/// pressure round a cylinder).
Squeeze grip_force(const std::vector<Vec3>& forces);

/// Of the normal forces of a solved contact, product frame.
Squeeze grip_force(const contact::ContactResult& contact, const geometry::DistanceField& product);

}  // namespace palmar::grasp
