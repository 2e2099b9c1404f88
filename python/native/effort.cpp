// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/effort/effort.h"
#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/effort_json.h"
#include "palmar/workflow/effort/effort_capacity.h"
#include "palmar/workflow/grasp/contact_with_band.h"
#include "palmar/workflow/words/fingertip_words.h"
#include "palmar/workflow/words/person_words.h"
#include "task.h"

namespace palmar::python {
namespace {

hand::WristPosture wrist_of(Arguments& arguments) {
  double flexion = -30.0, deviation = 0.0;  // degrees; as on the command line
  arguments.take("wrist_flexion_deg", flexion);
  arguments.take("wrist_deviation_deg", deviation);
  return {flexion * geometry::kDegree, deviation * geometry::kDegree};
}

hand::TendonModel tendons_of(Arguments& arguments) {
  std::string points = "synek2019", hood = "synek2019";
  arguments.take("tendon_points", points);
  arguments.take("hood", hood);
  return workflow::parse_tendon_model(points, hood);
}

py::object grasp(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::EffortRequest request;
  request.product = product_choice(arguments.get("product"), reading_of(arguments));
  std::string person;
  arguments.take("person", person);
  request.grasp = grasp_of(arguments);
  request.contact = contact_of(arguments, workflow::refined_contact_with_band());
  request.model = model_of(arguments);
  request.friction = friction_of(arguments);
  request.rest = rest_of(arguments, person);
  request.hand = hand_choice(arguments, person);
  arguments.take("grasp", request.grasp_file);
  arguments.take("exponent", request.effort.exponent);
  arguments.take("muscle_strength", request.effort.strength);
  request.effort.tendons = tendons_of(arguments);
  request.effort.wrist = wrist_of(arguments);
  arguments.finish();
  const effort::EffortResult result =
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        request.note = notes;
        return workflow::effort_of_grasp(request, watch);
      });
  return from_json(records::effort_json(result));
}

py::dict capacity(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::CapacityRequest request;
  request.product = product_choice(arguments.get("product"), reading_of(arguments));
  request.grasp = grasp_of(arguments);
  request.contact = contact_of(arguments, workflow::refined_contact_with_band());
  request.model = model_of(arguments);
  request.hand = hand_choice(arguments);
  arguments.take("friction", request.friction.friction);
  arguments.take("strength_n", request.strength);
  std::string person;
  if (arguments.take("person", person)) request.person = workflow::parse_person(person);
  arguments.take("about", request.torque_axis);
  request.wrist = wrist_of(arguments);
  arguments.finish();
  const workflow::Capacity found =
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        request.note = notes;
        return workflow::capacity_of_grip(request, watch);
      });
  const auto vector = [](const Vec3& v) { return py::make_tuple(v.x(), v.y(), v.z()); };
  return py::dict(py::arg("grip_force_n") = found.grip_force, py::arg("torque_n_mm") = found.torque,
                  py::arg("push_n") = found.push, py::arg("pull_n") = found.pull,
                  py::arg("torque_axis") = vector(found.torque_axis),
                  py::arg("limited_by") = found.limited_by,
                  py::arg("activation") = found.activation, py::arg("strength") = found.strength,
                  py::arg("friction") = found.friction, py::arg("axis") = vector(found.axis),
                  py::arg("grip") = found.grip, py::arg("hold") = found.hold,
                  py::arg("message") = found.message);
}

py::object fingertip(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::FingertipRequest request;
  std::string finger = "index", tendon = "all", posture;
  arguments.take("finger", finger);
  arguments.take("tendon", tendon);
  if (const py::object angles = arguments.get("posture_deg")) {
    for (const auto& [name, angle] : angles.cast<py::dict>()) {
      posture += (posture.empty() ? "" : ",") + py::str(name).cast<std::string>() + "=" +
                 py::str(angle).cast<std::string>();
    }
  }
  request.finger = workflow::parse_finger(finger);
  request.tendons = workflow::parse_tendons(request.finger, tendon);
  request.posture = workflow::parse_digit_posture(request.finger, posture);
  arguments.take("force_n", request.force);
  request.model = tendons_of(arguments);
  request.hand = hand_choice(arguments);
  arguments.finish();
  const workflow::FingertipOutcome outcome =
      run_task({progress, note}, [&](const Progress&, const workflow::NoteSink&) {
        return workflow::fingertip_forces(request);
      });
  return from_json(records::fingertip_json(outcome.forces, outcome.posture));
}

}  // namespace

void bind_effort(py::module_& module) {
  module.def("effort_grasp", &grasp, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("effort_capacity", &capacity, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
  module.def("effort_fingertip", &fingertip, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
}

}  // namespace palmar::python
