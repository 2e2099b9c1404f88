// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/rigid3.h"
#include "palmar/product/product.h"

namespace palmar::tests {

/// The scanned products of ../shared are there.
bool has_scans();
/// Names of the products that a list of holds is about, in its order; scans only if they are there.
std::vector<std::string> tried_products();

/// A made or scanned product by name. Throws UsageError for an unknown one.
product::Product tried_product(const std::string& name);

// The same thing in another way.

product::Product moved(const product::Product& product, const geometry::Rigid3& motion);
/// x -> -x, triangles turned so that they stay counter-clockwise seen from outside.
product::Product mirrored(const product::Product& product);
/// Triangles and vertices in another order.
product::Product shuffled(const product::Product& product);
/// Meshed with edges half as long: made products anew from their solid, scans by cutting each
/// triangle into four.
product::Product with_finer_mesh(const std::string& name);
/// With edges twice as long (remesh()).
product::Product with_coarser_mesh(const std::string& name);

}  // namespace palmar::tests
