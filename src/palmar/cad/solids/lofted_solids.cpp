// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "palmar/cad/solids/kind_makers.h"
#include "palmar/cad/solids/loft.h"

namespace palmar::cad {
namespace {

/// Superellipse's exponent: 2 is an ellipse, 5 nearly a rectangle.
double exponent_of(double squareness) { return 2.0 + 3.0 * squareness; }

/// Four faces around, each a quarter about its direction.
LoftBand four_sides(double begin, double end, const std::string& right, const std::string& back,
                    const std::string& left, const std::string& front) {
  return {begin, end, {0.125, 0.375, 0.625, 0.875}, {back, left, front, right}};
}

}  // namespace

NamedSolid make_knife_handle(const product::KindValues& v) {
  const double length = v.at("length_mm");
  const double fillet = v.at("end_fillet_mm");
  const double half_width = 0.5 * v.at("width_mm");
  const double half_depth = 0.5 * v.at("depth_mm");
  const double belly = v.at("belly_mm");
  const double guard = v.at("guard_mm");
  const double drop = v.at("pommel_drop_mm");
  const double p = exponent_of(v.at("squareness"));
  // Along the handle from the blade (0) to the butt (1), as seen from its side.
  const Undulation spine({{0.0, half_depth - 0.5 * belly},
                          {0.4, half_depth},
                          {1.0, half_depth - 0.5 * belly - 0.6 * drop}});
  const Undulation edge({{0.0, -half_depth - guard},
                         {0.2, -half_depth + belly},
                         {0.5, -half_depth},
                         {0.78, -half_depth + belly},
                         {1.0, -half_depth - drop}});
  const Undulation thick({{0.0, 0.88 * half_width}, {0.45, half_width}, {1.0, 0.94 * half_width}});
  const auto section = [&](double z, double turn) {
    const double s = z / length + 0.5;
    const double top = spine(s);
    const double low = edge(s);
    SectionPoint point = superellipse(thick(s), 0.5 * (top - low), p, turn);
    point[1] += 0.5 * (top + low);
    return point;
  };
  const double end = 0.5 * length - fillet;
  return make_loft(section, {.bottom = -0.5 * length,
                             .top = 0.5 * length,
                             .end_fillet = fillet,
                             .bands = {four_sides(-end, end, "right", "spine", "left", "belly")}});
}

NamedSolid make_pistol_grip(const product::KindValues& v) {
  const double height = v.at("height_mm");
  const double fillet = v.at("end_fillet_mm");
  const double half_width = 0.5 * v.at("width_mm");
  const double half_depth = 0.5 * v.at("depth_mm");
  const double swell = v.at("palm_swell_mm");
  const double tang = v.at("tang_mm");
  const double flare = v.at("flare_mm");
  const double p = exponent_of(v.at("squareness"));
  const double rake = std::tan(v.at("rake_deg") * std::numbers::pi / 180.0);
  // Up the grip from its foot (0) to the frame (1): the back in the palm, the front under the
  // fingers, and the sides.
  const Undulation back(
      {{0.0, half_depth}, {0.5, half_depth + swell}, {0.82, half_depth}, {1.0, half_depth + tang}});
  const Undulation front({{0.0, -half_depth - flare},
                          {0.22, -half_depth},
                          {0.55, -half_depth - 0.3 * swell},
                          {0.85, -half_depth + 0.3 * swell},
                          {1.0, -half_depth}});
  const Undulation side({{0.0, half_width},
                         {0.25, 0.92 * half_width},
                         {0.5, half_width},
                         {0.82, 0.88 * half_width},
                         {1.0, half_width}});
  const auto section = [&](double z, double turn) {
    const double s = z / height + 0.5;
    SectionPoint point = superellipse(side(s), 0.5 * (back(s) - front(s)), p, turn);
    point[1] += 0.5 * (back(s) + front(s)) - rake * z;  // the foot lies behind
    return point;
  };
  const double end = 0.5 * height - fillet;
  return make_loft(section, {.bottom = -0.5 * height,
                             .top = 0.5 * height,
                             .end_fillet = fillet,
                             .bands = {four_sides(-end, end, "right", "back", "left", "front")}});
}

NamedSolid make_screwdriver_handle(const product::KindValues& v) {
  const double length = v.at("length_mm");
  const double radius = 0.5 * v.at("diameter_mm");
  const double neck = 0.5 * v.at("neck_diameter_mm");
  const double collar = 0.5 * v.at("collar_diameter_mm");
  const double neck_length = v.at("neck_length_mm");
  const double fillet = v.at("end_fillet_mm");
  const int flutes = static_cast<int>(v.at("flutes"));
  const double depth = v.at("flute_depth_mm");
  const double bottom = -0.5 * length;
  const double grip = bottom + neck_length;
  const double end = 0.5 * length - fillet;
  const double run_out = std::min(12.0, 0.3 * (end - grip));  // of the flutes, at both ends
  const Undulation envelope(
      {{bottom, collar}, {bottom + 0.45 * neck_length, neck}, {grip, radius}});
  const Undulation fluted(
      {{grip, 0.0}, {grip + run_out, depth}, {end - run_out, depth}, {end, 0.0}});
  const auto section = [&](double z, double turn) {
    const double angle = 2.0 * std::numbers::pi * turn;
    // Lobes are centred on multiples of a full turn / flutes.
    const double r = envelope(z) - 0.5 * fluted(z) * (1.0 - std::cos(flutes * angle));
    return SectionPoint{r * std::cos(angle), r * std::sin(angle)};
  };
  LoftBand grip_band{grip, end, {}, {"grip"}};
  if (depth > 0.0) {
    grip_band.names.clear();
    for (int k = 0; k < flutes; ++k) {
      grip_band.splits.push_back((k + 0.25) / flutes);
      grip_band.splits.push_back((k + 0.75) / flutes);
      grip_band.names.push_back("flute " + std::to_string(k + 1));
      grip_band.names.push_back("lobe " + std::to_string((k + 1) % flutes + 1));
    }
  }
  return make_loft(section, {.bottom = bottom,
                             .top = 0.5 * length,
                             .end_fillet = fillet,
                             .columns = depth > 0.0 ? std::max(32, 6 * flutes) : 32,
                             .row_distance = std::min(5.0, neck_length / 7.0),
                             .bands = {{bottom + fillet, grip, {}, {"neck"}}, grip_band}});
}

}  // namespace palmar::cad
