// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "hands/phantom/person/subject_person.h"
#include "palmar/hand/hand.h"

namespace palmar::phantom {

struct SpreadOptions {
  PersonDispersion dispersion{};  ///< how far the person differs from the base
  std::uint64_t seed = 1;         ///< of the person and of how the fingers lie
  double together = 0.0;          ///< 0: fingers spread as given; 1: side by side
  void check() const;             ///< throws UsageError: field, value, allowed range
};

/// A hand with straight fingers, spread, to be placed on a sheet. Hand frame: x radial of a right
/// hand, y distal, z palmar; mm.
struct SpreadHand {
  hand::Side side = hand::Side::kRight;
  geometry::TriangleMesh skin;
  Vec3 wrist = Vec3::Zero();        ///< middle of the wrist crease
  std::array<Vec3, 4> fingertips;   ///< index to little
  hand::HandDimensions dimensions;  ///< the truth
};

/// A hand of Palmar's, posed by Palmar's own skinning; its dimensions are those it carries.
SpreadHand spread_hand(const hand::Hand& hand, const SpreadOptions& options = {});

/// A person that isn't one of Palmar's hands (make_person(): proportions, outline, joints and skin
/// of its own), posed by the model of soft tissue. Its dimensions are measured with the fingers
/// straight and not spread, as surveys measure, the thumb at rest, from creases of its own. `base`:
/// whose skin's outline it starts from.
SpreadHand spread_person(const hand::Hand& base, hand::Side side,
                         const SpreadOptions& options = {});

}  // namespace palmar::phantom
