// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/cad/solids/kind_makers.h"

namespace palmar::cad {

NamedSolid make_cylinder(const product::KindValues& v) {
  const double radius = 0.5 * v.at("diameter_mm");
  const double half = 0.5 * v.at("length_mm");
  const double fillet = v.at("end_fillet_mm");
  return put_first(revolve_section({{.at = {0.0, -half}, .edge_name = "bottom"},
                                    {.at = {radius, -half},
                                     .fillet = fillet,
                                     .fillet_name = "bottom fillet",
                                     .edge_name = "side"},
                                    {.at = {radius, half},
                                     .fillet = fillet,
                                     .fillet_name = "top fillet",
                                     .edge_name = "top"},
                                    {.at = {0.0, half}}}),
                   {"side", "bottom", "top"});
}

NamedSolid make_tapered_handle(const product::KindValues& v) {
  const double thick = 0.5 * v.at("diameter_mm");
  const double half = 0.5 * v.at("length_mm");
  const double taper = v.at("taper_deg") * std::numbers::pi / 180.0;
  const double thin = thick - 2.0 * half * std::tan(taper);
  const double fillet = v.at("end_fillet_mm");
  return revolve_section(
      {{.at = {0.0, -half}, .edge_name = "thick end"},
       {.at = {thick, -half}, .fillet = fillet, .fillet_name = "end fillet 1", .edge_name = "grip"},
       {.at = {thin, half},
        .fillet = fillet,
        .fillet_name = "end fillet 2",
        .edge_name = "thin end"},
       {.at = {0.0, half}}});
}

NamedSolid make_bottle(const product::KindValues& v) {
  const double capped_edge = 1.0;  // mm; what the mould of a cap rounds
  const double radius = 0.5 * v.at("diameter_mm");
  const double neck = 0.5 * v.at("neck_diameter_mm");
  const double cap = 0.5 * v.at("cap_diameter_mm");
  const double base = -0.5 * v.at("height_mm");
  const double top = -base;
  const double cap_base = top - v.at("cap_height_mm");
  const double neck_base = cap_base - v.at("neck_height_mm");
  const double shoulder = neck_base - v.at("shoulder_height_mm");
  const double straight = base + v.at("base_fillet_mm");
  const double waist = radius - v.at("waist_depth_mm");
  const double middle = 0.5 * (straight + shoulder);
  const double half_waist = 0.5 * v.at("waist_length_mm");

  std::vector<SectionCorner> section = {{.at = {0.0, base}, .edge_name = "base"},
                                        {.at = {radius, base},
                                         .fillet = v.at("base_fillet_mm"),
                                         .fillet_name = "base fillet",
                                         .edge_name = "body 1"}};
  const auto add = [&](const std::vector<SectionCorner>& more) {
    section.insert(section.end(), more.begin(), more.end());
  };
  if (waist < radius) {
    add(s_curve({radius, middle - half_waist}, {waist, middle}, "waist 1", "waist 2"));
    add(s_curve({waist, middle}, {radius, middle + half_waist}, "waist 3", "waist 4"));
    add({{.at = {radius, middle + half_waist}, .edge_name = "body 2"}});
  }
  add(s_curve({radius, shoulder}, {neck, neck_base}, "shoulder 1", "shoulder 2"));
  add({{.at = {neck, neck_base}, .edge_name = "neck"},
       {.at = {neck, cap_base}, .edge_name = "cap underside"},
       {.at = {cap, cap_base}, .edge_name = "cap"},
       {.at = {cap, top},
        .fillet = capped_edge,
        .fillet_name = "cap fillet",
        .edge_name = "cap top"},
       {.at = {0.0, top}}});
  return revolve_section(section);
}

NamedSolid make_bicycle_grip(const product::KindValues& v) {
  const double radius = 0.5 * v.at("diameter_mm");
  const double bore = 0.5 * v.at("bar_diameter_mm");
  const double half = 0.5 * v.at("length_mm");
  const double fillet = v.at("end_fillet_mm");
  const double flange = v.at("flange_mm");
  const double width = v.at("flange_width_mm");
  std::vector<SectionCorner> section = {{.at = {bore, -half}, .edge_name = "inner end"}};
  if (flange > 0.0) {
    const double edge = 0.4 * std::min(flange, width);  // its rim and its root, well rounded
    section.push_back({.at = {radius + flange, -half},
                       .fillet = edge,
                       .fillet_name = "flange fillet 1",
                       .edge_name = "flange rim"});
    section.push_back({.at = {radius + flange, width - half},
                       .fillet = edge,
                       .fillet_name = "flange fillet 2",
                       .edge_name = "flange"});
    section.push_back({.at = {radius, width - half},
                       .fillet = edge,
                       .fillet_name = "flange root",
                       .edge_name = "grip"});
  } else {
    section.push_back({.at = {radius, -half},
                       .fillet = fillet,
                       .fillet_name = "end fillet 1",
                       .edge_name = "grip"});
  }
  section.push_back({.at = {radius, half},
                     .fillet = fillet,
                     .fillet_name = "end fillet 2",
                     .edge_name = "outer end"});
  section.push_back({.at = {bore, half}, .edge_name = "bore"});
  return revolve_section(section);
}

}  // namespace palmar::cad
