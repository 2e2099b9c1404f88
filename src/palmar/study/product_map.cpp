// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "palmar/geometry/remesh/split_edges.h"
#include "palmar/study/study_record.h"

namespace palmar::study {

geometry::TriangleMesh product_map(const geometry::TriangleMesh& product, double edge) {
  return geometry::split_long_edges(product, edge);
}

ProductMap product_map(const product::Product& product, double edge) {
  geometry::SplitMesh split = geometry::split_with_parents(product.mesh, edge);
  ProductMap map{std::move(split.mesh), std::move(split.parent), {}};
  if (product.faces == nullptr) return map;
  product::check_faces(*product.faces, product.mesh.triangle_count(), product.name);
  map.face_of_triangle.reserve(map.parent.size());
  for (const int parent : map.parent) {
    map.face_of_triangle.push_back(product.faces->face_of_triangle[parent]);
  }
  return map;
}

}  // namespace palmar::study
