// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/geometry/types.h"

namespace palmar::geometry {

/// Generalised winding number of a triangle mesh at a point q,
///
///     w(q) = 1/(4 pi) sum_t Omega_t(q),
///
/// Omega_t the signed solid angle of triangle t, positive where its back is seen. 1 inside and 0
/// outside a closed mesh with outward triangles; in between near holes of an open mesh, where
/// w > 0.5 is the natural reading of "inside" (Jacobson, Kavan, Sorkine-Hornung 2013). 2 where two
/// solids overlap, -1 inside a mesh turned inside out: orientation must be right, see orient.h.
///
/// Far groups of triangles are replaced by their multipole expansion up to the quadratic moment;
/// near triangles are exact (van Oosterom, Strackee 1983). Error below 0.02.
///
/// Source: Barill, Dickson, Schmidt, Levin, Jacobson 2018, Fast winding numbers for soups and
/// clouds, eq. (13) to (15).
class WindingNumber {
 public:
  explicit WindingNumber(const TriangleMesh& mesh);
  ~WindingNumber();
  WindingNumber(WindingNumber&&) noexcept;
  WindingNumber& operator=(WindingNumber&&) noexcept;

  /// w at a point [mm]. On the surface itself the value lies between those of the two sides.
  double at(const Vec3& point) const;
  /// w at a point [mm] off the surface of a closed mesh, where it is a whole number: a coarse sum
  /// that is made finer if it doesn't come near a whole number.
  int whole_at(const Vec3& point) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// The sum over all triangles without expansion; for tests and tiny meshes.
double exact_winding_number(const TriangleMesh& mesh, const Vec3& point);

}  // namespace palmar::geometry
