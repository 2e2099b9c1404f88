// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Things with rings, triggers, two handles, and things that are moved where they stand. Sizes are
// those of ordinary things in shops; mm.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "made_products.h"

namespace palmar::tests {
namespace {

product::Sdf ring_of(const Vec3& middle, double along_x, double along_y, double radius) {
  return sdf_bar(ellipse(middle, along_x, along_y), std::vector<double>(41, radius));
}

// Bottle with a trigger sprayer, upright (+z), nozzle to +x: the bottle 86 mm wide and 160 mm high,
// neck of 30 mm, head 34 mm high and 24 mm wide; the trigger hangs from the head 30 mm before the
// neck and is 14 mm wide.
MadeShape spray_bottle() {
  const product::Sdf bottle = sdf_lathe(
      {{0, 0}, {41, 0}, {43, 4}, {43, 110}, {34, 138}, {19, 158}, {15, 166}, {15, 205}, {0, 205}});
  const product::Sdf head = sdf_rounded_box(Vec3(8, 0, 217), Vec3(86, 24, 34), 7.0);
  const product::Sdf nozzle = sdf_bar({{50, 0, 221}, {62, 0, 221}}, {10, 9});
  const product::Sdf trigger = sdf_stretched(
      sdf_bar({{40, 0, 206}, {38, 0, 186}, {42, 0, 168}, {48, 0, 152}}, {4.5, 4.5, 4.5, 4.5}), 1,
      1.55);
  return {"spray_bottle",
          product::sdf_union(product::sdf_union(bottle, head), product::sdf_union(nozzle, trigger)),
          {Box3(Vec3(-44, -44, 0), Vec3(72, 44, 235)), Vec3(2.8, 2.8, 3.4), {{2, 145, 236, 2.2}}}};
}

// Glue gun: barrel 165 mm long and 46 mm high along x, nozzle at +x; the handle below it (-z) is
// 105 mm long, 36 x 28 mm thick and leans back by 15 degrees; the trigger stands 14 mm before its
// upper half and is 12 mm wide.
MadeShape glue_gun() {
  const product::Sdf barrel = sdf_rounded_box(Vec3(20, 0, 0), Vec3(165, 38, 46), 14.0);
  const product::Sdf nozzle = sdf_bar({{98, 0, 0}, {128, 0, 0}}, {11, 5});
  const product::Sdf handle =
      sdf_stretched(sdf_bar({{-12, 0, -10}, {-20, 0, -60}, {-36, 0, -116}}, {18, 17, 19}), 1, 0.78);
  const product::Sdf trigger = sdf_rounded_box(Vec3(11, 0, -38), Vec3(22, 12, 34), 4.0);
  return {
      "glue_gun",
      product::sdf_union(product::sdf_union(barrel, nozzle), product::sdf_union(handle, trigger)),
      {Box3(Vec3(-64, -20, -137), Vec3(134, 20, 24)), Vec3(2.8, 2.2, 2.8), {}}};
}

// Tailor's shears, 260 mm, shut: blades to +x, pivot at 0; the thumb's ring (y > 0) is 34 x 26 mm
// inside, the fingers' ring 78 x 30 mm.
MadeShape tailors_shears() {
  const product::Sdf blades = sdf_extruded(
      {{-14, -13}, {20, -14}, {90, -9}, {140, 0}, {90, 9}, {20, 14}, {-14, 13}}, 0, 1, -3, 3);
  const product::Sdf rings = product::sdf_union(ring_of(Vec3(-82, 28, 0), 22.5, 18.5, 5.5),
                                                ring_of(Vec3(-88, -30, 0), 44.5, 20.5, 5.5));
  const product::Sdf shanks = sdf_blended(sdf_bar({{0, 0, 0}, {-62, 19, 0}}, {7, 6}),
                                          sdf_bar({{0, 0, 0}, {-48, -21, 0}}, {7, 6}), 6.0);
  return {"tailors_shears",
          product::sdf_union(blades, product::sdf_union(rings, shanks)),
          {Box3(Vec3(-139, -57, -8), Vec3(141, 53, 8)), Vec3(1.9, 1.7, 1.6), {}}};
}

// Nail scissors, 100 mm, shut: blades to +x, pivot at 0; two like rings, 25 x 21 mm inside.
MadeShape nail_scissors() {
  const product::Sdf blades = sdf_extruded(
      {{-5, -5}, {6, -5}, {28, -2.5}, {38, 0}, {28, 2.5}, {6, 5}, {-5, 5}}, 0, 1, -1.6, 1.6);
  const product::Sdf rings = product::sdf_union(ring_of(Vec3(-46, 16.5, 0), 14.5, 12.5, 2.2),
                                                ring_of(Vec3(-46, -16.5, 0), 14.5, 12.5, 2.2));
  const product::Sdf shanks = product::sdf_union(sdf_bar({{0, 0, 0}, {-34, 10, 0}}, {4, 2.6}),
                                                 sdf_bar({{0, 0, 0}, {-34, -10, 0}}, {4, 2.6}));
  return {"nail_scissors",
          product::sdf_union(blades, product::sdf_union(rings, shanks)),
          {Box3(Vec3(-64, -32, -4), Vec3(39, 32, 4)), Vec3(0.95, 0.85, 0.75), {}}};
}

// Combination pliers, 190 mm, a little open: jaws to +x, pivot at 0; two handles of 16 x 12 mm, 56
// mm across where they are widest.
MadeShape pliers() {
  const auto handle = [](double side) {
    return sdf_stretched(sdf_bar(curve_through({{0, side * 4, 0},
                                                {-25, side * 11, 0},
                                                {-60, side * 20, 0},
                                                {-100, side * 20, 0},
                                                {-138, side * 15, 0}}),
                                 std::vector<double>(33, 8.0)),
                         2, 0.75);
  };
  const product::Sdf head = sdf_rounded_box(Vec3(4, 0, 0), Vec3(34, 27, 11), 3.0);
  const product::Sdf jaws = sdf_extruded({{10, -12}, {46, -6}, {46, 6}, {10, 12}}, 0, 1, -5, 5);
  return {"pliers",
          product::sdf_union(product::sdf_union(head, jaws),
                             product::sdf_union(handle(1.0), handle(-1.0))),
          {Box3(Vec3(-147, -29, -7), Vec3(47, 29, 7)), Vec3(2.0, 1.8, 1.6), {}}};
}

// Kitchen tongs, 240 mm, open: two arms 18 mm wide and 4 mm thick joined at -x, 60 mm apart at +x.
MadeShape tongs() {
  const auto arm = [](double side) {
    const std::vector<Vec3> line = curve_through({{-8, 0, 0},
                                                  {-3, side * 9, 0},
                                                  {40, side * 17, 0},
                                                  {120, side * 25, 0},
                                                  {225, side * 30, 0}});
    return sdf_stretched(sdf_bar(line, std::vector<double>(line.size(), 2.2)), 2, 4.2);
  };
  return {"tongs",
          product::sdf_union(arm(1.0), arm(-1.0)),
          {Box3(Vec3(-12, -34, -10), Vec3(229, 34, 10)), Vec3(2.2, 1.4, 1.7), {}}};
}

// Palm sander on a board (z = 0): pad 112 x 105 mm, waist, and a dome of 92 mm whose top is 135 mm
// above the board; the cable leaves at -x.
MadeShape palm_sander() {
  const product::Sdf pad = sdf_rounded_box(Vec3(0, 0, 16), Vec3(112, 105, 32), 6.0);
  const product::Sdf housing = sdf_lathe({{0, 20},
                                          {46, 20},
                                          {44, 60},
                                          {40, 80},
                                          {44, 96},
                                          {46, 108},
                                          {42, 122},
                                          {30, 132},
                                          {14, 135},
                                          {0, 135}});
  return {"palm_sander",
          product::sdf_union(pad, housing),
          {Box3(Vec3(-56, -53, 0), Vec3(56, 53, 136)), Vec3(3.4, 3.4, 3.4), {}}};
}

// Remote control of a television, 185 x 46 x 21 mm, buttons up (+z), the window at +x.
MadeShape tv_remote() {
  const product::Sdf shell = sdf_rounded_box(Vec3(0, 0, 0), Vec3(185, 46, 21), 8.0);
  return {
      "tv_remote", shell, {Box3(Vec3(-93, -23, -11), Vec3(93, 23, 11)), Vec3(2.8, 2.2, 2.0), {}}};
}

// Flat symmetric mouse 105 x 58 x 31 mm on a table (z = 0), buttons to +x; highest in its middle.
MadeShape flat_mouse() {
  const product::Sdf shell = [](const Vec3& p) {
    const double e = std::pow(std::abs(p.x() / 52.5), 3.2) + std::pow(std::abs(p.y() / 29.0), 3.2) +
                     std::pow(std::abs(p.z() / 31.0), 2.2);
    return 26.0 * (std::pow(e, 1.0 / 2.6) - 1.0);
  };
  const product::Sdf table = [](const Vec3& p) { return -p.z(); };
  return {"flat_mouse",
          sdf_common(shell, table),
          {Box3(Vec3(-53, -29, 0), Vec3(53, 29, 32)), Vec3(2.0, 2.0, 1.8), {}}};
}

// Knob of a radio, 44 mm wide, 22 mm high (+z), on a panel of 140 x 110 x 8 mm.
MadeShape rotary_knob() {
  const product::Sdf panel = sdf_rounded_box(Vec3(0, 0, -4), Vec3(140, 110, 8), 1.0);
  const product::Sdf knob =
      sdf_lathe({{0, -2}, {23, -2}, {22.5, 3}, {21.5, 20}, {20, 22}, {0, 22}});
  return {"rotary_knob",
          product::sdf_union(panel, knob),
          {Box3(Vec3(-70, -55, -8), Vec3(70, 55, 23)),
           Vec3(4.5, 4.5, 3.5),
           {{2, -2, 23, 1.8}, {0, -25, 25, 2.0}, {1, -25, 25, 2.0}}}};
}

// Lever handle on a door leaf 40 mm thick (a piece of 260 x 200 mm): a neck of 20 mm holds the
// lever 52 mm before the door (+z); the lever is 130 mm long (to -x) and 20 x 17 mm thick.
MadeShape lever_handle() {
  const product::Sdf leaf = sdf_rounded_box(Vec3(-30, 0, -20), Vec3(260, 200, 40), 1.0);
  const product::Sdf rose = sdf_lathe({{0, -4}, {26, -4}, {26, 6}, {24, 8}, {0, 8}});
  const product::Sdf neck = sdf_bar({{0, 0, 0}, {0, 0, 50}}, {10, 10});
  const product::Sdf lever = sdf_stretched(sdf_bar({{0, 0, 52}, {-122, 0, 52}}, {10, 9}), 1, 0.9);
  return {"lever_handle",
          product::sdf_union(product::sdf_union(leaf, rose), product::sdf_union(neck, lever)),
          {Box3(Vec3(-160, -100, -40), Vec3(100, 100, 63)),
           Vec3(8, 8, 8),
           {{2, -2, 64, 2.6}, {0, -134, 30, 3.2}, {1, -30, 30, 2.8}}}};
}

// Housing 110 x 80 x 45 mm with a push button of 20 mm that stands out 6 mm from its top (+z).
MadeShape push_button() {
  const product::Sdf housing = sdf_rounded_box(Vec3(0, 0, -22.5), Vec3(110, 80, 45), 4.0);
  const product::Sdf button = sdf_lathe({{0, -2}, {10, -2}, {10, 4.5}, {8.5, 6}, {0, 6}});
  return {"push_button",
          product::sdf_union(housing, button),
          {Box3(Vec3(-55, -40, -45), Vec3(55, 40, 7)),
           Vec3(3.6, 3.6, 3.6),
           {{2, -3, 7, 1.1}, {0, -13, 13, 1.3}, {1, -13, 13, 1.3}}}};
}

}  // namespace

std::vector<MadeShape> made_moved() {
  return {spray_bottle(), glue_gun(),    tailors_shears(), nail_scissors(),
          pliers(),       tongs(),       palm_sander(),    tv_remote(),
          flat_mouse(),   rotary_knob(), lever_handle(),   push_button()};
}

}  // namespace palmar::tests
