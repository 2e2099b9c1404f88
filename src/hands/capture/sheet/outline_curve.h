// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/capture/sheet/sheet_grid.h"
#include "hands/imaging/distance_transform.h"

namespace palmar::capture {

/// The outline of a mask, that isn't empty, as corners of its cells, closed, the mask to its left
/// (in a frame with y up).
std::vector<Eigen::Vector2d> outline_of(const SheetGrid& grid, const imaging::VoxelMask& mask);

/// The part of an outline that isn't the grid's edge, from one side of the forearm to the other.
struct OpenOutline {
  std::vector<Eigen::Vector2d> curve;  ///< mm, smoothed by 0.7 mm
  /// Where it leaves the edge and comes back to it.
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = Eigen::Vector2d::Zero();
};

/// Throws InputError `name`: no forearm over an edge, one that crosses a corner or isn't 25 to 110
/// mm wide, more that reaches beyond an edge.
OpenOutline open_outline(const SheetGrid& grid, const std::vector<Eigen::Vector2d>& closed,
                         const std::string& name);

/// A place on a curve that is nearest to or farthest from a point.
struct Extreme {
  std::size_t at = 0;
  double height = 0.0;  ///< the distance, mm
};

/// Tips and the webs between them: maxima of a curve's distance from a point that stand out by 12
/// mm, and the minima between them.
struct OutlineExtremes {
  std::vector<Extreme> tips, webs;
};
OutlineExtremes extremes_of(const std::vector<Eigen::Vector2d>& curve,
                            const Eigen::Vector2d& middle);

}  // namespace palmar::capture
