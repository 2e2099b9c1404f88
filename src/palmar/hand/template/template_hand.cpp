// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/hand/template/template_hand.h"

#include <cmath>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "palmar/geometry/remesh/remesh.h"
#include "palmar/geometry/remesh/subdivide.h"
#include "palmar/geometry/repair/weld.h"
#include "palmar/hand/bones/bones.h"
#include "palmar/hand/dimensions/dimensions.h"
#include "palmar/hand/skin/forearm_cut.h"
#include "palmar/hand/skin/joint_weights.h"
#include "palmar/hand/skin/regions.h"
#include "palmar/hand/template/hand_frame.h"
#include "palmar/hand/template/template_skeleton.h"

namespace palmar::hand {

void TemplateOptions::check() const {
  if (!(edge_length >= 1.0 && edge_length <= 10.0)) {
    throw UsageError("template hand: edge length is " + std::to_string(edge_length) +
                     " mm; 1 to 10 mm is allowed");
  }
}

Hand build_template(const HandAsset& asset, const TemplateOptions& options) {
  options.check();
  HandAsset placed = in_hand_frame(asset);
  placed.skin = geometry::weld(placed.skin, {.tolerance = 1e-3}).mesh;
  geometry::require_closed_manifold(placed.skin, "hand asset: skin");

  Hand hand;
  hand.name = "template";
  hand.side = Side::kRight;
  hand.skeleton = build_skeleton(placed);
  // The asset's edges of 6.7 mm become 1.7 mm, finer than the mesh that is placed over them.
  const geometry::TriangleMesh smooth =
      geometry::subdivide(with_even_cut(placed.skin), {.levels = 2});
  const geometry::TriangleMesh even =
      geometry::remesh(smooth, {.edge_length = options.edge_length}).mesh;
  SkinPartition partition = partition_skin(even, hand.skeleton);
  hand.skin = std::move(partition.skin);
  hand.segment = std::move(partition.segment);
  hand.region = std::move(partition.region);
  hand.weights = make_joint_weights(hand.skin, hand.skeleton);
  hand.bones = make_bones(hand.skin, hand.skeleton);
  hand.dimensions = measure_hand(hand);
  hand.tissue = default_tissue();
  hand.provenance = asset.provenance;
  return hand;
}

}  // namespace palmar::hand
