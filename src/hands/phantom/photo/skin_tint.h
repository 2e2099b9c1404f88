// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "hands/phantom/person/smooth_noise.h"
#include "hands/phantom/person/subject_person.h"
#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/hand/skin/creases.h"

namespace palmar::phantom {

/// Colours of bare skin on a hand: redder where blood shows through (fingertips, knuckles, the heel
/// of the palm, blotches of 12 and 30 mm), with nails on the backs of the last phalanges. How
/// much redder follows from the seed. Blood takes green and blue and leaves red. Amounts and
/// colours are our choice.
class SkinTint {
 public:
  /// `creases` of the reference posture.
  SkinTint(const SubjectPerson& person, const hand::HandCreases& creases, std::uint64_t seed);
  /// Colour at a point of the skin in the reference posture, of which `even` is the skin's without
  /// blood; `segment` is the point's.
  geometry::Srgb at(const Vec3& p, hand::Segment segment, const geometry::Srgb& even) const;

 private:
  struct Tip {
    Vec3 joint, along, palmar;        ///< of the last phalanx
    double length = 0.0, half = 0.0;  ///< to the tip, half the finger's width, mm
    Vec3 knuckle;                     ///< of the joint before
  };
  /// Share of the nail, 0 to 1, and of its white edge.
  std::array<double, 2> nail(const Tip& tip, const Vec3& p) const;

  const hand::HandCreases* creases_;
  std::array<Tip, hand::kFingerCount> tip_;
  Vec3 thenar_, hypothenar_;
  SmoothNoise blotch_, cloud_;
  double redness_ = 1.0;
};

}  // namespace palmar::phantom
