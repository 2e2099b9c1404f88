// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "palmar/hand/person/scan_posture.h"
#include "palmar/hand/hand.h"
#include "hands/phantom/mri/held_bar.h"
#include "hands/phantom/person/person_dispersion.h"
#include "hands/phantom/person/subject_joints.h"

namespace palmar {

/// Size, outline and joints of a person, drawn from a seed; a right hand in the hand frame.
struct SubjectPerson {
  TriangleMesh skin;  ///< relaxed: the posture of the reference scan
  Skeleton skeleton;  ///< in the same posture: joints where the bones turn
  Posture reference;  ///< its angles
  SubjectJoints joints;
  std::array<double, kFingerCount> finger_width{};  ///< at the interphalangeal joint, mm
  std::map<ScanPosture, Posture> postures;          ///< what the person does in each scan
  HeldBar bar;                                      ///< that fingers are closed on in kGrasp
};

/// `base`: a right hand. Size and proportions: sized_hand(). An outline of one's own by bumps and
/// hollows, joints that aren't quite those of the base, postures of eight scans.
SubjectPerson make_person(const Hand& base, std::uint64_t seed,
                          const PersonDispersion& dispersion = {});

}  // namespace palmar
