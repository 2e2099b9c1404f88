// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/grasp/hold_product.h"

#include "palmar/core/error.h"
#include "palmar/grasp/grasp_place.h"
#include "palmar/hand/template_hand.h"
#include "palmar/workflow/hand/load_hand.h"

namespace palmar {
namespace {

/// Nothing where Palmar was installed without it: a program that brings hands of its own.
std::shared_ptr<const Hand> built_in_hand() {
  try {
    return load_hand("template");
  } catch (const InputError&) {
    return nullptr;
  }
}

}  // namespace

Grasp hold_product(const std::shared_ptr<const Hand>& hand, const Product& product,
                   const GraspSettings& settings, const GraspOptions& options,
                   const Progress& progress) {
  if (settings.is_place_per_hand || settings.placement.product_from_hand) {
    return find_grasp(*hand, product, options, progress);
  }
  const std::shared_ptr<const Hand> built_in = built_in_hand();
  if (built_in == nullptr || hand->skin.vertices == built_in->skin.vertices) {
    return find_grasp(*hand, product, options, progress);
  }
  const bool is_left = hand->side == Side::kLeft;
  const Hand mirror = is_left ? mirrored(*built_in) : Hand{};
  const GraspPlace place(is_left ? mirror : *built_in, product, options, progress);
  return place.hold(GraspingHand(hand), progress);
}

}  // namespace palmar
