// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hands/phantom/mri/tissue_image.h"
#include "hands/phantom/person/subject_person.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::phantom {

/// What one scan of a synthetic subject would show if it were without error. Patient frame, mm.
struct SubjectPosture {
  geometry::TriangleMesh skin;  ///< vertex for vertex that of the reference posture
  std::map<std::string, geometry::Rigid3> bone;  ///< patient_from_reference of each bone's mesh
  std::vector<Vec3> markers;                     ///< centres; empty where none were stuck on
  std::vector<ImagedPart> parts;                 ///< for image_of()
  geometry::TriangleMesh product;  ///< what the hand holds in kGrasp, else empty; gives no signal
};

/// A person that doesn't exist. Moves by a model of its own, not by Hand's: see
/// docs/method/phantom.md.
struct MriSubject {
  std::string name;
  hand::Side side = hand::Side::kRight;
  std::vector<hand::Bone> bones;    ///< true shapes, reference posture, patient frame
  hand::HandDimensions dimensions;  ///< true ones
  /// True axes of the hinge joints at the reference posture and of both CMC axes; patient frame.
  struct TrueAxis {
    std::string joint;
    Vec3 axis, point;
  };
  std::vector<TrueAxis> axes;
  std::map<hand::ScanPosture, std::array<double, hand::kDofCount>> angles;  ///< true, rad
  std::map<hand::ScanPosture, SubjectPosture> postures;
};

struct MriSubjectOptions {
  std::uint64_t seed = 1;         ///< of the person: size, proportions, axes, bone shapes
  PersonDispersion dispersion{};  ///< how far the person differs from the base
  hand::Side side = hand::Side::kRight;
  bool has_fixture = true;  ///< paper clay below the wrist
  int markers = 12;         ///< 5 mm capsules round the thumb ball
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// `base`: whose skin's outline the person starts from.
MriSubject make_mri_subject(const hand::Hand& base, const MriSubjectOptions& options = {});

}  // namespace palmar::phantom
