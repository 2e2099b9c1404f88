// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/hand/tendons/digit_tendons.h"

namespace palmar {

/// What the muscles that close the fingers in a power grip can do, in any posture: the deep and
/// superficial flexors, both at one activation. In a power grip they give most of the force (Long
/// et al. 1970, J Bone Joint Surg 52-A:853-867). The interossei, which also work in a squeeze, are
/// left out: with them at the same activation, DIP is so weak that the share of the distal
/// phalanges falls with the diameter of a cylinder where people's rises. So that case (validation,
/// G5) is no independent check of this choice.
///
/// Force of a muscle at full activation: cross-section x specific tension (tendon.h) x active
/// force-length factor exp(-(l - 1)^2 / 0.45) (Thelen 2003), l the fibre length over its best one.
/// Best fibre lengths of the flexors: the model of Lee et al. 2015 (PLoS ONE 10:e0121712). They are
/// taken to be best in the position of function (MCP 45, PIP 45, DIP 25 degrees; our choice), from
/// which fibres lengthen and shorten as the tendon's path does.
class GripMuscles {
 public:
  explicit GripMuscles(const Hand& hand);

  /// Flexion moments of one finger's muscles at full activation about MCP, PIP and DIP, N mm.
  std::array<double, 3> flexion_moments(Finger finger, const Posture& posture) const;

 private:
  struct Muscle {
    TendonPath path;
    double force = 0.0;        ///< at full activation and best length, N
    double best_length = 0.0;  ///< of its fibres, mm
    double best_path = 0.0;    ///< path_length() there, mm
  };
  const Hand* hand_;
  std::array<std::vector<Muscle>, kFingerCount> muscles_;
};

}  // namespace palmar
