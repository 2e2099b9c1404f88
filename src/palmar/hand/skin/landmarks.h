// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/distance/ray_query.h"
#include "palmar/hand/skin/hand_points.h"

namespace palmar::hand {

/// Named points of a hand, found from its own skin, joints and bones, so that they fit any hand.
///
/// - FINGER_JOINT_SIDE: skin where a line from the joint's centre leaves it; joint mcp, pip, dip
///   (thumb: cmc, mp, ip), side dorsal, palmar, radial or ulnar (thumb: dorsal, palmar) where the
///   finger has that side. With "centre": the joint's centre itself, on the bone proximal of it.
/// - FINGER_SEGMENT_SIDE: the same from the middle of a phalanx: proximal, middle, distal.
/// - FINGER_nail: dorsal skin at 0.6 of the way from the last joint to the fingertip.
/// - FINGER_tip: the fingertip.
/// - FINGER_metacarpal_head, _middle, _base: dorsal skin over the metacarpal (first ... fifth).
///   _head is FINGER_mcp_dorsal by another name.
/// - radial_styloid, ulnar_styloid: the forearm's skin beside the wrist joint, 0.09 of the way to
/// the
///   third MCP joint (8 mm) proximal of its centre; they go with the forearm.
///
/// Dorsal is the direction from which flexion turns away: -(u x d), u the flexion axis, d from the
/// joint to the next one.
class Landmarks {
 public:
  /// Keeps a pointer to `hand`.
  explicit Landmarks(const Hand& hand);

  /// Throws UsageError for an unknown name, with the nearest one; InputError if the hand has no
  /// such point (a metacarpal without a bone, a ray that misses the skin).
  HandPoint at(const std::string& name) const;

  /// The same, `height` [mm] above the skin: where the centre of a marker is that sits there.
  HandPoint at(const std::string& name, double height) const;

  static std::vector<std::string> names();

 private:
  HandPoint on_skin(const std::string& name, const Vec3& from, const Vec3& direction) const;

  const Hand* hand_;
  geometry::RayQuery rays_;
};

}  // namespace palmar::hand
