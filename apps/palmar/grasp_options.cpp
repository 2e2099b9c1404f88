// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp_options.h"

#include "palmar/core/error.h"
#include "text.h"

namespace palmar::cli {

void GraspArguments::add_to(CLI::App& verb) {
  verb.add_option("--hand", hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb.add_option("--grip", grip, "Kind of grip: power")->capture_default_str();
  verb.add_option("--unit", unit, "Unit of files that carry none (STL, OBJ, PLY): mm, cm, m, inch");
  verb.add_option("--at", at, "Point of the product that lies in mid-palm, x,y,z in mm");
  verb.add_option(
      "--axis", axis,
      "Direction of the grip axis, towards the thumb's side, x,y,z in the product's frame");
  verb.add_option("--turn-deg", turn_deg, "Turn of the hand about the grip axis, deg");
  verb.add_option("--palm-limit-depth-mm", palm_limit_depth, "Deepest penetration of the palm, mm")
      ->capture_default_str();
  verb.add_option("--finger-limit-depth-mm", finger_limit_depth,
                  "Deepest penetration of a finger segment, mm")
      ->capture_default_str();
}

PowerGraspOptions GraspArguments::options() const {
  if (grip != "power") {
    throw UsageError("--grip: \"" + grip + "\" is not available; power is allowed");
  }
  PowerGraspOptions result;
  result.palm_limit_depth = palm_limit_depth;
  result.finger_limit_depth = finger_limit_depth;
  if (!at.empty()) result.placement.at = parse_vector("--at", at);
  if (!axis.empty()) result.placement.axis = parse_vector("--axis", axis);
  if (turn_deg) result.placement.turn = radians(*turn_deg);
  result.check();
  return result;
}

void ContactArguments::add_to(CLI::App& verb) {
  verb.add_option("--kernel", kernel, "Response of the skin: patch (default) or point (Xie 2014)");
  verb.add_flag("--no-swelling", no_swelling, "Leave out the bulge around the contact");
  verb.add_option("--shear-modulus-kpa", shear_modulus_kpa,
                  "One shear modulus instead of the tissue's own G(d), kPa");
}

ContactOptions ContactArguments::options() const {
  ContactOptions result;
  result.swelling = !no_swelling;
  if (shear_modulus_kpa && !(*shear_modulus_kpa > 0.0)) {
    throw UsageError("--shear-modulus-kpa is " + std::to_string(*shear_modulus_kpa) +
                     "; more than 0 kPa is required");
  }
  if (shear_modulus_kpa) result.shear_modulus = *shear_modulus_kpa / 1000.0;
  result.check();
  return result;
}

ContactModel ContactArguments::model() const { return {.kernel = parse_kernel(kernel)}; }

Kernel parse_kernel(const std::string& text) {
  if (text == "patch") return Kernel::kPatch;
  if (text == "point") return Kernel::kPoint;
  throw UsageError("--kernel: \"" + text + "\" is not known; patch or point is allowed");
}

}  // namespace palmar::cli
