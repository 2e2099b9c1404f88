// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// What a facet of a tissue block is.
enum class BlockFace : std::uint8_t {
  kSkin = 1,    ///< skin of other regions
  kRegion = 2,  ///< skin of the region that is pressed
  kBone = 3,    ///< where tissue is held by bone
  kCut = 4      ///< where the rest of the hand was cut off
};

/// Planar facet with holes.
struct BlockFacet {
  BlockFace face = BlockFace::kSkin;
  std::vector<std::vector<int>> loop;  ///< corners of the outline and of the holes
  std::vector<Vec3> hole;              ///< a point in each hole, mm
};

/// The boundary of a piece of soft tissue between skin and bone: closed, as planar facets (skin and
/// bones as triangles, the cut face as one polygon with holes). Hand frame, reference posture, mm.
struct TissueBlock {
  std::vector<Vec3> vertices;
  std::vector<BlockFacet> facets;
  std::vector<Vec3> hole;  ///< a point inside each bone: no tissue there
  std::vector<std::string> bone;
  Vec3 cut_point = Vec3::Zero(), cut_normal = Vec3::Zero();  ///< tissue is on the normal's side
};

struct TissueBlockOptions {
  Region region = Region::kMiddleDistal;
  /// Where the rest is cut off, mm from the region's proximal joint along the segment (of the palm:
  /// from the region's middle, along -y), proximal negative. A phalanx' default is the middle of
  /// the phalanx before it: far from the contact.
  std::optional<double> cut_offset;
  std::optional<Vec3> cut_normal;  ///< unit; default: along the segment, distal; palm: y
  void check() const;
};

/// Throws UsageError if the hand has no bones, no skin in the region, or the plane cuts it badly.
TissueBlock make_tissue_block(const Hand& hand, const TissueBlockOptions& options);

}  // namespace palmar::hand
