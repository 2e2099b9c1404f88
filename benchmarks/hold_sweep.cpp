// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// hold_sweep KIND FROM TO STEP [FORCE_N]: a row per value: how the template hand holds a cylinder,
// as CSV.
//   KIND    diameter (mm), length (mm; of a cylinder of 35 mm), force (N; of a cylinder of 50 mm)
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "palmar/core/parallel.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/product/primitives.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

int main(int argc, char** argv) {
  using namespace palmar;
  if (argc < 5 || argc > 6) {
    fmt::print(stderr, "usage: hold_sweep KIND FROM TO STEP [FORCE_N]\n");
    return 2;
  }
  const std::string kind = argv[1];
  const double from = std::atof(argv[2]), to = std::atof(argv[3]), step = std::atof(argv[4]);
  const double force = argc > 5 ? std::atof(argv[5]) : 107.0;
  if (kind != "diameter" && kind != "length" && kind != "force") {
    fmt::print(stderr, "KIND is \"{}\"; diameter, length or force is allowed\n", kind);
    return 2;
  }
  if (!(from > 0.0 && to >= from && step > 0.0 && force > 0.0)) {
    fmt::print(stderr, "FROM, STEP and FORCE_N have to be above 0, TO at least FROM\n");
    return 2;
  }
  workflow::HandChoice choice;
  const auto hand = workflow::load_hand(choice);
  const contact::PreparedHand prepared =
      workflow::prepared_hand(choice, hand, contact::palmar_model());
  fmt::print(
      "{},status,steps,seconds,force_n,peak_cells_kpa,area_mm2,sum_n,thumb,index,middle,ring,"
      "little,palm,moved_mm,strength,message\n",
      kind);
  const auto count = static_cast<int>(std::floor((to - from) / step + 1.5));
  for (int i = 0; i < count; ++i) {
    const double value = from + step * i;
    product::CylinderProductOptions shape;
    shape.length = 160.0;
    shape.diameter = 50.0;
    double asked = force;
    if (kind == "diameter") shape.diameter = value;
    if (kind == "length") {
      shape.length = value;
      shape.diameter = 35.0;
    }
    if (kind == "force") asked = value;
    shape.fineness.chordal_error = 0.05;
    const product::Product product = product::make_cylinder_product(shape);
    study::AssessOptions options;
    options.grasp.grip = grasp::Grip::kMediumWrap;
    options.balance.grip_force = asked;
    options.balance.looks_beside = true;  // as assess does
    options.footprint = false;
    const study::Assessment found = study::assess(prepared, product, options);
    std::array<double, hand::kFingerCount> finger{};
    double palm = 0.0;
    for (std::size_t v = 0; v < found.contact.force.size(); ++v) {
      const auto of = hand::finger_of(hand->segment[v]);
      (of ? finger[static_cast<std::size_t>(*of)] : palm) += found.contact.force[v];
    }
    double four = 0.0;
    for (std::size_t f = 0; f < finger.size(); ++f) {
      if (static_cast<hand::Finger>(f) != hand::Finger::kThumb) four += finger[f];
    }
    const auto share = [&](hand::Finger f) {
      return 100.0 * finger[static_cast<std::size_t>(f)] / std::max(four, 1e-9);
    };
    fmt::print(
        "{},{},{},{:.3f},{:.2f},{:.1f},{:.0f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:.1f},{:."
        "2f},{:.3f},\"{}\"\n",
        value, name_of(found.balance.status), found.balance.iterations, found.times.balance,
        found.balance.grip_force, 1e3 * found.contact.total.peak_pressure_cells,
        found.contact.total.area, found.contact.total.force,
        finger[static_cast<std::size_t>(hand::Finger::kThumb)], share(hand::Finger::kIndex),
        share(hand::Finger::kMiddle), share(hand::Finger::kRing), share(hand::Finger::kLittle),
        palm, found.balance.moved, found.balance.strength_use.value_or(-1.0),
        found.balance.message);
    std::fflush(stdout);
  }
}
