// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/product/product_faces.h"

namespace palmar::redesign {

/// A surface of simple geometry, without end: what a mill, a lathe or a ball cutter leaves.
///
///     plane     point on it, axis its normal
///     sphere    point its centre, radius
///     cylinder  point on its axis, axis, radius
///     cone      point on its axis, axis towards where it widens, radius there, half_angle
///     torus     point its centre, axis, radius of the circle in its middle, tube_radius
struct SimpleSurface {
  product::FaceKind kind = product::FaceKind::kPlane;
  Vec3 point = Vec3::Zero();  ///< mm
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double radius = 0.0;        ///< mm
  double tube_radius = 0.0;   ///< mm; of a torus
  double half_angle = 0.0;    ///< rad, 0 to pi / 2; of a cone
};
/// Orthogonal distance, mm: positive outside of the sphere, cylinder, cone or tube, or where the
/// plane's normal points to.
double distance_to(const SimpleSurface& surface, const Vec3& point);
/// "cylinder r 16.2 mm", "torus r 120 mm, tube 14 mm", "cone r 12 mm, half angle 3.1 deg".
std::string title_of(const SimpleSurface& surface);

/// A simple surface through points, by least squares of orthogonal distances.
struct SurfaceFit {
  SimpleSurface surface;
  double rms = 0.0;  ///< mm
  double max = 0.0;  ///< mm, largest distance of a point
  bool has_converged = false;
};

struct SurfaceFitOptions {
  /// mm; a surface whose rms is below it is good enough: milled handles are no better.
  double tolerance = 0.05;
  /// A simpler surface is taken as long as its rms is not above that many times the best.
  double preference = 1.25;
  /// mm; larger radii are planes and cylinders to people (and to the kernel of a CAD system).
  double largest_radius = 5000.0;
  double smallest_radius = 2.0;  ///< mm; smaller ones are no surface of a handle but of noise
  void check() const;            ///< throws UsageError: field, value, allowed range
};

/// The best surface of one kind, from several starts: principal axes of points and normals with
/// circles in the projection (Kasa 1976), and the cylinder, sphere and torus that share curvatures
/// with the paraboloid through the points. `normals` point out of the material, or are empty. Needs
/// as many points as the surface has parameters (plane 3, sphere 4, cylinder 5, cone 6, torus 7);
/// throws UsageError on fewer, on normals that don't match, or on FaceKind::kFreeform. A fit that
/// doesn't exist (a cylinder through points of a line) hasn't converged.
SurfaceFit fit_surface(product::FaceKind kind, std::span<const Vec3> points,
                       std::span<const Vec3> normals, const SurfaceFitOptions& options = {});

/// All kinds that the points suffice for, from the simplest on: plane, cylinder, sphere, cone,
/// torus; and which is the first that is good enough, or not much worse than the best.
struct SurfaceChoice {
  std::vector<SurfaceFit> fits;
  int chosen = 0;  ///< index into fits
  const SurfaceFit& best() const { return fits[chosen]; }
};
SurfaceChoice choose_surface(std::span<const Vec3> points, std::span<const Vec3> normals,
                             const SurfaceFitOptions& options = {});

struct PatchSplitOptions {
  double tolerance = 0.3;  ///< mm; a piece whose best surface has a smaller rms isn't cut further
  int least_points = 24;   ///< pieces don't get smaller
  int largest_depth = 3;   ///< halvings: at most 8 pieces
};
/// Cuts a patch that goes over edges into pieces that simple surfaces suit: two groups of normals
/// at a time (k-means), as long as none is good enough. Indices of the points of each piece,
/// ascending; together all points.
std::vector<std::vector<int>> split_patch(std::span<const Vec3> points,
                                          std::span<const Vec3> normals,
                                          const PatchSplitOptions& split = {},
                                          const SurfaceFitOptions& options = {});

}  // namespace palmar::redesign
