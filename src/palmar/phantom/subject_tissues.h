// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/phantom/soft_tissue.h"
#include "palmar/phantom/subject_bones.h"
#include "palmar/phantom/tissue_image.h"

namespace palmar {

inline constexpr double kMarkerRadius = 2.5;  ///< mm; capsules of 5 mm (Xie 2014, table 2-1)

/// What T1-weighted images show of a subject in one posture, in the order in which image_of() draws
/// it. Hand frame.
struct TissueOptions {
  bool has_fixture = true;
};
std::vector<ImagedPart> tissue_parts(const SubjectPerson& person,
                                     const std::vector<SubjectBone>& bones,
                                     const SoftTissue& tissue, const std::vector<Vec3>& skin,
                                     const std::array<Rigid3, kBodyCount>& motion,
                                     const std::vector<Vec3>& markers,
                                     const TissueOptions& options);

/// Vertices that markers sit on: spread evenly round the thumb ball.
std::vector<int> marker_vertices(const SubjectPerson& person, const SoftTissue& tissue, int count);

}  // namespace palmar
