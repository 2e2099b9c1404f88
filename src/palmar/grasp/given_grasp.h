// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/grasp/grasp.h"

namespace palmar::grasp {

/// A way of holding that was measured or thought up rather than closed: posture and placement are
/// taken as they are (angles outside the range of motion too). Says per segment how deep its
/// palmar skin lies in the product and, by the fingers that do, whether it is held; grip, grip
/// point and axis are left to the caller. Throws InputError if a number isn't finite.
Grasp given_grasp(const hand::Hand& hand, const product::Product& product,
                  const hand::Posture& posture, const geometry::Rigid3& product_from_hand);

}  // namespace palmar::grasp
