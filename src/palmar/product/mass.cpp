// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/mass.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::product {

MassProperties mass_properties(const Product& product) {
  constexpr double kMostRim = 0.05;  // of the square root of the area
  constexpr double kSheet = 1e-4;    // volume over area^1.5; a cube has 0.07
  const geometry::TriangleMesh& mesh = product.mesh;
  double rim = 0.0;
  for (const auto& [a, b] : geometry::boundary_edges(geometry::build_topology(mesh))) {
    rim += (mesh.vertices[a] - mesh.vertices[b]).norm();
  }
  const double area = geometry::surface_area(mesh);
  const double volume = std::abs(geometry::signed_volume(mesh));
  const bool is_open = rim > kMostRim * std::sqrt(area);
  if (is_open || !(volume > kSheet * std::pow(area, 1.5))) {
    std::array<char, 120> why{};
    if (is_open) {
      std::snprintf(why.data(), why.size(), "its surface is open along %.0f mm of edges", rim);
    } else {
      std::snprintf(why.data(), why.size(), "its surface encloses only %.0f mm3", volume);
    }
    throw InputError(product.name + ": " + why.data() +
                     ", so its volume and centre of mass are not known; give setting \"mass\" or "
                     "setting \"weight\" and setting \"mass at\", or close the mesh");
  }
  return {volume, geometry::centre_of_volume(mesh)};
}

double weight_of(double volume, double density) {
  return volume * 1e-3 * density * 1e-3 * kStandardGravity;  // mm^3 -> cm^3 -> g -> kg -> N
}

}  // namespace palmar::product
