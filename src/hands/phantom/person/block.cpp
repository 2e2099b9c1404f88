// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/phantom/person/block.h"

#include <fmt/format.h>

#include "palmar/core/error.h"

namespace palmar::phantom {

geometry::ColouredMesh make_block(const Vec3& edges) {
  if (!(edges.minCoeff() >= 5.0 && edges.maxCoeff() <= 200.0)) {
    throw UsageError(
        fmt::format("a block of {:g} x {:g} x {:g} mm; edges of 5 to 200 mm are allowed", edges.x(),
                    edges.y(), edges.z()));
  }
  const geometry::Srgb cardboard(0.74F, 0.57F, 0.42F);
  geometry::ColouredMesh block;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto first = static_cast<int>(block.mesh.vertices.size());
      for (const double a : {-0.5, 0.5}) {
        for (const double b : {-0.5, 0.5}) {
          Vec3 corner = Vec3::Zero();
          corner[axis] = side * edges[axis];
          corner[u] = a * edges[u];
          corner[v] = b * edges[v];
          block.mesh.vertices.push_back(corner);
          block.colour.push_back(cardboard);
        }
      }
      // u x v is the axis: the corners -- +- ++ -+ go round it.
      if (side > 0.0) {
        block.mesh.triangles.push_back({first, first + 2, first + 3});
        block.mesh.triangles.push_back({first, first + 3, first + 1});
      } else {
        block.mesh.triangles.push_back({first, first + 3, first + 2});
        block.mesh.triangles.push_back({first, first + 1, first + 3});
      }
    }
  }
  return block;
}

}  // namespace palmar::phantom
