// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// How a hand of another size comes from a hand, in the reference posture: where points of its
/// parts go [mm], and how short vectors there stretch (3 x 3, hand frame). Callers choose among
/// ways of scaling: uniform, or segment by segment.
class HandMap {
 public:
  virtual ~HandMap() = default;
  virtual std::vector<Vec3> skin() const = 0;
  virtual Eigen::Matrix3d skin_stretch(int vertex) const = 0;
  virtual std::vector<Vec3> bone(int index) const = 0;  ///< vertices of hand.bones[index]
  virtual Vec3 joint(JointId id) const = 0;             ///< its centre
  virtual Vec3 fingertip(Finger finger) const = 0;
  virtual Vec3 in_palm(const Vec3& point) const = 0;  ///< a point of the palm or the thumb ball
  virtual Eigen::Matrix3d palm_stretch(const Vec3& point) const = 0;
};

/// The joints alone. Axes keep their directions, angles and ranges stay; where axes of one joint
/// don't meet, their offsets stretch with the palm, and so do the limit postures of the thumb:
/// t = (I - q) a + b, a perpendicular to the axis of q and b along it, becomes (I - q) S a + S b,
/// so that the metacarpal still turns about an axis at the joint.
Skeleton mapped_skeleton(const Skeleton& skeleton, const HandMap& map);

/// The hand with every point moved: skin, joints, limit postures of the thumb, bones, markers and
/// coefficients of the thumb ball, bulges over bent joints. Triangles, segments, regions, skinning
/// weights, tissue, dimensions and provenance stay as they are.
Hand mapped(const Hand& hand, const HandMap& map);

}  // namespace palmar::hand
