// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "palmar/grasp/grasp.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

/// What a hand does with a product where nothing is said about it.
enum class UsualTask {
  kGrip,  ///< grips it firmly, to work with it: a handle that the hand closes on, a pen, scissors
  kHold   ///< holds its weight: what thumb and fingers don't meet round (a body, a vessel, a
          ///< phone), and what is between fingertips
};

/// Of a product as it is taken; nothing where the grip itself says how firmly: hooked fingers, a
/// hand that rests, a push. A wrap is a firm one if the section at the grip is nowhere wider than
/// what thumb and fingers meet round (kLargestClosed).
std::optional<UsualTask> usual_task(const product::Product& product, const Grasp& grasp,
                                    double hand_length);

/// The same for products that are compared: kHold if that is the task of every one that has any,
/// so that all are held alike.
UsualTask task_of_all(std::span<const std::optional<UsualTask>> tasks);

}  // namespace palmar::grasp
