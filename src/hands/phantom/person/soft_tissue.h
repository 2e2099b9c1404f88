// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "hands/phantom/person/subject_bones.h"
#include "hands/phantom/person/subject_person.h"
#include "palmar/geometry/distance/mesh_distance.h"

namespace palmar::phantom {

inline constexpr double kLeastPosedCover = 1.5;  ///< of skin over bone in any posture, mm

/// Skin of a subject in a posture; hand frame.
struct PosedTissue {
  std::vector<Vec3> skin;
  std::vector<Vec3> core;  ///< per vertex: the point of the nearest bone's axis below it
};

/// How a subject's skin follows the bones. In this order:
/// 1. Shares of every rigid part in every vertex by diffusion on the skin: (L + M / d^2) w = M /
/// d^2
///    p, L the cotangent Laplacian, M the vertices' areas, d the distance to the nearest part, p 1
///    for that part (bone heat, Baran, Popovic 2007, section 4.1).
/// 2. Dual quaternions blended by these shares (Kavan et al. 2008).
/// 3. Swelling of the thumb ball with flexion and abduction of the CMC joint.
/// 4. Volume: offsets along the normals, so that every band of the palm and of the fingers (10 mm
///    along the bones) keeps the volume between skin and bones that it has at the reference.
/// 5. Skin that came nearer to a bone than kLeastPosedCover is lifted.
class SoftTissue {
 public:
  /// Keeps pointers to both.
  SoftTissue(const SubjectPerson& person, const std::vector<SubjectBone>& bones);
  ~SoftTissue();

  /// The skin in a posture, hand frame (palm still), vertex for vertex.
  PosedTissue pose(const hand::Posture& posture) const;

  /// Share of the phalanges in a vertex: 0 on the palm, 1 on a finger.
  double finger_share(int vertex) const;
  /// Middle of the thumb ball's skin at the reference.
  int thumb_ball_vertex() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::phantom
