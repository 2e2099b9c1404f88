// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/io/product_file.h"

#include "palmar/io/mesh_file.h"
#include "palmar/product/make_product.h"
#include "palmar/product/unit_guard.h"

namespace palmar {

Product load_product(const std::filesystem::path& path, const LoadProductOptions& options) {
  const MeshFile file = read_mesh(path);
  Box3 box;
  for (const Vec3& v : file.mesh.vertices) box.extend(v);
  const UnitDecision unit = decide_unit(box, file.unit, options.unit, path.string());
  Product product = make_product(path.stem().string(), file.mesh, unit, path.string());
  product.notes.insert(product.notes.end(), file.notes.begin(), file.notes.end());
  return product;
}

}  // namespace palmar
