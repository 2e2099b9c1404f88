// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "palmar/hand/hand.h"

namespace palmar::hand {

/// What skinning alone misses at one CMC limit posture: measured minus skinned position of each
/// marker, mm.
struct ThumbBallMarkers {
  std::vector<Vec3> reference;               ///< markers in the reference posture, mm
  std::array<std::vector<Vec3>, 4> missing;  ///< flexion, extension, abduction, adduction; mm
};

struct ThumbBallOptions {
  /// 1/mm^2 of phi(r) = exp(-beta r^2). Default: phi = 1/2 at 12 mm, about the spacing of a dozen
  /// markers on the thumb ball; wider makes the system ill-conditioned.
  double beta = 0.0048;
  double reach = 35.0;  ///< vertices farther than this from every marker stay, mm (phi < 0.003)
  void check() const;   ///< throws UsageError unless both are positive and finite
};

/// Coefficients d_k with which sum_k phi(r_ik) d_k equals the missing displacement at every marker
/// i (Xie 2014, eq. 2-8 to 2-10). Throws UsageError for unequal counts and NumericalError if
/// markers coincide.
ThumbBallCorrection fit_thumb_ball(const geometry::TriangleMesh& skin,
                                   const ThumbBallMarkers& markers,
                                   const ThumbBallOptions& options = {});

/// Correction at a point of the reference skin for the given shares of the limit postures, mm.
Vec3 thumb_ball_offset(const ThumbBallCorrection& correction, const Vec3& point,
                       const CmcShare& share);

}  // namespace palmar::hand
