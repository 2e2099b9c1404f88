// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "palmar/hand/hand.h"
#include "palmar/report/picture/render.h"

namespace palmar::report {

/// A hand holding a product, in the product's frame, mm.
struct HeldScene {
  const hand::Hand* hand = nullptr;
  std::vector<Vec3> skin;  ///< the posed skin
  const geometry::TriangleMesh* product = nullptr;
  std::vector<char> is_held_part;  ///< per triangle of the product; empty: unknown
};

/// Where to look from so that one sees at a glance how a hand holds a product: of directions all
/// round and a little from above, the one that shows most of the fingers' and the thumb's palmar
/// skin, of the part that is held and of the product; each counts by its share of what the best
/// direction shows of it. `up` is upwards in the picture.
Vec3 best_view_of_hold(const HeldScene& scene, const Vec3& up);

/// What is near the hand and the hand itself, so that a hold of something large isn't lost in it:
/// the product's vertices within `reach` of the hand's middle.
Camera camera_of_hold(const HeldScene& scene, const Vec3& up, double aspect);

}  // namespace palmar::report
