// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/geometry/types.h"

namespace palmar::product {

struct ContactBodyOptions {
  /// A place is inside a cavity if less than this share of the sky is seen from it (weighted by the
  /// cosine to its normal): a bore from 0.35 diameters below its mouth on, whereas the inside of a
  /// ring or of a handle's loop sees more than twice as much. [0, 1)
  double cavity_sky = 0.25;
  /// Thin walls that hang together with a cavity belong to it up to its mouth, where half the sky
  /// is seen. [cavity_sky, 1]
  double mouth_sky = 0.6;
  double outer_sky = 0.5;   ///< from an outer face at least this share of the sky is seen, (0, 1]
  double thin_wall = 30.0;  ///< mm; walls thicker than twice what skin reaches need no filling
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// What skin meets of a product.
struct ContactBody {
  geometry::TriangleMesh mesh;  ///< the product's own if it has no thin wall round a cavity
  int dropped = 0;              ///< triangles of the product that skin can't reach
  double thinnest_wall = 0.0;   ///< round the cavity, mm
  double width = 0.0;           ///< free way across the cavity, mm; half of its surface has less
};

/// A shelled product for contact: cavities that a hand which holds it can't reach into count as
/// solid. Else skin that comes 4 mm deep through a wall of 2 mm stands in the cavity, free of any
/// contact, and within a wall it is nearest to the inner surface.
///
/// A triangle belongs to a cavity if it sees little sky and a thin wall parts it from an outer
/// face; so does what hangs together with such triangles and sees little sky or lies on a thin
/// wall, up to the mouth. It is dropped, and the mouths are closed by fans. Cavities of less than
/// 200 mm^2 stay. Slots and grooves in a solid stay: what lies behind their bottom sees little sky,
/// too. Bowls stay: one sees much sky from inside.
///
/// `mesh`: closed, oriented outwards, mm. Deterministic. Throws as RayQuery does.
ContactBody contact_body(const geometry::TriangleMesh& mesh,
                         const ContactBodyOptions& options = {});

}  // namespace palmar::product
