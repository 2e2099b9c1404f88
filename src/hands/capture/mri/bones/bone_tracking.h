// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/capture/mri/bones/image_registration.h"
#include "hands/capture/mri/scan_surfaces.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/registration/icp.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::capture {

/// A bone of the reference scan found again in the scan of another posture.
struct BoneMotion {
  std::string bone;
  std::string counterpart;  ///< its name in the other scan: another one if labels disagree
  geometry::Rigid3 posture_from_reference;       ///< patient frame of one scan to that of the other
  geometry::IcpResult fit;                       ///< surface to surface; 0 without is_cut_out
  std::optional<ImageFit> image = std::nullopt;  ///< what the motion is from, if images show it
  bool is_cut_out = true;                        ///< the other scan has a surface for it
};

/// Images of two scans, where there are any.
struct TrackedImages {
  const BoneImages* reference = nullptr;  ///< of the reference's bones
  const ImageLevels* posture = nullptr;   ///< the other scan
};

/// Finds every bone of `reference` in `posture` by registration along the chain from the carpus
/// out: each bone starts where its proximal neighbour's motion and the bone of the same name put
/// it. A bone that doesn't fit the one of its name is tried on others near where it must be
/// (counterpart). With `images` the motions are those that align the reference's intensities on the
/// other scan's (image_registration.h), and what has no surface there is searched for in the image
/// by turning it about its joint. Bones that aren't found are left out.
std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const TrackedImages& images, const Progress& progress = {});
std::vector<BoneMotion> track_bones(const ScanSurfaces& reference, const ScanSurfaces& posture,
                                    const Progress& progress = {});

}  // namespace palmar::capture
