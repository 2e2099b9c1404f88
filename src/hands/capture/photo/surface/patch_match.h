// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "hands/capture/photo/photo_mask.h"
#include "hands/capture/photo/photo_view.h"
#include "palmar/geometry/distance/ray_query.h"

namespace palmar::capture {

struct PatchMatchOptions {
  int radius = 3;            ///< patches of (2 radius + 1)^2 pixels
  int sources = 4;           ///< other views that a view is compared with
  int best = 2;              ///< of these, the best count: the others may not see the point
  int iterations = 4;        ///< over all pixels
  double wanted_angle = 18;  ///< deg between the axes of view and source, at the hand
  double front = 4.0;        ///< depths from so far in front of the bound's surface, mm,
  double behind = 25.0;      ///< to so far behind it, mm
  double worst_cost = 0.55;  ///< 1 - correlation; pixels above it have no depth
  std::uint64_t seed = 1;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

/// What stereo found in one view. Pixels without a depth have depth 0.
struct DepthMap {
  int width = 0, height = 0;
  std::vector<float> depth;             ///< z in the camera's frame, mm
  std::vector<Eigen::Vector3f> normal;  ///< unit, in the camera's frame, towards the camera
  std::vector<float> cost;              ///< 1 - correlation, 0 to 2
};

/// A view as the others are compared with it: per pixel the brightness of itself, its right, its
/// lower and its lower right neighbour, a byte each.
struct PackedView {
  int width = 0, height = 0;
  std::vector<std::uint32_t> corners;
};
PackedView packed(const PhotoView& view);

/// For each view the others to compare it with: those whose axes of sight (from `point`) stand
/// nearest to the wanted angle, between 4 and 50 degrees; best first, fewer if there aren't so
/// many.
std::vector<std::vector<int>> choose_sources(const std::vector<PhotoView>& views, const Vec3& point,
                                             const PatchMatchOptions& options);

/// Depth and slope of the surface in the pixels of a mask.
///
/// Every pixel holds a plane n X = d in the camera's frame. A plane is as good as the patch round
/// the pixel correlates (normalised cross-correlation) with what it is mapped to in the sources;
/// the cost is the mean of 1 - correlation over the `best` of them. Planes begin at the bound and
/// at random depths behind it; then each iteration goes over the pixels like the colours of a
/// chessboard: a pixel tries the planes of eight neighbours (next and five away) and changes of its
/// own by shrinking random amounts, and keeps the best. Depths stay between `front` and `behind` of
/// the bound's surface. The map of a plane is taken as affine over a patch.
///
/// Random numbers belong to view, pixel and iteration: any number of threads gives the same.
/// Source: Bleyer, Rhemann, Rother 2011, "PatchMatch stereo"; Galliani, Lasinger, Schindler 2015,
/// "Massively parallel multiview stereopsis by surface normal diffusion".
DepthMap match_patches(const std::vector<PhotoView>& views, const std::vector<PackedView>& packed,
                       int view, const PhotoMask& mask, const std::vector<int>& sources,
                       const geometry::RayQuery& bound, const geometry::TriangleMesh& bound_mesh,
                       const PatchMatchOptions& options = {});

}  // namespace palmar::capture
