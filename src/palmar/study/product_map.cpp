// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/split_edges.h"
#include "palmar/study/study_record.h"

namespace palmar {

TriangleMesh product_map(const TriangleMesh& product, double edge) {
  return split_long_edges(product, edge);
}

}  // namespace palmar
