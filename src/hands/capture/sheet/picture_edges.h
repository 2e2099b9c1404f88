// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "hands/capture/sheet/line_fit.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::capture {

/// The picture, reduced by a whole number.
geometry::RgbImage reduced_picture(const geometry::RgbImage& image, int by);

/// Where two lines through a, b and c, d meet; nothing if they are as good as parallel.
std::optional<Eigen::Vector2d> meeting(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                       const Eigen::Vector2d& c, const Eigen::Vector2d& d);

/// The quadrilateral round a convex polygon: edges whose neighbours, drawn on, add least are
/// dropped. Nothing if there is none.
std::optional<std::array<Eigen::Vector2d, 4>> four_sided(std::vector<Eigen::Vector2d> polygon);

/// Area of a polygon; positive if it goes round with y to the left of x.
double area_of(const std::vector<Eigen::Vector2d>& polygon);

/// How an edge is looked for along its normals.
struct EdgeSearch {
  double reach = 10.0;        ///< to either side, pixels
  double rise = 25.0;         ///< least, over 8 pixels
  double from_corner = 0.02;  ///< share of its length that is left out at each end
};
inline constexpr int kEdgePlaces = 240;

/// Points of an edge between two corners (the inside to the left of the way from one to the other
/// in a frame with y down: clockwise): where the brightness along a normal, rising steepest, passes
/// the middle between outside and inside; places where it doesn't rise have none.
std::vector<Eigen::Vector2d> edge_points(
    const std::function<double(const Eigen::Vector2d&)>& brightness, const Eigen::Vector2d& from,
    const Eigen::Vector2d& to, const EdgeSearch& search);

/// Over how far the brightness goes from a tenth to nine tenths of the way from outside to inside,
/// pixels: the median of the places of an edge; nothing if fewer than a quarter of them show a
/// rise.
std::optional<double> edge_width(const std::function<double(const Eigen::Vector2d&)>& brightness,
                                 const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                 const EdgeSearch& search);

struct SeenLine {
  FittedLine line;
  int points = 0;  ///< that lie on it within 2 pixels
};

/// A line through most of the points: the best of all pairs of a few, then its neighbours' least
/// squares.
SeenLine line_through(const std::vector<Eigen::Vector2d>& points);

/// Homography of a rectangle about the origin, y up, to its corners in a picture: upper left, upper
/// right, lower right, lower left. Source: Heckbert 1989.
Eigen::Matrix3d homography_of(const std::array<Eigen::Vector2d, 4>& corner, double width,
                              double height);

}  // namespace palmar::capture
