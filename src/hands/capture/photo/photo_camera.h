// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// Lens and sensor of a camera. A point (x, y, z) of the camera's frame (x to the right of the
/// picture, y down, z forward; mm) falls on the pixel
///
///     u = f_x d x/z + c_x,   v = f_y d y/z + c_y,   d = 1 + k1 r^2 + k2 r^4,   r^2 = (x^2 +
///     y^2)/z^2.
///
/// Whole pixel coordinates are centres of pixels: the picture reaches from -0.5 to width - 0.5.
/// Source: Brown 1966, radial terms; the convention of OpenCV.
struct PhotoLens {
  int width = 0, height = 0;                  ///< pixels
  double focal_x = 0.0, focal_y = 0.0;        ///< f, pixels
  double centre_x = 0.0, centre_y = 0.0;      ///< c, pixels
  double k1 = 0.0, k2 = 0.0;                  ///< radial distortion
  void check(const std::string& name) const;  ///< throws InputError: field, value, allowed range

  /// Between a direction (x/z, y/z) and its pixel. `direction_of` inverts the distortion by
  /// Newton's method, for any k1, k2 with which r d rises over the picture.
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& direction) const;
  Eigen::Vector2d direction_of(const Eigen::Vector2d& pixel) const;
};

/// A lens at a place. The world is that of the board: its plane z = 0, z up, mm.
struct PhotoCamera {
  PhotoLens lens;
  geometry::Rigid3 camera_from_world;

  Vec3 centre() const { return camera_from_world.inverse().translation; }
  /// The pixel of a point; nothing if it lies behind the camera. May lie outside of the picture.
  std::optional<Eigen::Vector2d> project(const Vec3& world) const;
  /// Unit direction in the world of the ray through a pixel.
  Vec3 ray(const Eigen::Vector2d& pixel) const;
};

/// A camera at `centre` that looks at `target`, the picture's x axis parallel to the board.
geometry::Rigid3 looking_at(const Vec3& centre, const Vec3& target);

}  // namespace palmar::capture
