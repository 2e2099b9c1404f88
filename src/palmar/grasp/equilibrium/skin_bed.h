// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/geometry/distance/distance_field.h"
#include "palmar/grasp/equilibrium/coordinates.h"
#include "palmar/hand/hand.h"

namespace palmar::grasp {

/// Skin as a bed of springs that know nothing of each other: what a search for a grasp's rest takes
/// for the tissue on its way, before the tissue's own contact decides. At a depth d [mm] the skin
/// of a region presses with
///
///     (a d + b d^2) (1 + (d / h)^4) MPa
///
/// a, b and h rounded after the tissue's own contact of the template hand on cylinders of 22 to 60
/// mm (those of the back of the hand are a guess: so stiff that it stays out). They don't enter the
/// problem, but where it has more than one minimum they can decide which is found.
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
  /// Loaded skin, ascending by vertex; `skin`: the whole of it, product frame, mm.
  const std::vector<Load>& look(const std::vector<Vec3>& skin);
  /// Of the skin last looked at, per vertex.
  const std::vector<geometry::DistanceSample>& samples() const { return sample_; }

 private:
  const hand::Hand* hand_;
  const geometry::DistanceField* product_;
  std::vector<double> area_;                      ///< per vertex, mm^2
  std::vector<geometry::DistanceSample> sample_;  ///< of the last call
  std::vector<Load> load_;
};

}  // namespace palmar::grasp
