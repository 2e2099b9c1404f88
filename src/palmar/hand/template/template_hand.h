// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// What the template is built from: a skin and 25 joint frames as in the WebXR generic hand
/// (npm package @webxr-input-profiles/assets, MIT): wrist; thumb metacarpal, proximal, distal, tip;
/// metacarpal, proximal, intermediate, distal, tip of each finger. In each frame -z runs along the
/// bone, x is the flexion axis, y is dorsal. Metres in the asset; mm here.
struct HandAsset {
  struct Frame {
    std::string name;  ///< as in the asset, e.g. "index-finger-phalanx-proximal"
    geometry::Rigid3 asset_from_joint;
  };
  geometry::TriangleMesh skin;  ///< mm, as in the asset (not yet welded)
  std::vector<Frame> frames;
  std::string provenance;
};

struct TemplateOptions {
  double edge_length = 2.3;  ///< mean edge of the skin mesh, mm: about 9 000 vertices
  void check() const;        ///< throws UsageError outside [1, 10] mm
};

/// Turns the asset into Palmar's template hand: weld, subdivide smoothly, remesh, hand frame,
/// skeleton with ranges of motion, segments, regions, weights, bones, dimensions, tissue.
/// Deterministic. Throws InputError if the asset lacks a frame or its skin is not closed.
Hand build_template(const HandAsset& asset, const TemplateOptions& options = {});

}  // namespace palmar::hand
