// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/contact/contact.h"

namespace palmar::contact {

/// The skin's pressure on a product along a motion: what is watched while the product is dragged.
/// The surface is prepared once and not refined where it is touched, and round an edge that is
/// sharper than the skin's mesh nothing bridges the facets that go through the product:
/// map_to_product() does both, for results at rest. Some 1 ms a call. One thread at a time.
class MovingFootprint {
 public:
  /// `surface`: product frame, mm; pressures are per vertex of it, so it should be as fine as the
  /// skin is.
  explicit MovingFootprint(geometry::TriangleMesh surface);

  const geometry::TriangleMesh& surface() const { return surface_; }

  /// Vertices of the surface that are pressed on.
  struct Loaded {
    std::vector<int> vertex;       ///< ascending
    std::vector<double> pressure;  ///< MPa, above 0
  };
  /// Of a contact with deformed skin and pressures. The result is overwritten by the next call.
  const Loaded& under(const hand::Hand& hand, const ContactResult& contact);

 private:
  std::array<int, 3> cell_of(const Vec3& point) const;
  void press(const std::array<Vec3, 3>& facet, const std::array<double, 3>& pressure);

  geometry::TriangleMesh surface_;
  std::vector<Vec3> normal_;
  // The surface's vertices by cells of a grid.
  Vec3 low_ = Vec3::Zero();
  double cell_ = 0.0;  // mm
  std::array<int, 3> cells_{};
  std::vector<int> begin_, vertex_;
  // Of the call under way, per vertex: how far off its facet lies [mm], and the pressure there.
  std::vector<double> off_, pressure_;
  std::vector<int> touched_;
  Loaded loaded_;
};

/// The product's mesh for MovingFootprint: edges split until they are about as long as the skin's,
/// or as short as the number of triangles allows.
geometry::TriangleMesh surface_for_moving(const geometry::TriangleMesh& product,
                                          int most_triangles);

}  // namespace palmar::contact
