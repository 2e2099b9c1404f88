// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "hands/capture/sheet/line_fit.h"
#include "palmar/geometry/rigid3.h"

namespace palmar::capture {

/// Where a camera without distortion saw a card. The table's frame: origin below the card's middle,
/// z up; the card's face at its thickness; mm.
struct CardPose {
  double width = 0.0, height = 0.0;    ///< of the card along x and y
  geometry::Rigid3 camera_from_table;  ///< x to the right of the picture, y down, z forward
  double focal = 0.0;                  ///< pixels
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of the picture, pixels
  double misfit = 0.0;                               ///< of the edges, RMS, pixels
  /// Covariance of a small turn (about the camera's axes, rad) and shift (mm) after the pose.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  /// Of points with z = 0.
  Eigen::Matrix3d pixel_from_table() const;
  Vec3 eye() const { return camera_from_table.inverse().translation; }
  /// The same with the table's frame turned anticlockwise by quarters.
  CardPose turned(int quarters) const;
  /// Deviation, as a share, of the distance between two things that are seen at points of the
  /// table.
  double scale_error(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const;
};

/// Of the card's corners (clockwise in the picture, from any) and its edges' lines (edge e from
/// corner e to the next), see find_card().
CardPose fit_card(const std::array<Eigen::Vector2d, 4>& corner,
                  const std::array<FittedLine, 4>& edge, double focal,
                  const Eigen::Vector2d& centre);

}  // namespace palmar::capture
