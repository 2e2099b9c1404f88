// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/scaled_product.h"

#include <cmath>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/mesh_distance.h"

namespace palmar::product {

Product scaled(const Product& product, double factor) {
  if (!(factor > 0.0) || !std::isfinite(factor)) {
    throw UsageError("size of a product is " + std::to_string(factor) +
                     "; a positive number is required");
  }
  if (factor == 1.0) return product;
  Product result = product;
  for (Vec3& v : result.mesh.vertices) v *= factor;
  result.distance = std::make_shared<const geometry::MeshDistance>(result.mesh);
  if (result.faces != nullptr) {
    result.faces = std::make_shared<const ProductFaces>(scaled(*result.faces, factor));
  }
  return result;
}

}  // namespace palmar::product
