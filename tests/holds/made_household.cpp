// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Sizes are those of ordinary things in shops, unless a source is named; mm.
#include <cmath>
#include <numbers>

#include "made_products.h"

namespace palmar::tests {
namespace {

// Cast pan 240 mm wide at the rim and 45 mm high, walls of 5 mm; a bar of 24 x 16 mm rises from the
// wall on +x and ends 200 mm from the rim.
MadeShape frying_pan() {
  const product::Sdf bowl = sdf_lathe({{0, 0}, {95, 0}, {120, 45}, {115, 45}, {91, 5}, {0, 5}});
  // Stretched: 24 mm wide (y), 16 mm thick.
  const product::Sdf handle =
      sdf_stretched(sdf_bar(curve_through({{113, 0, 32}, {150, 0, 44}, {230, 0, 60}, {312, 0, 66}}),
                            std::vector<double>(25, 8.0)),
                    1, 1.5);
  return {
      "frying_pan",
      product::sdf_union(bowl, handle),
      {Box3(Vec3(-121, -121, 0), Vec3(321, 121, 75)), Vec3(3.1, 3.1, 3.0), {{1, -14, 14, 2.6}}}};
}

// Kettle of 2.5 l, full and shut: 200 mm wide, 130 mm high without the bail. The bail stands over
// it in the plane of the spout (+x); its grip is 20 mm thick, level for 90 mm, 45 mm above the
// lid's knob.
MadeShape kettle() {
  const product::Sdf body = sdf_lathe(
      {{0, 0}, {92, 0}, {100, 15}, {99, 45}, {88, 80}, {60, 118}, {38, 128}, {0, 132}}, 2.0);
  const product::Sdf knob = sdf_bar({{0, 0, 128}, {0, 0, 146}}, {8, 13});
  const product::Sdf spout = sdf_bar({{80, 0, 50}, {125, 0, 85}, {152, 0, 124}}, {20, 14, 10});
  const std::vector<Vec3> line = curve_through({{-72, 0, 104},
                                                {-84, 0, 160},
                                                {-45, 0, 214},
                                                {0, 0, 216},
                                                {45, 0, 214},
                                                {84, 0, 160},
                                                {72, 0, 104}});
  std::vector<double> radius;
  for (const Vec3& p : line) radius.push_back(p.z() > 200.0 ? 10.0 : 6.0);
  return {"kettle",
          product::sdf_union(sdf_blended(body, spout, 8.0),
                             product::sdf_union(knob, sdf_bar(line, radius))),
          {Box3(Vec3(-103, -103, -3), Vec3(164, 103, 228)),
           Vec3(5, 5, 5),
           {{1, -14, 14, 3.0}, {2, 125, 230, 3.5}}}};
}

// Pitcher of 1.5 l: earthenware walls of 6 mm, 120 mm wide, 220 mm high, a lip on -x. The handle on
// +x is a strap 26 mm wide and 14 mm thick; fingers have 40 mm between it and the wall.
MadeShape jug() {
  const auto wall = [](double inwards, double floor, double top) {
    return sdf_lathe({{0, floor},
                      {50 - inwards, floor},
                      {60 - inwards, 70},
                      {55 - inwards, 130},
                      {46 - inwards, 175},
                      {54 - inwards, top},
                      {0, top}});
  };
  const product::Sdf outer_lip = sdf_bar({{-36, 0, 212}, {-64, 0, 226}}, {15, 15});
  const product::Sdf inner_lip = sdf_bar({{-30, 0, 220}, {-66, 0, 230}}, {11, 10});
  const product::Sdf outside = sdf_blended(wall(0, 0, 222), outer_lip, 6.0);
  const product::Sdf inside = product::sdf_union(wall(6, 7, 222), inner_lip);
  const product::Sdf level = [](const Vec3& p) { return p.z() - 220.0; };
  const std::vector<Vec3> line = curve_through(
      {{47, 0, 186}, {78, 0, 196}, {101, 0, 180}, {106, 0, 145}, {98, 0, 105}, {57, 0, 66}});
  const product::Sdf handle =
      sdf_stretched(sdf_bar(line, std::vector<double>(line.size(), 7.0)), 1, 13.0 / 7.0);
  // The handle ends in the wall, not within the jug.
  const product::Sdf bowl = product::sdf_without(sdf_common(outside, level), inside);
  return {"jug",
          product::sdf_union(bowl, product::sdf_without(handle, wall(3, 5, 222))),
          {Box3(Vec3(-82, -61, 0), Vec3(114, 61, 221)), Vec3(3.4, 3.4, 3.6), {}}};
}

// Chef's knife: blade 200 x 45 mm, 2.4 mm thick, edge down (-z), tip at +x; handle 26 mm high,
// 19 mm wide and 130 mm long with a drop at its end.
MadeShape kitchen_knife() {
  const product::Sdf blade = sdf_extruded({{-15, 11},
                                           {90, 11},
                                           {160, 4},
                                           {215, -24},
                                           {190, -30},
                                           {120, -34},
                                           {14, -34},
                                           {10, -11},
                                           {-15, -11}},
                                          0, 2, -1.2, 1.2);
  const product::Sdf handle = sdf_stretched(
      sdf_bar({{0, 0, 0}, {-40, 0, 1}, {-85, 0, 0}, {-108, 0, -4}}, {11.5, 13.5, 12, 14.5}), 1,
      0.72);
  return {"kitchen_knife",
          product::sdf_union(blade, handle),
          {Box3(Vec3(-124, -11, -35), Vec3(216, 11, 15)), Vec3(3.4, 1.9, 2.4), {{1, -2, 2, 1.0}}}};
}

// Wine glass 210 mm high: bowl 80 mm wide with walls of 3 mm, stem 8 mm thick and 80 mm long, foot
// 72 mm wide; wine in the bowl up to a third.
MadeShape wine_glass() {
  return {"wine_glass",
          sdf_lathe({{0, 0},
                     {36, 0},
                     {36, 3},
                     {10, 6},
                     {4, 14},
                     {4, 88},
                     {8, 94},
                     {28, 104},
                     {38, 122},
                     {40, 140},
                     {37, 175},
                     {32, 210},
                     {29, 210},
                     {34, 174},
                     {37, 139},
                     {0, 139}}),
          {Box3(Vec3(-41, -41, 0), Vec3(41, 41, 211)), Vec3(1.9, 1.9, 2.2), {{2, -2, 8, 1.5}}}};
}

// Toothbrush 190 mm long: handle 14 x 11 mm, neck of 8 mm, head 12 mm wide with bristles up (+z).
MadeShape toothbrush() {
  const product::Sdf handle = sdf_stretched(
      sdf_bar({{6, 0, 0}, {40, 0, 1}, {85, 0, 2}, {115, 0, 1}, {135, 0, 0}, {160, 0, 0}},
              {5.0, 5.5, 6.0, 5.0, 3.6, 3.2}),
      1, 1.25);
  const product::Sdf head = sdf_rounded_box(Vec3(174, 0, 0), Vec3(31, 12, 5), 2.0);
  const product::Sdf bristles = sdf_rounded_box(Vec3(174, 0, 7), Vec3(27, 10, 12), 1.0);
  return {"toothbrush",
          product::sdf_union(handle, product::sdf_union(head, bristles)),
          {Box3(Vec3(0, -8, -5), Vec3(190, 8, 14)), Vec3(1.9, 1.5, 1.5), {}}};
}

// Tumbler of 0.3 l: 64 mm wide at the foot, 80 mm at the rim, 110 mm high, walls of 4 mm.
MadeShape tumbler() {
  return {"tumbler",
          sdf_lathe({{0, 0},
                     {31, 0},
                     {32, 1},
                     {40, 109},
                     {39, 110},
                     {37, 110},
                     {36, 109},
                     {28.5, 6},
                     {0, 6}}),
          {Box3(Vec3(-41, -41, 0), Vec3(41, 41, 111)), Vec3(2.4, 2.4, 2.8), {}}};
}

// Long-neck bottle of 0.33 l, full: 61 mm wide, 229 mm high, neck of 28 mm.
MadeShape beer_bottle() {
  std::vector<Vec2> outline = {{0, 0}, {28, 0}, {30.5, 3}, {30.5, 118}};
  for (int i = 1; i <= 10; ++i) {  // shoulder
    const double t = i / 10.0;
    outline.push_back({14.0 + 16.5 * 0.5 * (1.0 + std::cos(std::numbers::pi * t)), 118 + 50 * t});
  }
  for (const Vec2& p : {Vec2(13, 213), Vec2(14, 216), Vec2(14, 229), Vec2(0, 229)}) {
    outline.push_back(p);
  }
  return {"beer_bottle",
          sdf_lathe(outline),
          {Box3(Vec3(-31, -31, 0), Vec3(31, 31, 230)), Vec3(2.8, 2.8, 2.8), {}}};
}

// Dinner plate: 260 mm wide, 22 mm high, 5 mm thick.
MadeShape dinner_plate() {
  return {"dinner_plate",
          sdf_lathe({{0, 1.5},
                     {70, 1.5},
                     {72, 0},
                     {80, 0},
                     {84, 3},
                     {130, 17},
                     {130, 22},
                     {84, 8.5},
                     {70, 6.5},
                     {0, 6.5}}),
          {Box3(Vec3(-131, -131, 0), Vec3(131, 131, 23)), Vec3(4.5, 4.5, 2.0), {}}};
}

// Wooden block, 60 mm along each side.
MadeShape cube() {
  return {"cube_60mm",
          sdf_rounded_box(Vec3(0, 0, 30), Vec3(60, 60, 60), 2.0),
          {Box3(Vec3(-31, -31, -1), Vec3(31, 31, 61)), Vec3(2.1, 2.1, 2.1), {}}};
}

// Door key 55 mm long and 2.4 mm thick: bow of 25 mm with a hole for the ring, blade 8 mm wide.
MadeShape key() {
  const auto disc = [](double radius) -> product::Sdf {
    return [=](const Vec3& p) { return std::hypot(p.x(), p.y()) - radius; };
  };
  const product::Sdf sheet = [](const Vec3& p) { return std::abs(p.z()) - 1.2; };
  const product::Sdf blade = sdf_extruded(
      {{5, -4}, {42, -4}, {42, 1}, {38, 4}, {34, 2}, {30, 4}, {26, 2}, {22, 4}, {5, 4}}, 0, 1, -1.2,
      1.2);
  const product::Sdf hole = [](const Vec3& p) { return std::hypot(p.x() + 7.0, p.y()) - 3.0; };
  return {"key",
          product::sdf_without(product::sdf_union(sdf_common(disc(12.5), sheet), blade), hole),
          {Box3(Vec3(-13, -13, -1.3), Vec3(43, 13, 1.3)), Vec3(0.8, 0.8, 0.8), {}}};
}

}  // namespace

std::vector<MadeShape> made_household() {
  return {frying_pan(), kettle(),      jug(),          kitchen_knife(), wine_glass(), toothbrush(),
          tumbler(),    beer_bottle(), dinner_plate(), cube(),          key()};
}

}  // namespace palmar::tests
