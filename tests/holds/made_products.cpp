// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "made_products.h"

#include "palmar/core/error.h"

namespace palmar::tests {

const std::vector<MadeShape>& made_shapes() {
  static const std::vector<MadeShape> all = [] {
    std::vector<MadeShape> shapes = made_household();
    for (MadeShape& shape : made_tools()) shapes.push_back(std::move(shape));
    for (MadeShape& shape : made_moved()) shapes.push_back(std::move(shape));
    return shapes;
  }();
  return all;
}

const MadeShape& made_shape(const std::string& name) {
  for (const MadeShape& shape : made_shapes()) {
    if (shape.name == name) return shape;
  }
  throw UsageError("made product \"" + name + "\" doesn't exist");
}

}  // namespace palmar::tests
