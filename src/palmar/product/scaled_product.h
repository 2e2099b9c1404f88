// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/product/product.h"

namespace palmar::product {

/// The product with all its lengths times `factor` > 0, about its origin: mesh, faces and distance.
/// Throws UsageError unless the factor is positive and finite.
Product scaled(const Product& product, double factor);

}  // namespace palmar::product
