// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/phantom/person/skin_cover.h"
#include "hands/phantom/person/subject_person.h"

namespace palmar::phantom {

inline constexpr double kLeastBoneGap = 1.0;  ///< between two bones in every posture, mm

/// A bone with its marrow; hand frame, reference posture.
struct SubjectBone {
  hand::Bone bone;
  int body = 0;  ///< that it moves with, see subject_joints.h
  geometry::TriangleMesh marrow;
};

/// 29 bones of a person, named and ordered as Hand::bones has them. Heads are surfaces of
/// revolution about the joints' axes and bases fit on them, carpals fill the room between the
/// forearm and the metacarpals up to each other. Where bones come nearer to each other than
/// kLeastBoneGap in any posture, or to the skin than kLeastSkinCover, the later one is made
/// smaller.
std::vector<SubjectBone> make_subject_bones(const SubjectPerson& person, std::uint64_t seed);

}  // namespace palmar::phantom
