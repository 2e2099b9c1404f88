// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// Outward normals of the product where loaded vertices meet it, product frame: the way on which
/// they were moved there; for those that hardly moved, of the surface.
std::vector<Vec3> contact_normals(const ContactResult& contact,
                                  const geometry::DistanceField& product,
                                  const std::vector<int>& loaded);

/// Vertices that carry force, ascending.
std::vector<int> loaded_vertices(const ContactResult& contact);

}  // namespace palmar::contact
