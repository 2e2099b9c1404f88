// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/core/progress.h"
#include "palmar/redesign/press_region.h"
#include "palmar/redesign/pressed_shape.h"

namespace palmar::redesign {

// What holds a pressed shape within its limits; parts of press_shape().

/// `depth` below 0.75 limit; beyond that a curve without a kink that comes near `limit` [mm] and
/// never reaches it.
double held_below(double depth, double limit);

/// Distance of each point to a mesh, mm; `range` where it is farther.
std::vector<double> distance_to(const geometry::TriangleMesh& mesh, const std::vector<Vec3>& points,
                                double range);

/// Per triangle of the product: 1 if it lies on a face that is kept out; empty if no face is named.
/// Throws UsageError naming a face that doesn't exist, or that the product has none.
std::vector<unsigned char> kept_face_triangles(const product::Product& product,
                                               const KeepOut& keep_out);

/// All triangles of the region's mesh that must not be pressed: by face, or by a box of `keep_out`.
geometry::TriangleMesh kept_part(const PressRegion& region,
                                 const std::vector<unsigned char>& kept_faces,
                                 const KeepOut& keep_out);

/// The surface as it becomes when every vertex of the region goes `depth` [mm] against its outward
/// direction.
class PressedSurface {
 public:
  /// Both must outlive it. `outward` is per vertex of the region.
  PressedSurface(const PressRegion& region, const std::vector<Vec3>& outward)
      : region_(region), outward_(outward) {}

  std::vector<Vec3> moved(const std::vector<double>& depth) const;

  /// Depths with which the pressed surface has no creases where an edge of the original was pressed
  /// deeper than it is round: vertices go on along their directions to a surface smoothed over
  /// `length` [mm] where that lies deeper; less where the depth is below 1 mm, so that rims stay.
  std::vector<double> without_creases(const std::vector<double>& depth, double length) const;

  /// Shares in [0, 1] of `depth` per vertex for which the surface doesn't fold or cross itself
  /// where the original didn't, and vertices keep `wall` [mm] of product under them, along their
  /// direction, that had it (`wall_before`). 1 where nothing is wrong; round what is wrong it is
  /// taken back by a quarter, with a blend, until nothing is.
  std::vector<double> sound_share(const std::vector<double>& depth,
                                  const std::vector<double>& wall_before, double wall,
                                  const Progress& progress) const;

  /// Least thickness under vertices deeper than `pressed`, mm; infinity if there are none.
  double thinnest_wall(const std::vector<double>& depth, double pressed) const;

 private:
  std::vector<double> walls(const std::vector<double>& depth, double pressed) const;
  std::vector<unsigned char> folded(const std::vector<Vec3>& moved) const;

  const PressRegion& region_;
  const std::vector<Vec3>& outward_;
};

}  // namespace palmar::redesign
