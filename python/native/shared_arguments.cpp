// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "bindings.h"

#include <fmt/format.h>

#include <array>

#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/workflow/words/contact_words.h"
#include "palmar/workflow/words/hold_words.h"
#include "palmar/workflow/words/person_words.h"

namespace palmar::python {
namespace {

/// A number, a name, or a direction as three numbers, in the words of HoldWords.
std::string words_in(Arguments& arguments, const char* name) {
  const py::object given = arguments.get(name);
  if (!given) return {};
  if (py::isinstance<py::int_>(given)) return std::to_string(given.cast<long long>());
  if (py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__")) {
    return py::str(py::module_::import("os").attr("fspath")(given)).cast<std::string>();
  }
  py::dict one;
  one[name] = given;
  Vec3 direction;
  Arguments(one).take(name, direction);
  return fmt::format("{},{},{}", direction.x(), direction.y(), direction.z());
}

}  // namespace

workflow::ProductChoice product_choice(py::handle product,
                                       const records::LoadProductOptions& reading) {
  if (py::isinstance<product::Product>(product)) return product.cast<const product::Product&>();
  py::dict one;
  one["product"] = product;
  std::filesystem::path file;
  Arguments(one).take("product", file);
  return {file, reading};
}

records::LoadProductOptions reading_of(Arguments& arguments) {
  records::LoadProductOptions reading;
  arguments.take("unit", reading.unit);
  arguments.take("chordal_error_mm", reading.chordal_error);
  arguments.take("time_limit_s", reading.limits.seconds);
  arguments.take("memory_limit_mb", reading.limits.memory_mb);
  reading.limits.check();
  return reading;
}

workflow::HandChoice hand_choice(Arguments& arguments, const std::string& person) {
  workflow::HandChoice choice;
  const py::object given = arguments.get("hand");
  if (given && py::isinstance<hand::Hand>(given)) {
    choice.value = given.cast<std::shared_ptr<hand::Hand>>();
  } else if (given) {
    arguments.take("hand", choice.name);
  }
  arguments.take("tissue", choice.tissue);
  arguments.take("left", choice.is_left);
  choice.person = workflow::parse_person_size(person);
  return choice;
}

grasp::HoldRequest holding_of(Arguments& arguments) {
  workflow::HoldWords words;
  words.hold = words_in(arguments, "hold");
  words.part = words_in(arguments, "part");
  arguments.take("along", words.along);
  words.toward = words_in(arguments, "toward");
  words.up = words_in(arguments, "up");
  arguments.take("purpose", words.purpose);
  return workflow::hold_request(words);
}

grasp::GraspSettings grasp_of(Arguments& arguments) {
  grasp::GraspSettings settings;
  std::string grip = "any";
  arguments.take("grip", grip);
  settings.grip = workflow::parse_grip(grip);
  settings.is_power_only = grip == "power";
  settings.holding = holding_of(arguments);
  arguments.take("at", settings.placement.at);
  arguments.take("axis", settings.placement.axis);
  arguments.take("box", settings.placement.region);
  double turn = 0.0;
  if (arguments.take("turn_deg", turn, geometry::kDegree)) settings.placement.turn = turn;
  arguments.take("place_per_hand", settings.is_place_per_hand);
  arguments.take("palm_limit_depth_mm", settings.palm_limit_depth);
  arguments.take("finger_limit_depth_mm", settings.finger_limit_depth);
  arguments.take("fingertip_depth_mm", settings.fingertip_depth);
  if (const py::object given = arguments.get("fingertips")) {
    for (const auto& [name, point] : given.cast<py::dict>()) {
      const std::string finger = py::str(name).cast<std::string>();
      const std::optional<hand::Finger> known = hand::finger_named(finger);
      if (!known) {
        throw UsageError("setting \"fingertips\": \"" + finger +
                         "\" is not known; thumb, index, middle, ring or little is allowed");
      }
      py::dict one;
      one["fingertips"] = point;
      grasp::FingertipTarget target{*known, Vec3::Zero()};
      Arguments(one).take("fingertips", target.point);
      settings.fingertips.push_back(target);
    }
  }
  settings.check();
  return settings;
}

contact::ContactModel model_of(Arguments& arguments) {
  workflow::ContactModelWords words;
  arguments.take("preset", words.preset);
  arguments.take("kernel", words.kernel);
  arguments.take("tissue_model", words.tissue_model);
  arguments.take("coupling", words.coupling);
  return workflow::contact_model(words);
}

contact::ContactOptions contact_of(Arguments& arguments, contact::ContactOptions usual) {
  arguments.take("swelling", usual.swelling);
  arguments.take("skin_on_skin", usual.skin_on_skin);
  arguments.take("refine", usual.refine);
  arguments.take("error_band", usual.error_band);
  arguments.take("shear_modulus_kpa", usual.shear_modulus, 1e-3);
  std::vector<std::string> coatings;
  arguments.take("coating", coatings);
  for (const std::string& words : coatings)
    usual.coatings.push_back(workflow::parse_coating(words));
  usual.check();
  return usual;
}

grasp::FrictionSettings friction_of(Arguments& arguments) {
  grasp::FrictionSettings settings;
  arguments.take("friction", settings.friction);
  arguments.take("mass_kg", settings.mass);
  arguments.take("weight_n", settings.weight);
  arguments.take("density_g_cm3", settings.density);
  arguments.take("acceleration_g", settings.acceleration);
  arguments.take("gravity", settings.gravity);
  arguments.take("mass_at", settings.mass_centre);
  arguments.take("load_n", settings.force);
  arguments.take("torque_n_mm", settings.torque);
  arguments.take("load_at", settings.force_at);
  settings.check();
  return settings;
}

grasp::RestSettings rest_of(Arguments& arguments, const std::string& person) {
  grasp::RestSettings settings;
  arguments.take("balance", settings.is_balanced);
  arguments.take("limit_depths", settings.limit_depths);
  arguments.take("grip_force_n", settings.grip_force);
  arguments.take("strength_share", settings.strength_share);
  arguments.take("strength_n", settings.strength);
  arguments.take("turn_n_m", settings.turn);
  std::string task = "usual";
  arguments.take("task", task);
  settings.task = grasp::hand_task_named(task);
  settings = workflow::held_by(person, settings);
  settings.check();
  return settings;
}

}  // namespace palmar::python
