// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "palmar/hand/dimensions/hand_dimension.h"
#include "palmar/hand/hand.h"

namespace palmar::hand {

/// A driven dimension and what the instance's skin measures.
struct MetDimension {
  HandDimension dimension;
  double asked = 0.0;     ///< mm
  double measured = 0.0;  ///< mm, by measure_hand()
};

/// A hand of given size made from another one.
struct HandInstance {
  Hand hand;
  std::vector<MetDimension> driven;  ///< in the order of `targets`
  double largest_miss = 0.0;         ///< of the driven dimensions, mm
  int iterations = 0;                ///< of the search for the factors
};

/// The hand `base` scaled segment by segment (Xie 2014, 5.4) so that the dimensions in `targets`
/// are met within 0.1 mm as measure_hand() measures them.
///
/// What is not driven follows. With l = hand length over that of the base, c = circumference over
/// that of the base (if it isn't driven that of the width, of the thickness, else l; in the same
/// way l = c if no hand length is driven): lengths follow l, widths and thicknesses c. Of the parts
/// of the hand length (palm and the three segments of the middle finger) those not driven share
/// what the driven ones leave; if the palm's length is the only one, so do the other fingers'
/// undriven segments. Beside a driven width, thickness takes up the circumference, and the other
/// way round; beside both, how thick the borders of the palm are.
///
/// Scale factors change smoothly across creases (segment_scaling.h); joints, bones, limit postures
/// of the thumb, bulges and skinning move along; triangles, segments and regions stay, so fields of
/// different instances compare vertex by vertex. Tissue stays as it is. The skin stays closed and
/// doesn't cross itself.
///
/// Throws UsageError: a dimension twice, a value outside half to twice the base's, dimensions that
/// contradict each other (fingers longer than the hand), all named with value and what is allowed;
/// NumericalError if the dimensions can't be met within 0.1 mm.
HandInstance make_hand_instance(const Hand& base, const std::vector<SizedDimension>& targets);

/// The same for many instances of one hand: measures it and lays it out once. May be used by
/// several threads at a time.
class HandInstanceMaker {
 public:
  /// Keeps a pointer to `base`.
  explicit HandInstanceMaker(const Hand& base);
  ~HandInstanceMaker();
  HandInstanceMaker(HandInstanceMaker&&) noexcept;
  HandInstanceMaker& operator=(HandInstanceMaker&&) noexcept;

  HandInstance make(const std::vector<SizedDimension>& targets) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::hand
