// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "axisymmetric_deck.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

namespace palmar::fe {
namespace {

struct Point {
  double r = 0.0, z = 0.0;
};

/// From 0 to `end`: steps of `fine` up to `fine_end`, then growing by a seventh each.
std::vector<double> graded(double fine, double fine_end, double end) {
  std::vector<double> at = {0.0};
  double step = fine;
  while (at.back() < end - 1e-9) {
    if (at.back() > fine_end) step *= 8.0 / 7.0;
    at.push_back(at.back() + step);
  }
  const double scale = end / at.back();
  if (at.back() - end > 0.5 * step && at.size() > 2) {
    at.pop_back();
    const double stretch = end / at.back();
    for (double& v : at) v *= stretch;
    return at;
  }
  for (double& v : at) v *= scale;
  return at;
}

/// Rectangles of second order: columns x rows, mapped by `place`. Row 0 is the contact side.
class QuadGrid {
 public:
  QuadGrid(std::vector<double> across, std::vector<double> deep,
           const std::function<Point(double, double)>& place, int first_node, int first_element)
      : across_(std::move(across)), deep_(std::move(deep)), first_element_(first_element) {
    for (std::size_t j = 0; j + 1 < 2 * deep_.size(); ++j) {
      for (std::size_t i = 0; i + 1 < 2 * across_.size(); ++i) {
        if (i % 2 == 1 && j % 2 == 1) continue;
        id_[{i, j}] = first_node + static_cast<int>(id_.size());
        position_.push_back(place(half(across_, i), half(deep_, j)));
      }
    }
  }

  int node_count() const { return static_cast<int>(position_.size()); }
  int element_count() const { return static_cast<int>((across_.size() - 1) * (deep_.size() - 1)); }

  std::string nodes(const std::string& set) const {
    std::string text = "*NODE, NSET=" + set + "\n";
    std::size_t k = 0;
    for (std::size_t j = 0; j + 1 < 2 * deep_.size(); ++j) {
      for (std::size_t i = 0; i + 1 < 2 * across_.size(); ++i) {
        if (i % 2 == 1 && j % 2 == 1) continue;
        text +=
            fmt::format("{},{:.10g},{:.10g},0\n", id_.at({i, j}), position_[k].r, position_[k].z);
        ++k;
      }
    }
    return text;
  }

  /// `is_turned`: rows run upwards (the tool), so corners are listed the other way round.
  std::string elements(const std::string& set, bool is_turned) const {
    std::string text = "*ELEMENT, TYPE=CAX8R, ELSET=" + set + "\n";
    int element = first_element_;
    for (std::size_t j = 0; j + 1 < deep_.size(); ++j) {
      for (std::size_t i = 0; i + 1 < across_.size(); ++i) {
        const std::size_t x = 2 * i;
        const std::size_t y = 2 * j;
        const auto n = [&](std::size_t a, std::size_t b) { return id_.at({x + a, y + b}); };
        // Face 1 (nodes 1-2) of the tool and face 3 (nodes 3-4) of the tissue are the contact side.
        text += is_turned ? fmt::format("{},{},{},{},{},{},{},{},{}\n", element, n(0, 0), n(2, 0),
                                        n(2, 2), n(0, 2), n(1, 0), n(2, 1), n(1, 2), n(0, 1))
                          : fmt::format("{},{},{},{},{},{},{},{},{}\n", element, n(0, 2), n(2, 2),
                                        n(2, 0), n(0, 0), n(1, 2), n(2, 1), n(1, 0), n(0, 1));
        ++element;
      }
    }
    return text;
  }

  std::string contact_surface(const std::string& name, int face) const {
    std::string text = "*SURFACE, NAME=" + name + ", TYPE=ELEMENT\n";
    for (std::size_t i = 0; i + 1 < across_.size(); ++i) {
      text += fmt::format("{},S{}\n", first_element_ + static_cast<int>(i), face);
    }
    return text;
  }

  std::string last_row(const std::string& name) const { return set_of(name, 2 * deep_.size() - 2); }
  std::string axis(const std::string& name) const {
    std::string text = "*NSET, NSET=" + name + "\n";
    for (std::size_t j = 0; j + 1 < 2 * deep_.size(); ++j) {
      text += fmt::format("{}\n", id_.at({0, j}));
    }
    return text;
  }

 private:
  static double half(const std::vector<double>& at, std::size_t i) {
    return i % 2 == 0 ? at[i / 2] : 0.5 * (at[i / 2] + at[i / 2 + 1]);
  }
  std::string set_of(const std::string& name, std::size_t row) const {
    std::string text = "*NSET, NSET=" + name + "\n";
    for (std::size_t i = 0; i + 1 < 2 * across_.size(); ++i) {
      text += fmt::format("{}\n", id_.at({i, row}));
    }
    return text;
  }

  std::vector<double> across_, deep_;
  std::map<std::pair<std::size_t, std::size_t>, int> id_;
  std::vector<Point> position_;
  int first_element_;
};

double young(double shear_modulus, double poisson) { return 2.0 * shear_modulus * (1.0 + poisson); }

}  // namespace

std::string axisymmetric_deck(const SpherePress& press) {
  const double fine = press.fine_edge;
  const QuadGrid tissue(
      graded(fine, press.fine_radius, press.width), graded(fine, 0.0, press.layer),
      [](double across, double deep) {
        return Point{across, -deep};
      },
      1, 1);
  // The tool: a shell, one millimetre of steel or the coating.
  const double shell = press.coating.value_or(1.0);
  const double reach =
      press.is_flat ? press.width / 2.0 : std::min(0.9 * press.radius, 0.8 * press.width);
  const QuadGrid tool(
      graded(0.8 * fine, press.fine_radius, reach), graded(fine, 0.0, shell),
      [&](double across, double up) {
        if (press.is_flat) return Point{across, up};
        const double angle = across / press.radius;
        return Point{(press.radius - up) * std::sin(angle),
                     press.radius - (press.radius - up) * std::cos(angle)};
      },
      tissue.node_count() + 1, tissue.element_count() + 1);

  std::string text = "** Sphere on a bonded layer, axisymmetric. Units: mm, N, MPa\n";
  text += tissue.nodes("TISSUE") + tool.nodes("TOOL");
  text += tissue.elements("TISSUE", false) + tool.elements("TOOL", true);
  text += tissue.last_row("BASE") + tissue.axis("AXIS") + tool.axis("TOOLAXIS");
  text += tool.last_row("CORE");
  text += tissue.contact_surface("SKIN", 3) + tool.contact_surface("FACE", 1);
  const double e_tool =
      press.coating ? young(press.coating_shear_modulus, press.coating_poisson) : 210000.0;
  const double nu_tool = press.coating ? press.coating_poisson : 0.3;
  const double e_tissue = young(press.shear_modulus, press.poisson);
  text += fmt::format(
      "*MATERIAL, NAME=SOFT\n*ELASTIC\n{:.9g},{:.9g}\n*MATERIAL, NAME=COVER\n*ELASTIC\n"
      "{:.9g},{:.9g}\n*SOLID SECTION, ELSET=TISSUE, MATERIAL=SOFT\n"
      "*SOLID SECTION, ELSET=TOOL, MATERIAL=COVER\n",
      e_tissue, press.poisson, e_tool, nu_tool);
  text += fmt::format(
      "*SURFACE INTERACTION, NAME=SMOOTH\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{:.9g}\n"
      "*CONTACT PAIR, INTERACTION=SMOOTH, TYPE=SURFACE TO SURFACE\nSKIN,FACE\n"
      "*BOUNDARY\nBASE,1,2\nAXIS,1,1\n",
      300.0 * e_tissue);
  text += std::string("*NSET, NSET=INDENTER\n") + (press.coating ? "CORE" : "TOOL") + "\n";
  text += "*BOUNDARY\nINDENTER,1,1\n";
  if (press.coating) text += "TOOLAXIS,1,1\n";
  for (const double depth : press.depths) {
    text += fmt::format(
        "*STEP, INC=200\n*STATIC\n1,1,0.001,1\n*BOUNDARY\nINDENTER,2,2,{:.9g}\n"
        "*NODE PRINT, NSET=INDENTER, TOTALS=ONLY, FREQUENCY=1000\nRF\n"
        "*CONTACT PRINT, SLAVE=SKIN, MASTER=FACE, FREQUENCY=1000\nCF\n"
        "*NODE FILE, FREQUENCY=1000\nU\n*END STEP\n",
        -depth);
  }
  return text;
}

}  // namespace palmar::fe
