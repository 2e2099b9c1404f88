// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "hands/capture/sheet/sheet_view.h"
#include "hands/imaging/volume.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::capture {

/// Square cells on a sheet or table, rows from the top, in the frame of its SheetView (mm). Below
/// its lower edge (or, of a sheet, another one) lies the forearm.
struct SheetGrid {
  int width = 0, height = 0;
  double cell = 1.0;                                 ///< mm
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< centre of the first cell
  double border = 0.0;  ///< how far outside of its edges those lie under which the wrist is, mm

  std::size_t at(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  std::size_t count() const { return static_cast<std::size_t>(width) * height; }
  Eigen::Vector2d sheet(double x, double y) const { return corner + cell * Eigen::Vector2d(x, -y); }
  Eigen::Vector2d place(const Eigen::Vector2d& p) const {
    return {(p.x() - corner.x()) / cell, (corner.y() - p.y()) / cell};
  }
  /// From a point inside to the nearest edge, mm; negative outside.
  double to_edge(const Eigen::Vector2d& p) const;
  imaging::VolumeGrid volume() const;
};

/// Of a sheet: all of it but 1.5 mm at its edges, which are blurred.
SheetGrid grid_of_sheet(const SheetView& sheet, double cell);
/// Beside a card: what lies beyond the line through its lower edge, as far as a hand reaches.
SheetGrid grid_beside_card(const SheetView& card, double cell);

/// A grid as a photograph shows it.
struct RectifiedSheet {
  SheetGrid grid;
  std::vector<Eigen::Vector3f> light;  ///< linear; over that of paper or table once it is levelled
  std::vector<char> is_seen;           ///< the cell is in the picture
};

enum class Ground { kPaper, kTable };

/// Divides by the light of paper or table: a quadratic of the place for each channel, fitted to
/// what is nearly as bright as paper (the brightest large part) or as the table (most of it). What
/// isn't seen gets the ground's light. Returns that light, cell by cell.
std::vector<Eigen::Vector3f> level_light(RectifiedSheet& drawn, Ground ground);

/// sRGB of 0 to 255 in linear light, 0 to 1.
float linear_light(double srgb);

/// Draws it and levels its light.
RectifiedSheet draw_sheet(const geometry::RgbImage& image, const SheetView& sheet,
                          const SheetGrid& grid, Ground ground);

}  // namespace palmar::capture
