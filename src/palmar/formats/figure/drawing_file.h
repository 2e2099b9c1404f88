// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace palmar::formats {

/// Lines of one kind.
struct DrawingLayer {
  std::string name;             ///< letters, digits and - only in DXF: others become _
  std::array<int, 3> colour{};  ///< sRGB, 0 to 255
  int dxf_colour = 7;           ///< AutoCAD colour index: 1 red, 5 blue, 7 black, 8 grey
  double width = 0.35;          ///< mm
  bool is_dashed = false;
};

struct DrawingLine {
  int layer = 0;
  std::vector<Eigen::Vector2d> points;  ///< mm, y upwards
  bool is_closed = false;
};

struct DrawingText {
  int layer = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();  ///< left end of the base line, mm
  double height = 3.5;                           ///< of capitals, mm
  std::string text;
};

/// A flat drawing in true scale.
struct Drawing {
  std::string title;
  std::vector<DrawingLayer> layers;
  std::vector<DrawingLine> lines;
  std::vector<DrawingText> texts;
};

/// DXF of AutoCAD Release 12 (AC1009), ASCII: what every cutter, laser and CAD system reads.
/// Layers, polylines and texts; one drawing unit is one millimetre. Throws UsageError on a layer
/// that isn't there or a coordinate that isn't finite.
std::string dxf_of(const Drawing& drawing);

/// SVG 1.1 whose width and height are in millimetres: printed at 100 % it is in true scale.
std::string svg_of(const Drawing& drawing);

}  // namespace palmar::formats
