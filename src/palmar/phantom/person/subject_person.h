// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>

#include "palmar/capture/mri/scan_posture.h"
#include "palmar/hand/hand.h"
#include "palmar/phantom/mri/held_bar.h"
#include "palmar/phantom/person/subject_joints.h"

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

/// How far persons differ from the hand that they start from, beside its size: deviations.
struct PersonDispersion {
  double palm = 0.015;    ///< of the palm's length, share
  double phalanx = 0.03;  ///< of each phalanx' length, share
  double width = 0.0;     ///< of each finger's width and thickness, share
  double axis = 0.02;     ///< of a flexion axis in each of three directions, rad
  double along = 0.015;   ///< of its slant towards the phalanx, rad
  double centre = 0.5;    ///< of a joint along the finger, mm; dorsal half of it
};
/// As free as people's, and not tuned on: palms up to 10 mm off in length, phalanges and widths by
/// 6 and 5 %, flexion axes 6 degrees off in the mean (published dispersions: 5 to 8), joints by 1
/// mm, held to 2.5.
inline constexpr PersonDispersion kFreePerson{
    .palm = 0.04, .phalanx = 0.06, .width = 0.05, .axis = 0.085, .along = 0.05, .centre = 1.0};

/// `base`: a right hand. Hand length and circumference follow the survey of ANSUR II (Gordon et al.
/// 2014), women and men alike often, hand length held to what a field of view of 200 mm shows (165
/// to 194 mm); the palm's share and every finger vary by themselves.
SubjectPerson make_person(const Hand& base, std::uint64_t seed,
                          const PersonDispersion& dispersion = {});

}  // namespace palmar
