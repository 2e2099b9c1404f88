// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "palmar/geometry/mesh_distance.h"
#include "palmar/phantom/subject_bones.h"
#include "palmar/phantom/subject_person.h"

namespace palmar {

inline constexpr double kLeastPosedCover = 1.5;  ///< of skin over bone in any posture, mm

/// How a subject's skin follows the bones. In this order:
/// 1. Shares of every rigid part in every vertex by diffusion on the skin: (L + M / d^2) w = M /
/// d^2
///    p, L the cotangent Laplacian, M the vertices' areas, d the distance to the nearest part, p 1
///    for that part (bone heat, Baran, Popovic 2007, section 4.1).
/// 2. Dual quaternions blended by these shares (Kavan et al. 2008).
/// 3. Swelling of the thumb ball with flexion and abduction of the CMC joint.
/// 4. Volume: offsets along the normals, so that every band of the palm and of the fingers (7 mm
///    along the bones) keeps the volume between skin and bones that it has at the reference.
/// 5. Skin that came nearer to a bone than kLeastPosedCover is lifted.
class SoftTissue {
 public:
  /// Keeps pointers to both.
  SoftTissue(const SubjectPerson& person, const std::vector<SubjectBone>& bones);
  ~SoftTissue();

  /// The skin in a posture, hand frame (palm still), vertex for vertex.
  std::vector<Vec3> pose(const Posture& posture) const;

  /// Nearest rigid part of a vertex and the point of its axis next to the vertex, reference.
  int nearest_body(int vertex) const;
  const Vec3& core(int vertex) const;
  /// Middle of the thumb ball's skin at the reference.
  int thumb_ball_vertex() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar
