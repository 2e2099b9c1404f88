// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// Pressure on the product's surface: the product's mesh, refined where it is touched so that the
/// map is not coarser than the skin.
struct ProductFootprint {
  geometry::TriangleMesh surface;  ///< product frame, mm
  std::vector<double> pressure;    ///< per vertex of `surface`, MPa; 0 where not touched
  std::vector<int> parent = {};    ///< per triangle of `surface`: the product's it is a part of
};

/// Maps the skin's pressure, which counts per area of the product (ContactResult::pressure), to the
/// product's surface. Integral and force agree within 2 % where the product's surface is smooth;
/// round an edge sharper than the skin's mesh, facets go from one side to the other through the
/// product, and what lies before them gets their pressure, less as the way round the edge is
/// longer. Where skin spans grooves narrower than its mesh some of the force is lost: a sixth on a
/// fluted screwdriver. Pressure goes to
/// 0 over the facets at the edge of the contact, so the area that has any is larger than that in
/// contact, by up to a facet all round. Triangles
/// longer than `edge_length` [mm] are split where the product is touched, at most as deep as
/// needed; the shape is unchanged.
ProductFootprint map_to_product(const hand::Hand& hand, const ContactResult& contact,
                                const geometry::TriangleMesh& product, double edge_length = 2.0);

}  // namespace palmar::contact
