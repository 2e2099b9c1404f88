// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "grasp/grasp_options.h"

#include <fmt/format.h>

#include "palmar/core/error.h"
#include "text.h"

namespace palmar::cli {
namespace {

grasp::FingertipTarget parse_fingertip(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::optional<hand::Finger> finger = hand::finger_named(text.substr(0, colon));
  if (colon == text.npos || !finger) {
    throw UsageError(
        fmt::format("--fingertip: \"{}\" is not understood; FINGER:X,Y,Z with thumb, "
                    "index, middle, ring or little and a point in mm is required",
                    text));
  }
  return {*finger, workflow::parse_vector("--fingertip", text.substr(colon + 1))};
}

Box3 parse_region(const std::string& text) {
  const std::vector<double> values = workflow::parse_list("--box", text);
  if (values.size() != 6) {
    throw UsageError(
        fmt::format("--box: \"{}\" has {} numbers; two corners of a box in mm are "
                    "required (6 numbers)",
                    text, values.size()));
  }
  Box3 box;
  box.extend(Vec3(values[0], values[1], values[2])).extend(Vec3(values[3], values[4], values[5]));
  return box;
}

}  // namespace

void GraspArguments::add_to(CLI::App& verb) {
  verb.add_option("--hand", hand, "\"template\" or a .hand.glb file")->capture_default_str();
  verb.add_option("--grip", grip_,
                  "Kind of grip: any (as people would choose), power (what suits the shape), or a "
                  "name of the GRASP taxonomy; allowed: " +
                      workflow::grip_list())
      ->capture_default_str();
  holds_.add_hold_to(verb);
  holds_.add_to(verb);
  verb.add_option("--unit", unit, "Unit of files that carry none (STL, OBJ, PLY): mm, cm, m, inch");
  verb.add_option("--at", at_,
                  "Point of the product that is in the middle of the palm (precision grips: "
                  "between the fingertips), x,y,z in mm");
  verb.add_option("--fingertip", fingertips_,
                  "Point of the product for a fingertip of a precision grip, once per finger: "
                  "FINGER:X,Y,Z in mm")
      ->allow_extra_args(false);
  verb.add_option("--fingertip-depth-mm", settings_.fingertip_depth,
                  "How deep a precision grip's fingertips are pressed in, mm")
      ->capture_default_str();
  verb.add_option(
      "--axis", axis_,
      "Direction of the grip axis, towards the thumb's side, x,y,z in the product's frame");
  verb.add_option("--box", region_,
                  "Hold the product by the surface inside this box: X0,Y0,Z0,X1,Y1,Z1, two corners "
                  "in mm in the product's frame (power grips)");
  verb.add_option("--turn-deg", turn_deg_, "Turn of the hand about the grip axis, deg");
  verb.add_flag("--place-per-hand", settings_.is_place_per_hand,
                "Let this hand search where to hold the product, instead of holding it where the "
                "built-in hand does");
  verb.add_option("--palm-limit-depth-mm", settings_.palm_limit_depth,
                  "Deepest penetration of the palm, mm")
      ->capture_default_str();
  verb.add_option("--finger-limit-depth-mm", settings_.finger_limit_depth,
                  "Deepest penetration of a finger segment, mm")
      ->capture_default_str();
}

grasp::GraspSettings GraspArguments::settings() const {
  grasp::GraspSettings result = settings_;
  result.grip = workflow::parse_grip(grip_);
  result.is_power_only = grip_ == "power";
  result.holding = holds_.request();
  grasp::PlacementRequest& placement = result.placement;
  if (!at_.empty()) placement.at = workflow::parse_vector("--at", at_);
  if (!region_.empty()) placement.region = parse_region(region_);
  if (!axis_.empty()) placement.axis = workflow::parse_vector("--axis", axis_);
  if (turn_deg_) placement.turn = radians(*turn_deg_);
  for (const std::string& text : fingertips_) result.fingertips.push_back(parse_fingertip(text));
  result.check();
  return result;
}

void ContactArguments::add_to(CLI::App& verb) {
  verb.add_option("--preset", model_.preset,
                  "Equations of the contact: palmar, or xie2014 (as printed in the thesis)")
      ->capture_default_str();
  verb.add_option(
      "--coupling", model_.coupling,
      "Regions of the hand: coupled (one problem over the whole hand) or independent "
      "(each region alone, with the tissue model halfspace); default: as in the preset");
  verb.add_option(
      "--tissue-model", model_.tissue_model,
      "bone (the tissue between skin and bones), layered (a flat layer over bone) or halfspace "
      "(endless tissue); default: as in the preset (palmar: bone)");
  verb.add_option("--kernel", model_.kernel,
                  "Response of the skin: patch or point (Xie 2014); default: as in the preset");
  verb.add_option("--tissue", tissue,
                  "Tissue file (TOML) for the hand; what it doesn't give stays as it is");
  verb.add_flag(
      "--skin-on-skin", skin_on_skin_,
      "Let skin of the hand press on other skin of it, as fingers do side by side; takes two "
      "to three times as long");
  verb.add_flag("--refine,!--no-refine", refine_,
                "Refine the skin on sharp edges and small fillets; on by default");
  verb.add_flag("--no-swelling", no_swelling_, "Leave out the bulge around the contact");
  verb.add_option("--shear-modulus-kpa", shear_modulus_kpa_,
                  "One shear modulus instead of the tissue's own G(d), kPa");
  verb.add_flag("--error-band,!--no-error-band", error_band_,
                "Results for soft and stiff tissue beside the nominal ones; on by default");
  verb.add_option("--coating", coatings_,
                  "Soft grip sleeve on the product, may be given several times: "
                  "THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON[,X0,Y0,Z0,X1,Y1,Z1]]; Poisson's ratio "
                  "0.5 if not given; the box (two corners, mm, product's frame) limits it to that "
                  "part of the surface")
      ->allow_extra_args(false);
}

contact::ContactOptions ContactArguments::options() const {
  contact::ContactOptions result;
  result.swelling = !no_swelling_;
  result.skin_on_skin = skin_on_skin_;
  result.refine = refine_;
  if (shear_modulus_kpa_ && !(*shear_modulus_kpa_ > 0.0)) {
    throw UsageError("--shear-modulus-kpa is " + std::to_string(*shear_modulus_kpa_) +
                     "; more than 0 kPa is required");
  }
  if (shear_modulus_kpa_) result.shear_modulus = *shear_modulus_kpa_ / 1000.0;
  result.error_band = error_band_;
  for (const std::string& text : coatings_)
    result.coatings.push_back(workflow::parse_coating(text));
  result.check();
  return result;
}

}  // namespace palmar::cli
