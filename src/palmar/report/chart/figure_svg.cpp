// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <charconv>
#include <cmath>

#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/chart/figure.h"
#include "palmar/report/chart/figure_number.h"
#include "palmar/report/words/html_text.h"

namespace palmar::report {

std::string figure_number(double value) {
  std::array<char, 400> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 2).ptr;
  std::string result(text.data(), end);
  while (result.back() == '0') result.pop_back();
  if (result.back() == '.') result.pop_back();
  return result == "-0" ? "0" : result;
}

namespace {

std::string attribute(const char* name, double value) {
  return std::string(" ") + name + "=\"" + figure_number(value) + "\"";
}

std::string look(const std::optional<Fill>& fill, const std::optional<Pen>& pen) {
  std::string result = " fill=\"" + (fill ? hex_colour(fill->colour) : std::string("none")) + "\"";
  if (fill && fill->opacity < 1.0) result += attribute("fill-opacity", fill->opacity);
  if (pen) {
    result += " stroke=\"" + hex_colour(pen->colour) + "\"" + attribute("stroke-width", pen->width);
    if (pen->dash > 0.0) result += attribute("stroke-dasharray", pen->dash);
  }
  return result;
}

std::string drawn(const Figure::Path& path) {
  std::string points;
  for (const Eigen::Vector2d& p : path.points) {
    points += (points.empty() ? "" : " ") + figure_number(p.x()) + "," + figure_number(p.y());
  }
  return std::string(path.is_closed ? "<polygon" : "<polyline") + " points=\"" + points + "\"" +
         look(path.fill, path.pen) + "/>";
}

std::string drawn(const Figure::Circle& circle) {
  return "<circle" + attribute("cx", circle.centre.x()) + attribute("cy", circle.centre.y()) +
         attribute("r", circle.radius) + look(circle.fill, circle.pen) + "/>";
}

std::string drawn(const Figure::Text& text) {
  std::string result = "<text" + attribute("x", text.place.x()) + attribute("y", text.place.y()) +
                       attribute("font-size", text.look.size);
  if (text.look.align != Align::kLeft) {
    result +=
        text.look.align == Align::kCentre ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  }
  if (text.look.is_bold) result += " font-weight=\"bold\"";
  if (text.look.turn != 0.0) {
    result += " transform=\"rotate(" + figure_number(-text.look.turn) + " " +
              figure_number(text.place.x()) + " " + figure_number(text.place.y()) + ")\"";
  }
  return result + " fill=\"" + hex_colour(text.look.colour) + "\">" + html_escaped(text.text) +
         "</text>";
}

std::string drawn(const Figure::Picture& picture) {
  return "<image" + attribute("x", picture.corner.x()) + attribute("y", picture.corner.y()) +
         attribute("width", picture.size.x()) + attribute("height", picture.size.y()) +
         " preserveAspectRatio=\"none\" href=\"data:image/png;base64," +
         formats::base64(encode_png(*picture.image, PngEffort::kSmall)) + "\"/>";
}

}  // namespace

std::string to_svg(const Figure& figure) {
  const std::string width = figure_number(figure.width());
  const std::string height = figure_number(figure.height());
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " +
                    height + "\" width=\"" + width + "pt\" height=\"" + height +
                    "pt\" role=\"img\" aria-label=\"" + html_escaped(figure.title()) +
                    "\" font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" "
                    "stroke-linejoin=\"round\">\n";
  for (const Figure::Shape& shape : figure.shapes()) {
    svg += std::visit([](const auto& s) { return drawn(s); }, shape) + "\n";
  }
  return svg + "</svg>\n";
}

}  // namespace palmar::report
