// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// PDF 1.4 (ISO 32000-1): one page, one content stream, the standard fonts Helvetica and Helvetica
// Bold.
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/report/chart/figure.h"
#include "palmar/report/chart/figure_number.h"
#include "palmar/report/chart/helvetica.h"

namespace palmar::report {
namespace {

using Eigen::Vector2d;

std::string deflated(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                9) != Z_OK) {
    throw Error("PDF: compression failed");
  }
  result.resize(size);
  return result;
}

std::string stream(const std::string& entries, std::string_view bytes) {
  const std::string packed = deflated(bytes);
  return "<< " + entries + "/Filter /FlateDecode /Length " + std::to_string(packed.size()) +
         " >>\nstream\n" + packed + "\nendstream";
}

std::string text_string(std::string_view utf8) {
  std::string result = "(";
  for (const char c : win_ansi(utf8)) {
    if (c == '(' || c == ')' || c == '\\') result += '\\';
    result += c;
  }
  return result + ")";
}

class Page {
 public:
  explicit Page(const Figure& figure) : height_(figure.height()) {}

  void draw(const Figure::Path& path) {
    const char* step = " m\n";
    std::string outline;
    for (const Vector2d& p : path.points) {
      outline += point(p) + step;
      step = " l\n";
    }
    paint(outline, path.is_closed, path.fill, path.pen);
  }

  void draw(const Figure::Circle& circle) {
    // Four Bezier quarters; 0.5523 meets the circle to 0.03 % of its radius.
    constexpr double kHandle = 0.5522847498;
    const double r = circle.radius;
    const auto at = [&](double x, double y) {
      return point(Vector2d(circle.centre.x() + r * x, circle.centre.y() + r * y));
    };
    std::string outline = at(1, 0) + " m\n";
    const std::array<std::array<double, 2>, 5> corner{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}}};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto& a = corner[i];
      const auto& b = corner[i + 1];
      outline += at(a[0] + kHandle * b[0], a[1] + kHandle * b[1]) + " " +
                 at(b[0] + kHandle * a[0], b[1] + kHandle * a[1]) + " " + at(b[0], b[1]) + " c\n";
    }
    paint(outline, true, circle.fill, circle.pen);
  }

  void draw(const Figure::Text& text) {
    const double width = text_width(text.text, text.look);
    const double shift = text.look.align == Align::kLeft     ? 0.0
                         : text.look.align == Align::kCentre ? -0.5 * width
                                                             : -width;
    const double angle = text.look.turn * std::numbers::pi / 180.0;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    content_ += "BT /" + std::string(text.look.is_bold ? "B " : "R ") +
                figure_number(text.look.size) + " Tf " + colour(text.look.colour) + " rg " +
                precise(c) + " " + precise(s) + " " + precise(-s) + " " + precise(c) + " " +
                figure_number(text.place.x() + c * shift) + " " +
                figure_number(height_ - text.place.y() + s * shift) + " Tm " +
                text_string(text.text) + " Tj ET\n";
  }

  void draw(const Figure::Picture& picture) {
    const std::string name = "I" + std::to_string(pictures_.size());
    std::string pixels;
    for (const Rgb& p : picture.image->pixels) {
      pixels += {static_cast<char>(p.r), static_cast<char>(p.g), static_cast<char>(p.b)};
    }
    pictures_.push_back(stream("/Type /XObject /Subtype /Image /Width " +
                                   std::to_string(picture.image->width) + " /Height " +
                                   std::to_string(picture.image->height) +
                                   " /ColorSpace /DeviceRGB /BitsPerComponent 8 ",
                               pixels));
    content_ += "q " + figure_number(picture.size.x()) + " 0 0 " + figure_number(picture.size.y()) +
                " " + figure_number(picture.corner.x()) + " " +
                figure_number(height_ - picture.corner.y() - picture.size.y()) + " cm /" + name +
                " Do Q\n";
  }

  const std::string& content() const { return content_; }
  const std::vector<std::string>& pictures() const { return pictures_; }
  const std::map<std::string, std::string>& opacities() const { return opacities_; }

 private:
  std::string point(const Vector2d& p) const {
    return figure_number(p.x()) + " " + figure_number(height_ - p.y());
  }
  static std::string precise(double value) {
    const double whole = std::round(value);
    if (std::abs(value - whole) < 1e-12) return figure_number(whole);
    const std::string digits = std::to_string(std::llround(std::abs(value) * 1e6));
    return std::string(value < 0.0 ? "-" : "") + "0." + std::string(6 - digits.size(), '0') +
           digits;
  }
  static std::string colour(Rgb c) {
    const auto part = [](std::uint8_t v) { return precise(v / 255.0); };
    return part(c.r) + " " + part(c.g) + " " + part(c.b);
  }

  void paint(const std::string& outline, bool is_closed, const std::optional<Fill>& fill,
             const std::optional<Pen>& pen) {
    const bool is_filled = is_closed && fill.has_value();
    if (!is_filled && !pen) return;
    content_ += "q\n";
    if (is_filled) {
      content_ += colour(fill->colour) + " rg\n";
      if (fill->opacity < 1.0) {
        const std::string value = figure_number(fill->opacity);
        const auto [found, is_new] =
            opacities_.emplace(value, "G" + std::to_string(opacities_.size()));
        content_ += "/" + found->second + " gs\n";
      }
    }
    if (pen) {
      content_ += colour(pen->colour) + " RG " + figure_number(pen->width) + " w 1 j\n";
      if (pen->dash > 0.0) content_ += "[" + figure_number(pen->dash) + "] 0 d\n";
    }
    content_ += outline;
    if (is_closed) content_ += "h ";
    content_ += is_filled ? (pen ? "B" : "f") : "S";
    content_ += "\nQ\n";
  }

  double height_;
  std::string content_;
  std::vector<std::string> pictures_;
  std::map<std::string, std::string> opacities_;  // value -> name of its graphics state
};

}  // namespace

std::string to_pdf(const Figure& figure) {
  Page page(figure);
  for (const Figure::Shape& shape : figure.shapes()) {
    std::visit([&](const auto& s) { page.draw(s); }, shape);
  }
  std::string states;
  for (const auto& [value, name] : page.opacities()) {
    states += "/" + name + " << /ca " + value + " >> ";
  }
  std::string pictures;
  for (std::size_t i = 0; i < page.pictures().size(); ++i) {
    pictures += "/I" + std::to_string(i) + " " + std::to_string(8 + i) + " 0 R ";
  }
  const auto font = [](const char* name) {
    return std::string("<< /Type /Font /Subtype /Type1 /BaseFont /") + name +
           " /Encoding /WinAnsiEncoding >>";
  };
  std::vector<std::string> objects = {
      "<< /Type /Catalog /Pages 2 0 R >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + figure_number(figure.width()) + " " +
          figure_number(figure.height()) +
          "] /Contents 6 0 R /Resources << /Font << /R 4 0 R /B 5 0 R >> /ExtGState << " + states +
          ">> /XObject << " + pictures + ">> >> >>",
      font("Helvetica"),
      font("Helvetica-Bold"),
      stream("", page.content()),
      "<< /Title " + text_string(figure.title()) + " /Producer (Palmar) >>"};
  objects.insert(objects.end(), page.pictures().begin(), page.pictures().end());

  std::string pdf = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
  std::string table;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    std::array<char, 32> entry{};
    std::snprintf(entry.data(), entry.size(), "%010zu 00000 n \n", pdf.size());
    table += entry.data();
    pdf += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
  }
  const std::string count = std::to_string(objects.size() + 1);
  const std::string start = std::to_string(pdf.size());
  return pdf + "xref\n0 " + count + "\n0000000000 65535 f \n" + table + "trailer\n<< /Size " +
         count + " /Root 1 0 R /Info 7 0 R >>\nstartxref\n" + start + "\n%%EOF\n";
}

}  // namespace palmar::report
