// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/chart/figure.h"

#include <cmath>
#include <utility>

#include "palmar/core/error.h"

namespace palmar::report {
namespace {

constexpr double kLargestSide = 5000.0;  // points

void check_finite(const Eigen::Vector2d& point, double more, const char* what) {
  if (!point.allFinite() || !std::isfinite(more)) {
    throw UsageError(std::string("figure: a ") + what + " has a coordinate that is not finite");
  }
}

template <class Point>
void shift(Figure::Shape& shape, const Point& by) {
  if (auto* path = std::get_if<Figure::Path>(&shape)) {
    for (auto& p : path->points) p += by;
  } else if (auto* circle = std::get_if<Figure::Circle>(&shape)) {
    circle->centre += by;
  } else if (auto* text = std::get_if<Figure::Text>(&shape)) {
    text->place += by;
  } else if (auto* picture = std::get_if<Figure::Picture>(&shape)) {
    picture->corner += by;
  }
}

}  // namespace

Figure::Figure(double width, double height, std::string title)
    : width_(width), height_(height), title_(std::move(title)) {
  for (const double side : {width, height}) {
    if (!(side >= 1.0 && side <= kLargestSide)) {
      throw UsageError("figure of " + std::to_string(width) + " x " + std::to_string(height) +
                       " points; sides of 1 to 5000 are allowed");
    }
  }
}

void Figure::line(double x1, double y1, double x2, double y2, const Pen& pen) {
  polyline({{x1, y1}, {x2, y2}}, pen);
}

void Figure::polyline(std::vector<Eigen::Vector2d> points, const Pen& pen) {
  for (const Eigen::Vector2d& p : points) check_finite(p, 0.0, "line");
  if (points.size() < 2) return;
  shapes_.push_back(Path{std::move(points), false, std::nullopt, pen});
}

void Figure::polygon(std::vector<Eigen::Vector2d> points, std::optional<Fill> fill,
                     std::optional<Pen> pen) {
  for (const Eigen::Vector2d& p : points) check_finite(p, 0.0, "polygon");
  if (points.size() < 3) return;
  shapes_.push_back(Path{std::move(points), true, fill, pen});
}

void Figure::circle(double x, double y, double radius, std::optional<Fill> fill,
                    std::optional<Pen> pen) {
  check_finite({x, y}, radius, "circle");
  shapes_.push_back(Circle{{x, y}, radius, fill, pen});
}

void Figure::rect(double x, double y, double width, double height, std::optional<Fill> fill,
                  std::optional<Pen> pen) {
  polygon({{x, y}, {x + width, y}, {x + width, y + height}, {x, y + height}}, fill, pen);
}

void Figure::text(double x, double y, std::string text, const Lettering& look) {
  check_finite({x, y}, look.size + look.turn, "text");
  if (text.empty()) return;
  shapes_.push_back(Text{{x, y}, std::move(text), look});
}

void Figure::image(double x, double y, double width, double height, Image picture) {
  check_finite({x, y}, width + height, "picture");
  if (picture.pixels.empty()) return;
  shapes_.emplace_back(
      Picture{{x, y}, {width, height}, std::make_shared<const Image>(std::move(picture))});
}

void Figure::add(const Figure& other, double x, double y) {
  check_finite({x, y}, 0.0, "figure");
  const std::vector<Shape> added = other.shapes_;  // a figure may be added to itself
  for (Shape shape : added) {
    shift(shape, Eigen::Vector2d(x, y));
    shapes_.push_back(std::move(shape));
  }
}

void Figure::say(const std::function<std::string(const std::string&)>& said) {
  title_ = said(title_);
  for (Shape& shape : shapes_) {
    if (auto* text = std::get_if<Text>(&shape)) text->text = said(text->text);
  }
}

}  // namespace palmar::report
