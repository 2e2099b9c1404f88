// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// Palmar skin as a bed of springs that know nothing of each other: what a search for a grasp's
/// rest takes for the tissue on its way, before the tissue's own contact decides. At a depth d [mm]
/// the skin presses with
///
///     0.010 d + 0.010 d^2 MPa on phalanges,   0.0065 d MPa in the palm,
///
/// rounded means of the tissue's own contact per region of the template hand on cylinders of 44 and
/// 60 mm. What is found in the end doesn't depend on it.
class SkinBed {
 public:
  /// Keeps references.
  SkinBed(const hand::Hand& hand, const geometry::DistanceField& product);

  struct Load {
    int vertex = 0;
    double depth = 0.0;           ///< mm
    double force = 0.0;           ///< N
    double stiffness = 0.0;       ///< N/mm
    Vec3 normal = Vec3::UnitZ();  ///< of the product, product frame
  };
  /// Loaded skin, ascending; `posed`: the whole skin, product frame, mm.
  const std::vector<Load>& look(const std::vector<Vec3>& posed);

 private:
  const hand::Hand* hand_;
  const geometry::DistanceField* product_;
  std::vector<int> vertex_;  ///< palmar skin
  std::vector<double> area_;
  std::vector<geometry::DistanceSample> sample_;  ///< of the last call
  std::vector<Vec3> point_;
  std::vector<Load> load_;
};

}  // namespace palmar::grasp
