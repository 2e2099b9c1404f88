// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "hands/phantom/mri/tissue_image.h"
#include "hands/phantom/person/soft_tissue.h"
#include "hands/phantom/person/subject_bones.h"

namespace palmar::phantom {

inline constexpr double kMarkerRadius = 2.5;  ///< mm; capsules of 5 mm (Xie 2014, table 2-1)

/// A subject in one posture; hand frame.
struct PosedSubject {
  const SubjectPerson* person = nullptr;
  const std::vector<SubjectBone>* bones = nullptr;
  const SoftTissue* tissue = nullptr;
  PosedTissue posed;
  std::array<geometry::Rigid3, kBodyCount> motion;
  std::vector<Vec3> markers;
};

/// What T1-weighted images show of a subject, in the order in which image_of() draws it: paper clay
/// (if there is any), skin, fat below it, muscle in palm and forearm, fat about the tendons in the
/// palm, cartilage and capsules of the joints, tendons, cortical bone, marrow, markers.
std::vector<ImagedPart> tissue_parts(const PosedSubject& subject, bool has_fixture);

/// Vertices that markers sit on: spread evenly round the thumb ball.
std::vector<int> marker_vertices(const SubjectPerson& person, const SoftTissue& tissue, int count);

/// A block of paper clay that wrist and forearm were pressed into: it touches the skin in places
/// and stands off by up to 3 mm in others. Hand frame, closed.
geometry::TriangleMesh fixture_mesh(const geometry::TriangleMesh& skin, const Vec3& wrist);

}  // namespace palmar::phantom
