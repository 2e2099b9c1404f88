// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/template_hand.h"

#include <cmath>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh_topology.h"
#include "palmar/geometry/subdivide.h"
#include "palmar/geometry/weld.h"
#include "palmar/hand/hand_frame.h"
#include "palmar/hand/joint_weights.h"
#include "palmar/hand/template_skeleton.h"

namespace palmar {

void TemplateOptions::check() const {
  if (!(edge_length >= 1.0 && edge_length <= 10.0)) {
    throw UsageError("template hand: edge length is " + std::to_string(edge_length) +
                     " mm; 1 to 10 mm is allowed");
  }
}

Hand build_template(const HandAsset& asset, const TemplateOptions& options) {
  options.check();
  HandAsset placed = in_hand_frame(asset);
  placed.skin = weld(placed.skin, {.tolerance = 1e-3}).mesh;
  require_closed_manifold(placed.skin, "hand asset: skin");

  Hand hand;
  hand.name = "template";
  hand.side = Side::kRight;
  hand.skin = subdivide(placed.skin);
  hand.skeleton = build_skeleton(placed);
  hand.weights = make_joint_weights(hand.skin, hand.skeleton);
  hand.tissue = default_tissue();
  hand.provenance = asset.provenance;
  return hand;
}

}  // namespace palmar
