// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::redesign {

/// How deep one hand's skin, posed but not deformed, reaches into a product: per point of the
/// product's surface that the skin covers. Sparse, ascending by point.
struct Imprint {
  std::vector<int> point;     ///< index of the surface point
  std::vector<double> depth;  ///< mm, above 0
};

struct ImprintOptions {
  double largest = 15.0;    ///< mm; what reaches deeper counts as that. 0.1 to 100
  double wall_share = 0.5;  ///< of the local wall that a depth may not exceed: half, so that two
                            ///< sides never ask for more than there is. (0, 1]
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// Measures imprints at points of a product's surface.
///
/// From a point x a ray goes inwards, along -m, m the unit outward direction given for x. If x lies
/// in the skin (winding number above 1/2), the depth is the way until the ray has left it, through
/// overlapping fingers too. A point is not covered if the skin came through the wall from behind:
/// if the way out of the skin along +m is the shorter one. Single precision, as ray_query.h.
///
/// The skin may be open at the wrist. Results don't depend on the number of threads.
class ImprintGauge {
 public:
  /// `outward` is per point. Throws UsageError if sizes differ, InputError as RayQuery does.
  ImprintGauge(const geometry::TriangleMesh& product, std::vector<Vec3> points,
               std::vector<Vec3> outward, const ImprintOptions& options = {});
  ~ImprintGauge();

  /// `skin` in the product frame, mm.
  Imprint measure(const geometry::TriangleMesh& skin) const;

  /// Per point: thickness of the product along -m, mm; infinity where the ray never leaves it.
  const std::vector<double>& wall() const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// What many hands' depths at a point become.
enum class ImprintStatistic { kMean, kPercentile };

struct CombineOptions {
  ImprintStatistic statistic = ImprintStatistic::kMean;
  double percentile = 75.0;  ///< of kPercentile, 0 to 100; between two hands interpolated
  /// Hands that don't cover a point count as 0. If true they are left out there: the shape then
  /// has room for every hand, but no finger shows any more where hands differ.
  bool is_among_touching = false;
  void check() const;  ///< throws UsageError
};

/// Depth per point over hands [mm]; doesn't depend on their order. All zero for no hands. Throws
/// UsageError on a point outside [0, points).
std::vector<double> combine_imprints(std::span<const Imprint> imprints, int points,
                                     const CombineOptions& options = {});

}  // namespace palmar::redesign
