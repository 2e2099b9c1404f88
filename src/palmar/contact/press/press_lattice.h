// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "palmar/contact/press/press.h"

namespace palmar::contact {

using Vec2 = Eigen::Vector2d;

/// The gap between indenter and flat or curved specimen before contact, in their common tangent
/// plane at first touch, mm; and the part of that plane that the indenter covers.
///
///     gap(x, y) = x^2 / 2 R_x + y^2 / 2 R_y + x tan(tilt) - touch - depth
///
/// Small strain (Hertz 1882; Johnson 1985, section 4.1); the slope is that of a tilted punch, and
/// `touch` the lowest value of what stands before it, so that the depth counts from first touch.
class PressGap {
 public:
  /// A punch counts as wider by `margin` [mm].
  PressGap(const PressOptions& options, double depth, double margin = 0.0);

  double at(const Vec2& q) const;
  double depth() const { return depth_; }
  bool is_punch() const { return punch_radius_ > 0.0; }
  double punch_radius() const { return punch_radius_; }
  /// Points where gap < limit (and that the indenter covers) are no farther than this along x, y.
  Vec2 reach(double limit) const;
  /// Area of those points, mm^2.
  double area(double limit) const;
  bool covers(const Vec2& q) const;
  /// Distance from the punch's edge, mm; positive inside, negative infinity if no point is covered.
  double inside_edge(const Vec2& q) const;

 private:
  double curvature_x_ = 0.0, curvature_y_ = 0.0;  ///< 1/mm
  double slope_x_ = 0.0;
  double touch_ = 0.0;         ///< mm
  double depth_ = 0.0;         ///< mm
  double punch_radius_ = 0.0;  ///< mm; 0 = the indenter covers all
  double punch_offset_ = 0.0;  ///< mm; two punches at x = +- this
};

/// Cell of a triangular lattice: a rhombus of side `size` with its sides along the lattice's rows;
/// split, it gives four of half the size whose centres form a lattice again.
struct PressCell {
  Vec2 middle = Vec2::Zero();  ///< mm
  double size = 1.0;           ///< mm
  Vec2 centre = Vec2::Zero();  ///< of the part under the indenter, mm
  double area = 0.0;           ///< of that part, mm^2

  double whole_area() const;   ///< mm^2
  double disc_radius() const;  ///< of the disc of its area, mm
};

/// Cells of side `spacing` [mm] that the indenter covers and whose gap is below `limit` [mm].
std::vector<PressCell> press_lattice(const PressGap& gap, double spacing, double limit);

/// The same cells with the chosen ones split in four.
std::vector<PressCell> split_cells(const PressGap& gap, const std::vector<PressCell>& cells,
                                   const std::vector<char>& which, double limit);

}  // namespace palmar::contact
