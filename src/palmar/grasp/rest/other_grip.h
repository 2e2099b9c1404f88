// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/grasp/rest/balance.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// Another grip that holds a product which the precision grip asked for doesn't: precision grips
/// with nearly as many fingers first, power grips last, each closed and brought to rest under the
/// same load and grip force. The first that is held and in balance; nothing if none is. Given
/// fingertip points are left out, other hints about the place stay. Throws UsageError, Cancelled.
std::optional<Grip> other_grip_that_holds(const contact::PreparedHand& hand,
                                          const product::Product& product,
                                          const GraspOptions& asked,
                                          const BalanceOptions& balance = {},
                                          const contact::ContactOptions& contact = {},
                                          const Progress& progress = {});

}  // namespace palmar::grasp
