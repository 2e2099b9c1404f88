// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "solid_shapes.h"

namespace palmar::tests {

/// An everyday product made from simple solids, of the size of such things. tests/holds/made.toml
/// and moved.toml say how people take hold of it.
struct MadeShape {
  std::string name;
  product::Sdf solid;
  Lattice lattice;
};

/// Things of kitchen and table, and vessels.
std::vector<MadeShape> made_household();
/// Tools, handles, and what else is carried or moved by hand.
std::vector<MadeShape> made_tools();
/// Things with rings, triggers and two handles, and things that are moved where they stand.
std::vector<MadeShape> made_moved();

/// All of them.
const std::vector<MadeShape>& made_shapes();
/// By name. Throws UsageError for an unknown one.
const MadeShape& made_shape(const std::string& name);

}  // namespace palmar::tests
