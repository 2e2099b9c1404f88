// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <vector>

#include "hands/capture/photo/surface/patch_match.h"

namespace palmar::capture {

struct DepthFusionOptions {
  double agree = 0.8;        ///< largest difference of two views' depths of a point, mm
  double agree_angle = 40;   ///< largest angle between their normals, deg
  int least_views = 3;       ///< that must agree, the one with the pixel among them
  double widest_angle = 70;  ///< deg between views that are compared
  /// Two views of one lens that show a point within so many pixels of the same pixel don't count
  /// for each other: what is far behind the board and goes round with the camera (or stands still
  /// with it while the board turns) stays where it is in the picture, which looks like a surface
  /// round the axis. 0: they count.
  double still = 0.0;
  int patch_radius =
      3;               ///< of the patches that gave the depths (PatchMatchOptions::radius), pixels
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// A point of the surface with its normal, and what it rests on.
struct SurfacePoint {
  Eigen::Vector3f position;  ///< world, mm
  Eigen::Vector3f normal;    ///< unit, outwards
  int views = 0;             ///< that agree about it
  /// Covariance of the places on the surface that the views' patches compare, mm^2, mean over the
  /// views: xx, yy, zz, xy, xz, yz. Patches of no extent have 0.
  std::array<float, 6> patch{};
};

/// What the views agree about.
struct FusedDepths {
  std::vector<SurfacePoint> points;
  std::vector<int> kept;  ///< per view: points that began with its pixels
};

/// Points that several views agree about: for each pixel the mean of what these say, so that a
/// piece of skin comes once per view that sees it. Source: Galliani et al. 2015, section 4.
FusedDepths fuse_depths(const std::vector<PhotoView>& views, const std::vector<DepthMap>& maps,
                        const Vec3& middle, const DepthFusionOptions& options = {});

}  // namespace palmar::capture
