// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "palmar/geometry/mesh/textured_mesh.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// A sheet of paper or a card of known size, mm.
struct SheetFormat {
  std::string name;  ///< "a4", "letter", "card"
  double width = 0.0, height = 0.0;
  double corner = 0.0;     ///< radius of its corners
  double thickness = 0.0;  ///< its face lies that much above the table
};

/// ISO 216 A4, ANSI A (letter).
const std::vector<SheetFormat>& sheet_formats();
/// A bank card: ISO/IEC 7810:2019 ID-1 (its corners have radii of 2.88 to 3.48 mm).
const SheetFormat& card_format();
/// One of these. Throws UsageError naming those allowed.
const SheetFormat& sheet_format_named(const std::string& name);

/// A white sheet on a darker table as a photograph shows it. Its frame: origin in its middle, x to
/// the right of the picture, y up, z towards the camera; mm.
struct SheetView {
  SheetFormat format;  ///< width: along x, as it lies in the picture
  std::array<Eigen::Vector2d, 4>
      corner;  ///< pixels: upper left, upper right, lower right, lower left
  Eigen::Matrix3d pixel_from_sheet = Eigen::Matrix3d::Identity();  ///< of points with z = 0
  Vec3 eye = Vec3::Zero();                                         ///< the camera's centre
  double tilt = 0.0;         ///< of the way to the camera from the sheet's normal, deg
  double focal = 0.0;        ///< pixels, as taken for `eye`
  std::string focal_source;  ///< "camera", "sheet", "usual"
  double edge_error = 0.0;   ///< of the edges from straight lines, RMS, mm
  double edge_width =
      0.0;  ///< of the sharpest edge: from a tenth to nine tenths of the brightness, mm
  double scale_error = 0.0;  ///< of lengths of a hand on it, deviation, as a share

  Eigen::Vector2d pixel_of(const Eigen::Vector2d& sheet) const;
  /// The point at height z above the sheet that is seen where the sheet's point is.
  Eigen::Vector2d raised(const Eigen::Vector2d& sheet, double z) const {
    return sheet + (eye.head<2>() - sheet) * (z / eye.z());
  }
};

struct SheetOptions {
  std::optional<SheetFormat> format;  ///< nothing: recognised by its shape
  std::optional<double> focal;        ///< of the lens, pixels, as the camera says
  double most_tilt = 40.0;            ///< deg
  void check() const;                 ///< throws UsageError: field, value, allowed range
};

/// A sharp photograph shows an edge within a few tenths of a millimetre; blur makes hands broader.
inline constexpr double kWidestEdge = 1.5;  ///< mm
/// How far off an edge its sharpness is measured.
inline constexpr double kSharpnessReach = 3.0;  ///< mm
/// An edge that falls between pixels is so wide all the same.
inline constexpr double kSharpPixels = 2.6;
/// What is said of a wider edge of a "sheet" or "card", in mm as the size of a pixel; infinite:
/// wider than the reach. Nothing of a sharp one.
std::optional<std::string> blurred(double edge_width, double pixel, const std::string& what);

/// Finds the sheet: the largest part of the picture that is as bright and as grey as its brightest,
/// bounded by four straight edges (of which a hand may cross one); corners where the edges' lines
/// meet. The lens has its axis in the picture's middle, square pixels and no distortion. Throws
/// InputError `name`: no sheet, not all of it in the picture, hidden edges, too oblique, A4 and
/// letter not distinguished, blurred.
SheetView find_sheet(const geometry::RgbImage& image, const std::string& name,
                     const SheetOptions& options = {});

}  // namespace palmar::capture
