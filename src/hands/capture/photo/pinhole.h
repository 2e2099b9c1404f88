// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "hands/capture/photo/photo_camera.h"

namespace palmar::capture {

/// A camera without distortion in single precision, for loops over many points: q = K (R X + t);
/// the pixel is (q_x, q_y) / q_z, the depth q_z.
struct Pinhole {
  Eigen::Matrix3f k_r = Eigen::Matrix3f::Identity();  ///< K R
  Eigen::Vector3f k_t = Eigen::Vector3f::Zero();      ///< K t

  Pinhole() = default;
  explicit Pinhole(const PhotoCamera& camera) {
    const Eigen::Matrix3d k = matrix_of(camera.lens);
    k_r = (k * camera.camera_from_world.rotation.toRotationMatrix()).cast<float>();
    k_t = (k * camera.camera_from_world.translation).cast<float>();
  }
  Eigen::Vector3f project(const Eigen::Vector3f& world) const { return k_r * world + k_t; }

  /// K of a lens.
  static Eigen::Matrix3d matrix_of(const PhotoLens& lens) {
    Eigen::Matrix3d k;
    k << lens.focal_x, 0, lens.centre_x, 0, lens.focal_y, lens.centre_y, 0, 0, 1;
    return k;
  }
};

}  // namespace palmar::capture
