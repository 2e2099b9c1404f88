// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/product/parametric_kinds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/nearest_name.h"
#include "palmar/core/text.h"
#include "palmar/geometry/degrees.h"

namespace palmar::product {
namespace {

/// Bounds come from sums of what people type: 0.49 * 8 is no reason to refuse 3.92.
constexpr double kRounding = 1e-9;

std::string with_unit(double value, const std::string& parameter) {
  const std::string unit = unit_of_parameter(parameter);
  return significant(value, 6) + (unit.empty() ? "" : " " + unit);
}

KindRelation at_most(const std::string& parameter, const std::string& words,
                     std::function<double(const KindValues&)> bound) {
  return {parameter, true, std::move(bound), words};
}

KindRelation at_least(const std::string& parameter, const std::string& words,
                      std::function<double(const KindValues&)> bound) {
  return {parameter, false, std::move(bound), words};
}

/// At most a multiple of another one: "a quarter of", 0.25, "depth_mm".
KindRelation at_most(const std::string& parameter, const std::string& multiple, double factor,
                     const std::string& of) {
  return at_most(parameter, multiple + " " + of,
                 [factor, of](const KindValues& v) { return factor * v.at(of); });
}

double half_of_smaller(const KindValues& v, const char* a, const char* b) {
  return 0.5 * std::min(v.at(a), v.at(b));
}

ParametricKind cylinder() {
  return {"cylinder",
          "Round bar with flat ends",
          {{"diameter_mm", 48, 0.1, 10000, "of the bar"},
           {"length_mm", 150, 0.1, 10000, "from end to end"},
           {"end_fillet_mm", 0, 0, 5000, "radius of the edges of both ends; 0: sharp"}},
          {at_most(
              "end_fillet_mm", "half of the smaller of diameter_mm and length_mm",
              [](const KindValues& v) { return half_of_smaller(v, "diameter_mm", "length_mm"); })}};
}

ParametricKind elliptic_handle() {
  return {"elliptic_handle",
          "Bar with an elliptical section, as of a hammer",
          {{"width_mm", 28, 5, 200, "across the section, along x"},
           {"depth_mm", 38, 5, 200, "across the section, along y"},
           {"length_mm", 140, 20, 1000, "from end to end"},
           {"end_fillet_mm", 4, 0, 90, "radius of the edges of both ends; 0: sharp"}},
          {at_most("width_mm", "three times", 3.0, "depth_mm"),
           at_most("depth_mm", "three times", 3.0, "width_mm"),
           at_most("end_fillet_mm", "nine tenths of the ellipse's tightest radius",
                   [](const KindValues& v) {
                     const double small = std::min(v.at("width_mm"), v.at("depth_mm"));
                     const double large = std::max(v.at("width_mm"), v.at("depth_mm"));
                     return 0.9 * 0.5 * small * small / large;
                   }),
           at_most("end_fillet_mm", "0.45 of", 0.45, "length_mm")}};
}

double thin_end(const KindValues& v) {
  return v.at("diameter_mm") -
         2.0 * v.at("length_mm") * std::tan(v.at("taper_deg") * geometry::kDegree);
}

ParametricKind tapered_handle() {
  return {"tapered_handle",
          "Round handle that gets thinner towards its front",
          {{"diameter_mm", 38, 8, 200, "at the thick end, as if its edge were sharp"},
           {"length_mm", 130, 20, 1000, "from end to end"},
           {"taper_deg", 2.5, 0, 30, "between the side and the axis"},
           {"end_fillet_mm", 4, 0, 90, "radius of the edges of both ends; 0: sharp"}},
          {at_most("taper_deg", "the taper that leaves 5 mm at the thin end",
                   [](const KindValues& v) {
                     return std::atan(0.5 * (v.at("diameter_mm") - 5.0) / v.at("length_mm")) /
                            geometry::kDegree;
                   }),
           at_most("end_fillet_mm", "what both ends and the side have room for",
                   [](const KindValues& v) {
                     const double taper = v.at("taper_deg") * geometry::kDegree;
                     // Lengths that a fillet of radius 1 takes of cap and side.
                     const double thick = std::tan(0.5 * (0.5 * std::numbers::pi + taper));
                     const double thin = std::tan(0.5 * (0.5 * std::numbers::pi - taper));
                     const double side = v.at("length_mm") / std::cos(taper);
                     return 0.95 * std::min({0.5 * v.at("diameter_mm") / thick,
                                             0.5 * thin_end(v) / thin, side / (thick + thin)});
                   })}};
}

ParametricKind prism() {
  return {"prism",
          "Bar with a rectangular section and rounded edges",
          {{"width_mm", 40, 0.1, 10000, "across the section, along x"},
           {"depth_mm", 30, 0.1, 10000, "across the section, along y"},
           {"length_mm", 150, 0.1, 10000, "from end to end"},
           {"fillet_mm", 5, 0, 5000, "radius of the four long edges; 0: sharp"},
           {"end_fillet_mm", 0, 0, 5000, "radius of the edges of both ends; 0: sharp"}},
          {at_most("fillet_mm", "half of the smaller of width_mm and depth_mm",
                   [](const KindValues& v) { return half_of_smaller(v, "width_mm", "depth_mm"); }),
           at_most("end_fillet_mm", "nine tenths of fillet_mm, around which it must turn",
                   [](const KindValues& v) { return 0.9 * v.at("fillet_mm"); }),
           at_most("end_fillet_mm", "0.45 of", 0.45, "length_mm")}};
}

ParametricKind sphere() {
  return {"sphere", "Ball", {{"diameter_mm", 60, 0.1, 10000, "of the ball"}}, {}};
}

ParametricKind ellipsoid() {
  return {"ellipsoid",
          "Egg with three axes",
          {{"x_mm", 50, 0.1, 10000, "diameter along x"},
           {"y_mm", 60, 0.1, 10000, "diameter along y"},
           {"z_mm", 120, 0.1, 10000, "diameter along z"}},
          {}};
}

double body_of_bottle(const KindValues& v) {
  return v.at("height_mm") - v.at("cap_height_mm") - v.at("neck_height_mm") -
         v.at("shoulder_height_mm");
}

ParametricKind bottle() {
  return {"bottle",
          "Drinking bottle, full, with its cap on; narrower at a waist",
          {{"diameter_mm", 66, 20, 200, "of the body"},
           {"height_mm", 220, 50, 600, "from the base to the top of the cap"},
           {"base_fillet_mm", 6, 0.5, 50, "radius of the edge of the base"},
           {"waist_depth_mm", 3, 0, 40, "how deep the waist is; 0: none"},
           {"waist_length_mm", 90, 5, 500, "of the waist, along the body"},
           {"shoulder_height_mm", 55, 4, 300, "from the body to the neck"},
           {"neck_diameter_mm", 27, 8, 150, "between shoulder and cap"},
           {"neck_height_mm", 12, 2, 200, "between shoulder and cap"},
           {"cap_diameter_mm", 31, 8, 160, "of the cap"},
           {"cap_height_mm", 18, 4, 100, "of the cap"}},
          {at_most("neck_diameter_mm", "diameter_mm less 4 mm",
                   [](const KindValues& v) { return v.at("diameter_mm") - 4.0; }),
           at_least("cap_diameter_mm", "neck_diameter_mm and 1 mm",
                    [](const KindValues& v) { return v.at("neck_diameter_mm") + 1.0; }),
           at_most("cap_diameter_mm", "neck_diameter_mm and 40 mm",
                   [](const KindValues& v) { return v.at("neck_diameter_mm") + 40.0; }),
           at_least("shoulder_height_mm", "half of what diameter_mm is above neck_diameter_mm",
                    [](const KindValues& v) {
                      return 0.5 * (v.at("diameter_mm") - v.at("neck_diameter_mm"));
                    }),
           at_most("base_fillet_mm", "a quarter of", 0.25, "diameter_mm"),
           at_least("height_mm", "cap, neck, shoulder and 20 mm above base_fillet_mm",
                    [](const KindValues& v) {
                      return v.at("height_mm") - body_of_bottle(v) + v.at("base_fillet_mm") + 20.0;
                    }),
           at_most("waist_length_mm", "the height of the body above its base_fillet_mm, less 1 mm",
                   [](const KindValues& v) {
                     return body_of_bottle(v) - v.at("base_fillet_mm") - 1.0;
                   }),
           at_most("waist_depth_mm", "a quarter of", 0.25, "waist_length_mm"),
           at_most("waist_depth_mm", "a quarter of", 0.25, "diameter_mm")}};
}

ParametricKind bicycle_grip() {
  return {"bicycle_grip",
          "Grip of a handlebar: a tube with the bar's bore, at will with a flange at its inner end",
          {{"diameter_mm", 32, 22, 60, "outside"},
           {"length_mm", 136, 40, 300, "from end to end"},
           {"bar_diameter_mm", 22, 12, 40, "of the bore"},
           {"end_fillet_mm", 2, 0, 15, "radius of the outer edges of both ends; 0: sharp"},
           {"flange_mm", 0, 0, 25, "how far the flange projects; 0: none"},
           {"flange_width_mm", 5, 2, 20, "of the flange, along the grip"}},
          {at_most("bar_diameter_mm", "diameter_mm less 3 mm",
                   [](const KindValues& v) { return v.at("diameter_mm") - 3.0; }),
           at_most("end_fillet_mm", "0.9 of the wall's thickness", [](const KindValues& v) {
             return 0.45 * (v.at("diameter_mm") - v.at("bar_diameter_mm"));
           })}};
}

ParametricKind phone() {
  return {"phone",
          "Slab with rounded corners and edges",
          {{"width_mm", 72, 30, 300, "along x"},
           {"thickness_mm", 8, 3, 50, "along y, from screen to back"},
           {"height_mm", 148, 60, 400, "along z"},
           {"corner_mm", 12, 1, 100, "radius of the four corners"},
           {"fillet_mm", 3, 0, 24, "radius of the edges around screen and back; 0: sharp"}},
          {at_most("corner_mm", "0.49 of the smaller of width_mm and height_mm",
                   [](const KindValues& v) {
                     return 0.98 * half_of_smaller(v, "width_mm", "height_mm");
                   }),
           at_most("fillet_mm", "0.49 of", 0.49, "thickness_mm"),
           at_most("fillet_mm", "nine tenths of corner_mm, around which it must turn",
                   [](const KindValues& v) { return 0.9 * v.at("corner_mm"); })}};
}

ParametricKind pistol_grip() {
  return {
      "pistol_grip",
      "Raked grip as of a pistol, a drill or a spray gun, from its foot to the frame above; held "
      "with the web of the thumb under the tang",
      {{"width_mm", 32, 15, 70, "from side to side, along x"},
       {"depth_mm", 46, 20, 90, "from the fingers to the palm, along y"},
       {"height_mm", 105, 50, 250, "from the foot to the frame, along z"},
       {"rake_deg", 18, 0, 40, "by which the foot is behind"},
       {"palm_swell_mm", 4, 0, 15, "by which the back bulges into the palm"},
       {"tang_mm", 9, 0, 25, "by which the back runs out over the web of the thumb"},
       {"flare_mm", 5, 0, 20, "by which the foot runs out under the little finger"},
       {"squareness", 0.3, 0, 1, "of the section: 0 is an ellipse, 1 nearly a rectangle"},
       {"end_fillet_mm", 2.5, 0, 10, "radius of the edges of foot and frame; 0: sharp"}},
      {at_most("palm_swell_mm", "a quarter of", 0.25, "depth_mm"),
       at_most("tang_mm", "0.4 of", 0.4, "depth_mm"),
       at_most("flare_mm", "0.4 of", 0.4, "depth_mm"),
       at_most("depth_mm", "2.5 times", 2.5, "width_mm"),
       at_most("width_mm", "depth_mm", [](const KindValues& v) { return v.at("depth_mm"); }),
       at_most("end_fillet_mm", "a tenth of", 0.1, "width_mm")},
      [](const KindValues& v) {
        const double rake = v.at("rake_deg") * geometry::kDegree;
        return Vec3(0.0, -std::sin(rake), std::cos(rake));
      }};
}

ParametricKind knife_handle() {
  return {"knife_handle",
          "Handle of a kitchen or hunting knife: blade below z, butt above, spine to the back",
          {{"length_mm", 118, 60, 250, "from the blade to the butt, along z"},
           {"depth_mm", 26, 12, 60, "from spine to belly at its fullest, along y"},
           {"width_mm", 20, 8, 50, "from side to side, along x"},
           {"belly_mm", 2.5, 0, 12, "by which the handle is narrower around its belly"},
           {"guard_mm", 3, 0, 20, "by which it runs out before the forefinger"},
           {"pommel_drop_mm", 6, 0, 25, "by which the butt runs out behind the little finger"},
           {"squareness", 0.45, 0, 1, "of the section: 0 is an ellipse, 1 nearly a rectangle"},
           {"end_fillet_mm", 1.5, 0, 8, "radius of the edges of both ends; 0: sharp"}},
          {at_most("belly_mm", "0.2 of", 0.2, "depth_mm"),
           at_most("guard_mm", "0.4 of", 0.4, "depth_mm"),
           at_most("pommel_drop_mm", "half of", 0.5, "depth_mm"),
           at_most("width_mm", "depth_mm", [](const KindValues& v) { return v.at("depth_mm"); }),
           at_least("width_mm", "a third of depth_mm",
                    [](const KindValues& v) { return v.at("depth_mm") / 3.0; }),
           at_most("end_fillet_mm", "a tenth of", 0.1, "width_mm")}};
}

ParametricKind screwdriver_handle() {
  return {"screwdriver_handle",
          "Handle of a screwdriver with flutes between lobes; the blade's side is below z",
          {{"diameter_mm", 33, 14, 70, "over the lobes"},
           {"length_mm", 108, 50, 250, "from the collar to the cap"},
           {"flutes", 6, 3, 12, "flutes, and lobes between them", true},
           {"flute_depth_mm", 2, 0, 10, "from the lobes to the flutes; 0: round"},
           {"neck_diameter_mm", 19, 8, 60, "of the neck, where it is thinnest"},
           {"neck_length_mm", 36, 10, 120, "from the collar to where the grip begins"},
           {"collar_diameter_mm", 23, 8, 70, "at the blade's end"},
           {"end_fillet_mm", 6, 0, 25, "radius of the edges of collar and cap"}},
          {at_most("neck_diameter_mm", "diameter_mm",
                   [](const KindValues& v) { return v.at("diameter_mm"); }),
           at_most("collar_diameter_mm", "diameter_mm",
                   [](const KindValues& v) { return v.at("diameter_mm"); }),
           at_least("collar_diameter_mm", "neck_diameter_mm",
                    [](const KindValues& v) { return v.at("neck_diameter_mm"); }),
           at_least("neck_length_mm", "1.4 times what collar_diameter_mm is above the neck",
                    [](const KindValues& v) {
                      return 1.4 * (v.at("collar_diameter_mm") - v.at("neck_diameter_mm"));
                    }),
           at_least("neck_length_mm", "1.15 times what diameter_mm is above the neck",
                    [](const KindValues& v) {
                      return 1.15 * (v.at("diameter_mm") - v.at("neck_diameter_mm"));
                    }),
           at_most("neck_length_mm", "half of", 0.5, "length_mm"),
           at_most("flute_depth_mm", "0.2 of", 0.2, "diameter_mm"),
           at_most("flute_depth_mm", "0.7 of diameter_mm / flutes",
                   [](const KindValues& v) { return 0.7 * v.at("diameter_mm") / v.at("flutes"); }),
           at_most("end_fillet_mm", "0.3 of", 0.3, "collar_diameter_mm"),
           at_most("end_fillet_mm", "0.3 of", 0.3, "neck_length_mm")}};
}

const KindParameter* find_parameter(const ParametricKind& kind, const std::string& name) {
  const auto found = std::find_if(kind.parameters.begin(), kind.parameters.end(),
                                  [&](const KindParameter& one) { return one.name == name; });
  return found == kind.parameters.end() ? nullptr : &*found;
}

[[noreturn]] void refuse_parameter(const ParametricKind& kind, const std::string& name) {
  std::vector<std::string> names;
  for (const KindParameter& one : kind.parameters) names.push_back(one.name);
  const std::string nearest = nearest_name(name, names);
  throw UsageError(kind.name + " has no parameter \"" + name + "\"" +
                   (nearest.empty() ? "; it has " : "; did you mean " + nearest + "? It has ") +
                   joined(names, ", "));
}

void check_range(const ParametricKind& kind, const KindParameter& parameter, double value) {
  const bool is_inside = value >= parameter.lowest && value <= parameter.highest;
  if (is_inside && (!parameter.is_whole || value == std::floor(value))) return;
  throw UsageError(kind.name + ": " + parameter.name + " is " + with_unit(value, parameter.name) +
                   "; " + (parameter.is_whole ? "a whole number from " : "") +
                   significant(parameter.lowest, 6) + " to " +
                   with_unit(parameter.highest, parameter.name) + " is allowed");
}

void check_relation(const ParametricKind& kind, const KindRelation& relation,
                    const KindValues& values) {
  const double value = values.at(relation.parameter);
  const double bound = relation.bound(values);
  const double slack = kRounding * (1.0 + std::abs(bound));
  if (relation.is_highest ? value <= bound + slack : value >= bound - slack) return;
  throw UsageError(kind.name + ": " + relation.parameter + " is " +
                   with_unit(value, relation.parameter) + "; " +
                   (relation.is_highest ? "at most " : "at least ") +
                   with_unit(bound, relation.parameter) + " is allowed (" + relation.words + ")");
}

}  // namespace

const std::vector<ParametricKind>& parametric_kinds() {
  static const std::vector<ParametricKind> kinds = {
      cylinder(),     elliptic_handle(),    tapered_handle(), prism(),
      bottle(),       bicycle_grip(),       pistol_grip(),    phone(),
      knife_handle(), screwdriver_handle(), sphere(),         ellipsoid()};
  return kinds;
}

std::vector<std::string> parametric_kind_names() {
  std::vector<std::string> names;
  for (const ParametricKind& kind : parametric_kinds()) names.push_back(kind.name);
  return names;
}

const ParametricKind& parametric_kind(const std::string& name) {
  for (const ParametricKind& kind : parametric_kinds()) {
    if (kind.name == name) return kind;
  }
  const std::vector<std::string> names = parametric_kind_names();
  const std::string nearest = nearest_name(name, names);
  throw UsageError(
      "kind \"" + name + "\" isn't known" +
      (nearest.empty() ? "; there are " : "; did you mean " + nearest + "? There are ") +
      joined(names, ", "));
}

std::string unit_of_parameter(const std::string& parameter) {
  const std::size_t underscore = parameter.rfind('_');
  const std::string last = underscore == std::string::npos ? "" : parameter.substr(underscore + 1);
  return last == "mm" || last == "deg" ? last : "";
}

KindValues complete_values(const ParametricKind& kind,
                           const std::vector<std::pair<std::string, double>>& given) {
  KindValues values;
  for (const auto& [name, value] : given) {
    const KindParameter* const parameter = find_parameter(kind, name);
    if (parameter == nullptr) refuse_parameter(kind, name);
    if (!values.emplace(name, value).second) {
      throw UsageError(kind.name + ": " + name + " is given twice");
    }
    check_range(kind, *parameter, value);
  }
  for (const KindParameter& one : kind.parameters) values.emplace(one.name, one.fallback);
  for (const KindRelation& relation : kind.relations) check_relation(kind, relation, values);
  return values;
}

}  // namespace palmar::product
