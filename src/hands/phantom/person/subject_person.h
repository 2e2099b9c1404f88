// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "hands/phantom/person/held_bar.h"
#include "hands/phantom/person/person_dispersion.h"
#include "hands/phantom/person/subject_joints.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::phantom {

/// Size, outline and joints of a person, drawn from a seed; a right hand in the hand frame.
struct SubjectPerson {
  geometry::TriangleMesh skin;  ///< relaxed: the posture of the reference scan
  hand::Skeleton skeleton;      ///< in the same posture: joints where the bones turn
  hand::Posture reference;      ///< its angles
  SubjectJoints joints;
  std::array<double, hand::kFingerCount> finger_width{};  ///< at the interphalangeal joint, mm
  std::map<hand::ScanPosture, hand::Posture> postures;    ///< what the person does in each scan
  HeldBar bar;                                            ///< that fingers are closed on in kGrasp
};

/// `base`: a right hand. Size and proportions: sized_hand(). An outline of one's own by bumps and
/// hollows, joints that aren't quite those of the base, postures of eight scans.
SubjectPerson make_person(const hand::Hand& base, std::uint64_t seed,
                          const PersonDispersion& dispersion = {});

}  // namespace palmar::phantom
