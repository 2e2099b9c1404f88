// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/formats/figure/drawing_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "palmar/core/error.h"
#include "palmar/formats/text_scan.h"

namespace palmar::formats {
namespace {

void check(const Drawing& drawing) {
  const int layers = static_cast<int>(drawing.layers.size());
  const auto check_layer = [&](int layer) {
    if (layer >= 0 && layer < layers) return;
    throw UsageError(fmt::format("drawing: layer {}; it has {}", layer, layers));
  };
  for (const DrawingLine& line : drawing.lines) {
    check_layer(line.layer);
    for (const Eigen::Vector2d& p : line.points) {
      if (!p.allFinite()) throw UsageError("drawing: a point of a line is not finite");
    }
  }
  for (const DrawingText& text : drawing.texts) check_layer(text.layer);
}

/// What Release 12 allows as a name: capitals, digits, - and _; at most 31.
std::string layer_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 && byte < 0xC0) continue;  // the rest of a character of several bytes
    result += byte < 0x80 && (std::isalnum(byte) != 0 || c == '-')
                  ? static_cast<char>(std::toupper(byte))
                  : '_';
  }
  return result.empty() ? "0" : result.substr(0, 31);
}

/// Release 12 knows no UTF-8.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 && byte < 0xC0) continue;
    result += byte < 0x20 || byte >= 0x80 ? '?' : c;
  }
  return result;
}

void pair(std::string& out, int code, const std::string& value) {
  out += fmt::format("{:>3}\n{}\n", code, value);
}
void pair(std::string& out, int code, int value) { pair(out, code, std::to_string(value)); }
void pair(std::string& out, int code, double value) {
  pair(out, code, fmt::format("{:.6f}", value));
}

void point(std::string& out, const Eigen::Vector2d& p) {
  pair(out, 10, p.x());
  pair(out, 20, p.y());
  pair(out, 30, 0.0);
}

struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high = -low;
};

Extent extent_of(const Drawing& drawing) {
  Extent extent;
  const auto add = [&](const Eigen::Vector2d& p) {
    extent.low = extent.low.cwiseMin(p);
    extent.high = extent.high.cwiseMax(p);
  };
  for (const DrawingLine& line : drawing.lines) {
    for (const Eigen::Vector2d& p : line.points) add(p);
  }
  for (const DrawingText& text : drawing.texts) {
    add(text.at);
    // About the width of a sans serif.
    add(text.at + Eigen::Vector2d(0.75 * text.height * static_cast<double>(text.text.size()),
                                  1.2 * text.height));
  }
  if (!extent.low.allFinite()) extent = {Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
  return extent;
}

}  // namespace

std::string dxf_of(const Drawing& drawing) {
  check(drawing);
  const Extent extent = extent_of(drawing);
  std::string out;
  pair(out, 999, plain(drawing.title) + " (millimetres)");
  pair(out, 0, std::string("SECTION"));
  pair(out, 2, std::string("HEADER"));
  pair(out, 9, std::string("$ACADVER"));
  pair(out, 1, std::string("AC1009"));
  pair(out, 9, std::string("$EXTMIN"));
  point(out, extent.low);
  pair(out, 9, std::string("$EXTMAX"));
  point(out, extent.high);
  pair(out, 0, std::string("ENDSEC"));
  pair(out, 0, std::string("SECTION"));
  pair(out, 2, std::string("TABLES"));
  pair(out, 0, std::string("TABLE"));
  pair(out, 2, std::string("LTYPE"));
  pair(out, 70, 2);
  for (const bool is_dashed : {false, true}) {
    pair(out, 0, std::string("LTYPE"));
    pair(out, 2, std::string(is_dashed ? "DASHED" : "CONTINUOUS"));
    pair(out, 70, 0);
    pair(out, 3, std::string(is_dashed ? "__ __ __" : "Solid line"));
    pair(out, 72, 65);
    pair(out, 73, is_dashed ? 2 : 0);
    pair(out, 40, is_dashed ? 6.0 : 0.0);
    if (is_dashed) {
      pair(out, 49, 4.0);
      pair(out, 49, -2.0);
    }
  }
  pair(out, 0, std::string("ENDTAB"));
  pair(out, 0, std::string("TABLE"));
  pair(out, 2, std::string("LAYER"));
  pair(out, 70, static_cast<int>(drawing.layers.size()));
  for (const DrawingLayer& layer : drawing.layers) {
    pair(out, 0, std::string("LAYER"));
    pair(out, 2, layer_name(layer.name));
    pair(out, 70, 0);
    pair(out, 62, layer.dxf_colour);
    pair(out, 6, std::string(layer.is_dashed ? "DASHED" : "CONTINUOUS"));
  }
  pair(out, 0, std::string("ENDTAB"));
  pair(out, 0, std::string("ENDSEC"));
  pair(out, 0, std::string("SECTION"));
  pair(out, 2, std::string("ENTITIES"));
  for (const DrawingLine& line : drawing.lines) {
    const std::string layer = layer_name(drawing.layers[static_cast<std::size_t>(line.layer)].name);
    pair(out, 0, std::string("POLYLINE"));
    pair(out, 8, layer);
    pair(out, 66, 1);
    point(out, Eigen::Vector2d::Zero());
    pair(out, 70, line.is_closed ? 1 : 0);
    for (const Eigen::Vector2d& p : line.points) {
      pair(out, 0, std::string("VERTEX"));
      pair(out, 8, layer);
      point(out, p);
    }
    pair(out, 0, std::string("SEQEND"));
    pair(out, 8, layer);
  }
  for (const DrawingText& text : drawing.texts) {
    pair(out, 0, std::string("TEXT"));
    pair(out, 8, layer_name(drawing.layers[static_cast<std::size_t>(text.layer)].name));
    point(out, text.at);
    pair(out, 40, text.height);
    pair(out, 1, plain(text.text));
  }
  pair(out, 0, std::string("ENDSEC"));
  pair(out, 0, std::string("EOF"));
  return out;
}

std::string svg_of(const Drawing& drawing) {
  check(drawing);
  constexpr double kBorder = 5.0;  // mm of paper around
  const Extent extent = extent_of(drawing);
  const Eigen::Vector2d size = extent.high - extent.low + Eigen::Vector2d::Constant(2.0 * kBorder);
  const auto place = [&](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(p.x() - extent.low.x() + kBorder, extent.high.y() - p.y() + kBorder);
  };
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
      "version=\"1.1\" width=\"{0:.3f}mm\" height=\"{1:.3f}mm\" viewBox=\"0 0 {0:.3f} {1:.3f}\">\n"
      "<title>{2}</title>\n<rect width=\"{0:.3f}\" height=\"{1:.3f}\" fill=\"#fff\"/>\n",
      size.x(), size.y(), xml_escaped(drawing.title));
  for (const DrawingLine& line : drawing.lines) {
    const DrawingLayer& layer = drawing.layers[static_cast<std::size_t>(line.layer)];
    out += fmt::format(
        "<{} fill=\"none\" stroke=\"#{:02x}{:02x}{:02x}\" stroke-width=\"{:.3g}\"{} "
        "points=\"",
        line.is_closed ? "polygon" : "polyline", layer.colour[0], layer.colour[1], layer.colour[2],
        layer.width, layer.is_dashed ? " stroke-dasharray=\"4 2\"" : "");
    for (const Eigen::Vector2d& p : line.points) {
      out += fmt::format("{:.4f},{:.4f} ", place(p).x(), place(p).y());
    }
    out += fmt::format("\"><title>{}</title></{}>\n", xml_escaped(layer.name),
                       line.is_closed ? "polygon" : "polyline");
  }
  for (const DrawingText& text : drawing.texts) {
    const DrawingLayer& layer = drawing.layers[static_cast<std::size_t>(text.layer)];
    out += fmt::format(
        "<text x=\"{:.3f}\" y=\"{:.3f}\" font-family=\"sans-serif\" font-size=\"{:.3f}\" "
        "fill=\"#{:02x}{:02x}{:02x}\">{}</text>\n",
        place(text.at).x(), place(text.at).y(), text.height / 0.72, layer.colour[0],
        layer.colour[1], layer.colour[2], xml_escaped(text.text));
  }
  return out + "</svg>\n";
}

}  // namespace palmar::formats
