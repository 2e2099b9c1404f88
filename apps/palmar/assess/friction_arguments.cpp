// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "assess/friction_arguments.h"

#include <fmt/format.h>

#include "palmar/report/page/friction_words.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::cli {
namespace {

void take(const char* option, const std::string& text, std::optional<Vec3>& value) {
  if (!text.empty()) value = workflow::parse_vector(option, text);
}

}  // namespace

void FrictionArguments::add_to(CLI::App& verb) {
  verb.add_option("--friction", settings_.friction,
                  fmt::format("Coefficient of friction of skin on the product (0.3 to 1.2 is "
                              "usual): shows whether the hand holds the load; default: {:g} while "
                              "the grasp comes to rest and for a given load. 0: none",
                              grasp::kUsualFriction));
  CLI::Option* mass = verb.add_option("--mass-kg", settings_.mass, "Mass of the product, kg");
  CLI::Option* weight = verb.add_option("--weight-n", settings_.weight,
                                        "Weight of the product instead of its mass, N")
                            ->excludes(mass);
  verb.add_option("--density-g-cm3", settings_.density,
                  "Density of the product, solid throughout, instead of its mass, g/cm3")
      ->excludes(mass)
      ->excludes(weight);
  verb.add_option("--acceleration-g", settings_.acceleration,
                  "Upward acceleration that the hand gives the product, in multiples of 9.81 m/s2: "
                  "with 0.5 it weighs half as much again");
  verb.add_option(
      "--gravity", gravity_,
      "Direction of gravity in the product's frame, x,y,z; if not given 0,0,-1, and what "
      "hooked fingers carry hangs");
  verb.add_option("--mass-at", mass_at_,
                  "Centre of mass, x,y,z in mm; default: as if the product were solid throughout");
  verb.add_option("--load-n", load_n_, "Further force on the product, x,y,z in N");
  verb.add_option("--torque-n-mm", torque_n_mm_, "Further torque on the product, x,y,z in N mm");
  verb.add_option("--load-at", load_at_,
                  "Where --load-n acts, x,y,z in mm; default: at the centre of mass");
}

grasp::FrictionSettings FrictionArguments::settings() const {
  grasp::FrictionSettings result = settings_;
  if (!gravity_.empty()) result.gravity = workflow::parse_vector("--gravity", gravity_);
  take("--mass-at", mass_at_, result.mass_centre);
  take("--load-n", load_n_, result.force);
  take("--torque-n-mm", torque_n_mm_, result.torque);
  take("--load-at", load_at_, result.force_at);
  result.check();
  return result;
}

std::string friction_text(const hand::Hand& hand, const study::Assessment& assessment) {
  const contact::FrictionResult& friction = assessment.friction;
  if (friction.status == contact::FrictionStatus::kOff) return {};
  std::string text = fmt::format("friction: {}\n", report::friction_verdict(hand, assessment));
  if (friction.regions.empty()) return text;
  text += fmt::format("{:<35} {:>6} {:>10} {:>10} {:>13} {:>10}\n", "region of the skin", "normal",
                      "at most", "friction", "slip margin", "slips") +
          fmt::format("{:<35} {:>6} {:>10} {:>10} {:>13} {:>10}\n", "", "N", "N", "N", "%",
                      "% of area");
  for (const contact::RegionFriction& one : friction.regions) {
    text += fmt::format("{:<35} {:6.2f} {:10.2f} {:10.2f} {:13.0f} {:10.0f}\n",
                        report::plain_words(one.region), one.normal_force, one.limit,
                        one.force.norm(), 100.0 * one.margin, 100.0 * one.slipping_share);
  }
  return text;
}

}  // namespace palmar::cli
