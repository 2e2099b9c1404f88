// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/report/chart/figure.h"
#include "palmar/report/picture/coverage_mask.h"

namespace palmar::report {
namespace {

using Eigen::Vector2d;
using Points = std::vector<Vector2d>;

constexpr double kCapShare = 0.718;  // height of Helvetica's capitals as a share of the font size

/// The pieces of a line that its dashes show.
std::vector<Points> dashed(const Points& line, double dash) {
  if (!(dash > 0.0)) return {line};
  std::vector<Points> pieces(1, Points{line.front()});
  double left = dash;
  bool is_drawn = true;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    Vector2d from = line[i];
    double rest = (line[i + 1] - from).norm();
    while (rest > left) {
      from += (line[i + 1] - from) * (left / rest);
      rest -= left;
      left = dash;
      if (is_drawn) {
        pieces.back().push_back(from);
      } else {
        pieces.push_back({from});
      }
      is_drawn = !is_drawn;
    }
    left -= rest;
    if (is_drawn) pieces.back().push_back(line[i + 1]);
  }
  return pieces;
}

class Painter {
 public:
  Painter(const Figure& figure, double scale)
      : scale_(scale),
        image_(static_cast<int>(std::ceil(figure.width() * scale - 1e-9)),
               static_cast<int>(std::ceil(figure.height() * scale - 1e-9))),
        mask_(image_.width, image_.height) {}

  void draw(const Figure::Path& path) {
    draw_outline(path.points, path.is_closed, path.fill, path.pen);
  }

  void draw(const Figure::Circle& circle) {
    const double radius = circle.radius * scale_;
    const int corners =
        std::clamp(static_cast<int>(std::ceil(8.0 * std::sqrt(radius + 1.0))), 12, 400);
    // Corners a little outside, so that the polygon has the circle's area.
    const double step = 2.0 * std::numbers::pi / corners;
    const double reach = circle.radius * std::sqrt(step / std::sin(step));
    Points outline;
    for (int i = 0; i < corners; ++i) {
      outline.emplace_back(circle.centre +
                           reach * Vector2d(std::cos(step * i), std::sin(step * i)));
    }
    draw_outline(outline, true, circle.fill, circle.pen);
  }

  void draw(const Figure::Text& text) {
    // The stroke font, stretched to the width that Helvetica takes.
    const double cap = kCapShare * text.look.size;
    const double own = text_width(text.text, TextStyle{.cap_height = cap});
    const double width = text_width(text.text, text.look);
    const double pen = cap * (text.look.is_bold ? 0.2 : 0.13);
    const double stretch = own > 0.0 ? std::max(0.1, width - pen) / own : 1.0;
    const double shift = text.look.align == Align::kLeft     ? 0.0
                         : text.look.align == Align::kCentre ? -0.5 * width
                                                             : -width;
    const Eigen::Rotation2Dd turn(-text.look.turn * std::numbers::pi / 180.0);
    for (const Points& stroke : text_strokes(text.text, cap)) {
      Points line;
      for (const Vector2d& p : stroke) {
        const Vector2d local(shift + 0.5 * pen + stretch * p.x(), p.y());
        line.emplace_back(scale_ * (text.place + turn * local));
      }
      mask_.add_line(line, scale_ * pen, true);
    }
    mask_.paint(image_, text.look.colour, 1.0);
  }

  void draw(const Figure::Picture& picture) {
    const Vector2d low = scale_ * picture.corner;
    const Vector2d size = scale_ * picture.size;
    if (!(size.x() > 0.0 && size.y() > 0.0)) return;
    const Image source =
        narrowed(*picture.image, std::max(1, static_cast<int>(std::lround(size.x()))));
    const int y_end = std::min(image_.height, static_cast<int>(std::lround(low.y() + size.y())));
    const int x_end = std::min(image_.width, static_cast<int>(std::lround(low.x() + size.x())));
    for (int y = std::max(0, static_cast<int>(std::lround(low.y()))); y < y_end; ++y) {
      for (int x = std::max(0, static_cast<int>(std::lround(low.x()))); x < x_end; ++x) {
        const double u = (x + 0.5 - low.x()) / size.x() * source.width;
        const double v = (y + 0.5 - low.y()) / size.y() * source.height;
        image_.at(x, y) = source.at(std::clamp(static_cast<int>(u), 0, source.width - 1),
                                    std::clamp(static_cast<int>(v), 0, source.height - 1));
      }
    }
  }

  Image take() { return std::move(image_); }

 private:
  void draw_outline(const Points& points, bool is_closed, const std::optional<Fill>& fill,
                    const std::optional<Pen>& pen) {
    Points pixels;
    for (const Vector2d& p : points) pixels.emplace_back(scale_ * p);
    if (is_closed && fill) {
      mask_.add_polygon(pixels);
      mask_.paint(image_, fill->colour, fill->opacity);
    }
    if (!pen) return;
    if (is_closed) {  // past the first corner, so that it is joined like the others
      pixels.push_back(pixels[0]);
      pixels.push_back(Vector2d(pixels[0] + 1e-3 * (pixels[1] - pixels[0])));
    }
    for (const Points& piece : dashed(pixels, scale_ * pen->dash)) {
      mask_.add_line(piece, scale_ * pen->width, false);
    }
    mask_.paint(image_, pen->colour, 1.0);
  }

  double scale_;  // pixels per point
  Image image_;
  CoverageMask mask_;
};

}  // namespace

Image to_image(const Figure& figure, double scale) {
  if (!(scale > 0.0 && scale * std::max(figure.width(), figure.height()) <= 16384.0)) {
    throw UsageError("figure at " + std::to_string(scale) +
                     " pixels per point; more than 0 and sides up to 16384 pixels are allowed");
  }
  Painter painter(figure, scale);
  for (const Figure::Shape& shape : figure.shapes()) {
    std::visit([&](const auto& s) { painter.draw(s); }, shape);
  }
  return painter.take();
}

std::string to_png(const Figure& figure, double scale) {
  return encode_png(to_image(figure, scale));
}

}  // namespace palmar::report
