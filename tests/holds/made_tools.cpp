// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Sizes are those of ordinary things in shops, unless a source is named; mm.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "made_products.h"

namespace palmar::tests {
namespace {

// Cabin suitcase 450 x 320 x 140 mm. The handle on top is 24 mm thick and leaves 116 mm of width
// and 48 mm of depth for the fingers; MIL-STD-1472 asks for 111 and 48 mm for a bar held in a bare
// hand.
MadeShape suitcase() {
  const product::Sdf body = sdf_rounded_box(Vec3(0, 0, 160), Vec3(450, 140, 320), 20.0);
  const std::vector<Vec3> line = curve_through({{-70, 0, 312},
                                                {-70, 0, 345},
                                                {-58, 0, 377},
                                                {0, 0, 380},
                                                {58, 0, 377},
                                                {70, 0, 345},
                                                {70, 0, 312}});
  std::vector<double> radius;
  for (const Vec3& p : line) radius.push_back(p.z() > 368.0 ? 12.0 : 9.0);
  return {"suitcase",
          product::sdf_union(body, sdf_bar(line, radius)),
          {Box3(Vec3(-225, -70, 0), Vec3(225, 70, 393)),
           Vec3(9, 9, 9),
           {{2, 305, 395, 3.5}, {0, -85, 85, 4.0}, {1, -20, 20, 3.5}}}};
}

// Claw hammer 330 mm long: the head across its +y end (face on +x, claw on -x), shaft of 26 x 20
// mm, grip of 34 x 24 mm over the last 150 mm.
MadeShape hammer() {
  const product::Sdf poll = sdf_bar({{-18, 0, 0}, {30, 0, 0}}, {13, 12});
  const product::Sdf face = sdf_bar({{40, 0, 0}, {52, 0, 0}}, {14.5, 14.5});
  const product::Sdf claw =
      sdf_stretched(sdf_bar({{-18, 0, 0}, {-45, -5, 0}, {-80, -24, 0}}, {9.5, 7, 3.5}), 2, 1.6);
  const product::Sdf handle =
      sdf_stretched(sdf_bar({{0, 12, 0}, {0, -120, 0}, {0, -165, 0}, {0, -240, 0}, {0, -300, 0}},
                            {13, 13, 17, 16, 18}),
                    2, 0.72);
  return {"hammer",
          product::sdf_union(product::sdf_union(poll, face), product::sdf_union(claw, handle)),
          {Box3(Vec3(-85, -319, -16), Vec3(67, 26, 16)), Vec3(2.6, 3.4, 2.4), {}}};
}

// Drawer front 120 x 120 x 18 mm (a piece) with a round knob 32 mm wide that stands out 30 mm (+z).
MadeShape drawer_knob() {
  const product::Sdf front = sdf_rounded_box(Vec3(0, 0, -9), Vec3(120, 120, 18), 1.0);
  const product::Sdf knob = sdf_lathe(
      {{0, -4}, {9, -4}, {8, 8}, {11, 13}, {15, 17}, {16, 22}, {14, 27}, {8, 30}, {0, 30}});
  return {"drawer_knob",
          product::sdf_union(front, knob),
          {Box3(Vec3(-60, -60, -18), Vec3(60, 60, 31)),
           Vec3(4.5, 4.5, 4.5),
           {{2, -2, 32, 1.8}, {0, -18, 18, 1.8}, {1, -18, 18, 1.8}}}};
}

// Door leaf 40 mm thick (a piece of 240 x 240 mm) with a round knob 54 mm wide whose middle stands
// 52 mm off the door (+z), on a neck of 24 mm.
MadeShape door_knob() {
  const product::Sdf leaf = sdf_rounded_box(Vec3(0, 0, -20), Vec3(240, 240, 40), 1.0);
  const product::Sdf knob = sdf_lathe({{0, -4},
                                       {32, -4},
                                       {32, 5},
                                       {30, 7},
                                       {13, 9},
                                       {12, 26},
                                       {16, 30},
                                       {23, 38},
                                       {26.5, 46},
                                       {27, 52},
                                       {26, 60},
                                       {22, 68},
                                       {15, 73},
                                       {0, 75}});
  return {"door_knob",
          product::sdf_union(leaf, knob),
          {Box3(Vec3(-120, -120, -40), Vec3(120, 120, 76)),
           Vec3(8, 8, 8),
           {{2, -2, 77, 2.6}, {0, -35, 35, 2.8}, {1, -35, 35, 2.8}}}};
}

// Household scissors, 190 mm, shut: blades to +x, pivot at 0; the thumb's ring (y > 0) is 30 x 22
// mm inside, the fingers' ring 48 x 26 mm.
MadeShape scissors() {
  const product::Sdf blades = sdf_extruded(
      {{-8, -9}, {10, -10}, {60, -7}, {95, 0}, {60, 7}, {10, 10}, {-8, 9}}, 0, 1, -2.4, 2.4);
  const auto ring = [](const Vec3& middle, double along_x, double along_y) {
    return sdf_bar(ellipse(middle, along_x, along_y), std::vector<double>(41, 4.5));
  };
  const product::Sdf rings =
      product::sdf_union(ring(Vec3(-62, 22.5, 0), 19.5, 15.5), ring(Vec3(-66, -22, 0), 28.5, 17.5));
  const product::Sdf shanks = product::sdf_union(sdf_bar({{0, 0, 0}, {-44, 16, 0}}, {6, 4.5}),
                                                 sdf_bar({{0, 0, 0}, {-40, -15, 0}}, {6, 4.5}));
  return {"scissors",
          product::sdf_union(blades, product::sdf_union(rings, shanks)),
          {Box3(Vec3(-100, -44, -7), Vec3(96, 44, 7)), Vec3(1.6, 1.4, 1.5), {}}};
}

// Paint bucket of 10 l, shut: 210 mm wide at the foot, 280 mm at the lid, 260 mm high. The wire
// bail stands upright in the plane of x and z; its grip, 100 mm long and 22 mm thick, lies 140 mm
// above the lid.
MadeShape bucket() {
  const product::Sdf body =
      sdf_lathe({{0, 0}, {104, 0}, {136, 245}, {140, 247}, {140, 260}, {0, 260}}, 1.0);
  std::vector<Vec3> line;
  for (int i = 0; i <= 24; ++i) {
    const double t = std::numbers::pi * (1.0 - i / 24.0);
    line.push_back(Vec3(143.0 * std::cos(t), 0.0, 235.0 + 172.0 * std::sin(t)));
  }
  const product::Sdf wire = sdf_bar(line, std::vector<double>(line.size(), 4.0));
  const product::Sdf grip = sdf_bar({{-40, 0, 402}, {40, 0, 402}}, {11, 11});
  return {"bucket",
          product::sdf_union(body, product::sdf_union(wire, grip)),
          {Box3(Vec3(-148, -142, -2), Vec3(148, 142, 414)),
           Vec3(7, 9, 9),
           {{1, -14, 14, 2.5}, {2, 225, 415, 3.0}, {0, -52, 52, 3.5}}}};
}

// Digging spade 940 mm long: the D-grip at the top (crossbar of 30 mm, 95 mm wide between the
// arms, 75 mm deep), shaft of 36 mm, blade 180 x 290 mm downwards (-z).
MadeShape spade() {
  const product::Sdf crossbar = sdf_bar({{-58, 0, 0}, {58, 0, 0}}, {15, 15});
  const product::Sdf arms =
      product::sdf_union(sdf_bar({{-58, 0, 0}, {-52, 0, -58}, {0, 0, -112}}, {11, 11, 15}),
                         sdf_bar({{58, 0, 0}, {52, 0, -58}, {0, 0, -112}}, {11, 11, 15}));
  const product::Sdf shaft = sdf_bar({{0, 0, -105}, {0, 0, -680}}, {18, 18});
  const product::Sdf blade = sdf_rounded_box(Vec3(0, 0, -780), Vec3(180, 6, 290), 2.0);
  return {"spade",
          product::sdf_union(product::sdf_union(crossbar, arms), product::sdf_union(shaft, blade)),
          {Box3(Vec3(-91, -19, -926), Vec3(91, 19, 16)),
           Vec3(4.5, 4.5, 8.0),
           {{2, -125, 17, 3.5}, {1, -5, 5, 2.0}}}};
}

// Torch 185 mm long: barrel of 30 mm, head of 46 mm at +x, a switch on top (+z).
MadeShape torch() {
  const auto round = [](std::vector<Vec2> outline) {
    const product::Sdf upright = sdf_lathe(std::move(outline));
    return product::Sdf([upright](const Vec3& p) { return upright(Vec3(p.y(), p.z(), p.x())); });
  };
  const product::Sdf body =
      round({{0, 0}, {13, 0}, {15, 2}, {15, 126}, {23, 148}, {23, 183}, {21, 185}, {0, 185}});
  const product::Sdf button = sdf_bar({{104, 0, 13}, {116, 0, 13}}, {4.5, 4.5});
  return {"torch",
          product::sdf_union(body, button),
          {Box3(Vec3(0, -23, -23), Vec3(186, 23, 23)), Vec3(2.4, 2.2, 2.2), {}}};
}

// Computer mouse 116 x 62 x 39 mm on a table (z = 0), buttons to +x; highest behind its middle.
MadeShape computer_mouse() {
  const product::Sdf shell = [](const Vec3& p) {
    const double x = p.x() + 12.0;
    const double length = x > 0.0 ? 70.0 : 46.0;
    const double e = std::pow(std::abs(x / length), 2.4) + std::pow(std::abs(p.y() / 31.0), 2.8) +
                     std::pow(std::abs(p.z() / 39.0), 2.2);
    return 30.0 * (std::pow(e, 1.0 / 2.4) - 1.0);
  };
  const product::Sdf table = [](const Vec3& p) { return -p.z(); };
  return {"computer_mouse",
          sdf_common(shell, table),
          {Box3(Vec3(-58, -31, 0), Vec3(58, 31, 40)), Vec3(2.2, 2.2, 2.0), {}}};
}

// Screwdriver with a ball handle of 48 mm, tip at +x, 150 mm from the ball's middle.
MadeShape ball_screwdriver() {
  const product::Sdf ball = sdf_bar({{0, 0, 0}, {1, 0, 0}}, {24, 24});
  const product::Sdf collar = sdf_bar({{15, 0, 0}, {36, 0, 0}}, {13, 9});
  const product::Sdf shaft = sdf_bar({{30, 0, 0}, {147, 0, 0}}, {3.5, 3.5});
  return {"ball_screwdriver",
          product::sdf_union(sdf_blended(ball, collar, 8.0), shaft),
          {Box3(Vec3(-25, -25, -25), Vec3(151, 25, 25)), Vec3(1.9, 1.8, 1.8), {}}};
}

// Long umbrella, shut, 790 mm, tip down (-z): crook of 22 mm bent by a half circle of 80 mm width,
// straight part of the handle 120 mm long, canopy furled to 52 mm.
MadeShape umbrella() {
  std::vector<Vec3> line = {{0, 0, -120}};
  for (int i = 0; i <= 16; ++i) {
    const double t = std::numbers::pi * (1.0 - i / 16.0);
    line.push_back(Vec3(40.0 + 40.0 * std::cos(t), 0.0, 40.0 * std::sin(t)));
  }
  line.push_back(Vec3(80, 0, -22));
  const product::Sdf crook = sdf_bar(line, std::vector<double>(line.size(), 11.0));
  const product::Sdf shaft = sdf_bar({{0, 0, -120}, {0, 0, -742}}, {6, 5});
  const product::Sdf canopy = sdf_bar({{0, 0, -205}, {0, 0, -250}, {0, 0, -690}}, {22, 26, 10});
  return {"umbrella",
          product::sdf_union(crook, product::sdf_union(shaft, canopy)),
          {Box3(Vec3(-27, -27, -749), Vec3(92, 27, 52)), Vec3(2.7, 2.7, 8.0), {{2, -135, 55, 3}}}};
}

}  // namespace

std::vector<MadeShape> made_tools() {
  return {suitcase(), hammer(), drawer_knob(),    door_knob(),        scissors(), bucket(),
          spade(),    torch(),  computer_mouse(), ball_screwdriver(), umbrella()};
}

}  // namespace palmar::tests
