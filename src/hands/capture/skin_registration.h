// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "hands/capture/nonrigid_fit.h"
#include "hands/capture/posed_model.h"
#include "palmar/core/progress.h"
#include "palmar/hand/hand.h"

namespace palmar::capture {

/// Skin of one scan, from whatever device.
struct SkinScan {
  geometry::TriangleMesh skin;  ///< oriented outwards, mm; may be open
  std::vector<Vec3> markers;    ///< centres of spots on the skin, whose bumps are no skin; mm
  double marker_radius = 2.5;
};

/// A model's skin placed on a scanned one.
struct RegisteredSkin {
  std::vector<Vec3> skin;                  ///< vertex for vertex the model's; frame of the scan, mm
  std::vector<char> has_partner;           ///< per vertex: scanned skin lies there
  PosedModel start;                        ///< what it was bent from
  double mean = 0.0, percentile_95 = 0.0;  ///< distance to the scan where there are partners, mm
  double partner_share = 0.0;              ///< of the area, forearm left out
  double left_over = 0.0;  ///< share of the scanned skin that lies more than 2 mm from this one
};

/// Places the skin of `model` on a scan. `skeleton`: the person's joints in the scan's frame, which
/// must be a hand frame; the model is sized and posed by them (posed_model.h), then bent onto the
/// scan (nonrigid_fit.h). Fingers only find partners on the same finger; skin that isn't in the
/// scan (touching fingers, the cut forearm, spots) follows its surroundings. At the end no triangle
/// crosses another. Throws InputError if the scan isn't near the joints.
RegisteredSkin register_skin(const hand::Hand& model, const SkinScan& scan,
                             const hand::Skeleton& skeleton, const Progress& progress = {});

/// Bends the posed skin of a hand onto a scan of the same person in that posture (hand frame).
/// Where on the scan a point of the skin went: skinning and what it misses. `pins`: markers.
std::vector<Vec3> bend_posed_skin(const hand::Hand& hand, const hand::Posture& posture,
                                  const SkinScan& scan, const std::vector<FitPin>& pins = {},
                                  const Progress& progress = {});

/// Distance to the scan of each point of a surface, where scanned skin lies that faces the same way
/// and is neither a spot nor a cut; -1 elsewhere. `normal`: per point; `reach` in mm.
std::vector<double> distances_to_scan(const std::vector<Vec3>& point,
                                      const std::vector<Vec3>& normal, const SkinScan& scan,
                                      const hand::Skeleton& skeleton, double reach);

/// Most distal skin point of a finger: as far from its last joint as the farthest vertex, in the
/// middle of those nearly as far. `segment`: of the vertices.
Vec3 fingertip_of(const std::vector<Vec3>& skin, const std::vector<hand::Segment>& segment,
                  const hand::Skeleton& skeleton, hand::Finger finger);

}  // namespace palmar::capture
