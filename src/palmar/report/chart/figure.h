// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/report/picture/image.h"
#include "palmar/report/picture/stroke_text.h"

namespace palmar::report {

inline constexpr Rgb kInkColour{34, 40, 46};    ///< text and axes of figures
inline constexpr Rgb kFaintColour{74, 82, 90};  ///< numbers at ticks
inline constexpr Rgb kGridColour{223, 227, 230};

/// A line's look; lengths in points.
struct Pen {
  Rgb colour = kInkColour;
  double width = 1.0;
  double dash = 0.0;  ///< length of dashes and of the gaps between them; 0: a whole line
};

/// A surface's look.
struct Fill {
  Rgb colour;
  double opacity = 1.0;  ///< 0 to 1
};

struct Lettering {
  double size = 9.0;  ///< of the font, points
  Align align = Align::kLeft;
  double turn = 0.0;  ///< counter-clockwise about the text's place, degrees
  Rgb colour = kInkColour;
  bool is_bold = false;
};

/// A drawing as a list of shapes, from which the same picture is made as SVG, PDF and PNG: no font
/// file, no display, no time stamp; same figure, same bytes. Lengths in points (1/72 inch), origin
/// at the upper left corner, y down; later shapes cover earlier ones. What lies outside is cut off.
/// Adding a shape throws UsageError if a coordinate is not finite.
class Figure {
 public:
  /// `title`: for those who can't see it. Throws UsageError unless both sides are 1 to 5000 points.
  Figure(double width, double height, std::string title = "");

  void line(double x1, double y1, double x2, double y2, const Pen& pen = {});
  void polyline(std::vector<Eigen::Vector2d> points, const Pen& pen = {});
  void polygon(std::vector<Eigen::Vector2d> points, std::optional<Fill> fill,
               std::optional<Pen> pen = std::nullopt);
  void circle(double x, double y, double radius, std::optional<Fill> fill,
              std::optional<Pen> pen = std::nullopt);
  void rect(double x, double y, double width, double height, std::optional<Fill> fill,
            std::optional<Pen> pen = std::nullopt);
  /// One line of text; (x, y) is the left, middle or right end of its base line.
  void text(double x, double y, std::string text, const Lettering& look = {});
  /// A picture stretched over a rectangle.
  void image(double x, double y, double width, double height, Image picture);
  /// Everything of another figure, its origin at (x, y).
  void add(const Figure& other, double x, double y);

  /// Every text and the title as `said` gives them back.
  void say(const std::function<std::string(const std::string&)>& said);

  struct Path {  ///< polyline, polygon, rect
    std::vector<Eigen::Vector2d> points;
    bool is_closed = false;
    std::optional<Fill> fill;
    std::optional<Pen> pen;
  };
  struct Circle {
    Eigen::Vector2d centre;
    double radius = 0.0;
    std::optional<Fill> fill;
    std::optional<Pen> pen;
  };
  struct Text {
    Eigen::Vector2d place;
    std::string text;
    Lettering look;
  };
  struct Picture {
    Eigen::Vector2d corner;
    Eigen::Vector2d size;
    std::shared_ptr<const Image> image;
  };
  using Shape = std::variant<Path, Circle, Text, Picture>;

  double width() const { return width_; }
  double height() const { return height_; }
  const std::string& title() const { return title_; }
  const std::vector<Shape>& shapes() const { return shapes_; }

 private:
  double width_, height_;
  std::string title_;
  std::vector<Shape> shapes_;
};

/// Width of a line of text, points (Helvetica's advances; SVG and PNG keep to them).
double text_width(std::string_view text, const Lettering& look);

/// A free-standing SVG element, text as text; 1 point is 1 unit.
std::string to_svg(const Figure& figure);
/// Bytes of a PNG file on white; `scale` pixels per point. Throws UsageError if a side is more than
/// 16384 pixels.
std::string to_png(const Figure& figure, double scale = 2.0);
Image to_image(const Figure& figure, double scale = 2.0);
/// Bytes of a PDF file with one page of the figure's size: vectors, text in Helvetica, which every
/// reader has. Letters outside Latin-1 become the nearest that it has, or '?'.
std::string to_pdf(const Figure& figure);

}  // namespace palmar::report
