// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/product/parts/product_parts.h"

namespace palmar::grasp {

/// The other handle of a tool with two (pliers, tongs, shears without rings), which one hand takes
/// together: both are bars with a free end whose other ends join each other or the same part, about
/// as long (1.5 times at most), their middles 10 to 100 mm apart and within 35 degrees of the same
/// direction. Null if there is none, or where something is a trigger. The limits are our choice;
/// NIOSH 2004 (A Guide to Selecting Non-Powered Hand Tools) has spans of 50 to 90 mm.
const product::ProductPart* twin_of(const product::ProductPart& part,
                                    const product::ProductParts& parts);

}  // namespace palmar::grasp
