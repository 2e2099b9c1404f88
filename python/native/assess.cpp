// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/records/assessment/assessment_json.h"
#include "palmar/records/project_file.h"
#include "palmar/workflow/assess.h"
#include "task.h"

namespace palmar::python {
namespace {

using OutcomeValue = std::shared_ptr<workflow::AssessOutcome>;

/// One product of an outcome, which it keeps alive.
struct OneAssessed {
  OutcomeValue outcome;
  std::size_t index = 0;
  const study::AssessedProduct& get() const { return outcome->set.assessments[index]; }
  const study::Assessment& assessment() const { return get().assessment; }
  const contact::ContactResult& contact() const { return assessment().contact; }
};

workflow::AssessRequest assess_request(Arguments& arguments) {
  workflow::AssessRequest request;
  const records::LoadProductOptions reading = reading_of(arguments);
  for (const py::handle product : arguments.get("products")) {
    request.products.push_back(product_choice(product, reading));
  }
  std::string person, preset;
  arguments.take("person", person);
  arguments.take("preset", preset);
  request.grasp = grasp_of(arguments);
  request.contact = contact_of(arguments, request.contact);
  request.model = model_of(arguments);
  request.friction = friction_of(arguments);
  request.rest = rest_of(arguments, person);
  // The thesis leaves the hand as it was closed.
  if (preset == "xie2014" && request.rest.is_usual()) request.rest.is_balanced = false;
  request.hand = hand_choice(arguments, person);
  arguments.take("natural_postures", request.natural_postures);
  arguments.take("sensors", request.sensors);
  arguments.take("measured", request.measured);
  arguments.take("error_budget", request.error_budget);
  arguments.take("out", request.out);
  arguments.take("pictures", request.pictures);
  arguments.take("language", request.language);
  std::string project;
  if (arguments.take("project", project)) request.extras.project = records::read_project(project);
  arguments.take("excel", request.extras.excel);
  arguments.take("seed", request.seed);
  arguments.take("command_line", request.command_line);
  arguments.finish();
  return request;
}

OutcomeValue assess(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::AssessRequest request = assess_request(arguments);
  workflow::AssessOutcome outcome =
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        request.note = notes;
        return workflow::assess_products(request, watch);
      });
  return for_python(std::move(outcome));
}

/// A view of a field that the assessment keeps.
template <typename Field>
auto field(Field get) {
  return [get](const py::object& self) { return view(get(self.cast<const OneAssessed&>()), self); };
}

template <typename Number>
auto number(Number get) {
  return [get](const OneAssessed& one) { return get(one); };
}

void bind_one(py::module_& module) {
  py::class_<OneAssessed>(
      module, "Assessment",
      "One product in one hand: grasp, contact, what it comes to. Fields per vertex of the skin\n"
      "(hand.skin_vertices_mm) and of the product's map are read-only views, without a copy.")
      .def_property_readonly(
          "product",
          [](const OneAssessed& one) {
            return for_python(
                std::shared_ptr<const product::Product>(one.outcome, &one.get().product));
          },
          "The product.")
      .def_property_readonly(
          "hand", [](const OneAssessed& one) { return for_python(one.outcome->set.hand); },
          "The hand.")
      .def_property_readonly(
          "status", [](const OneAssessed& one) { return name_of(one.assessment().grasp.status); },
          "\"held\", \"partly_held\", \"too_large\", \"too_small\", \"not_graspable\".")
      .def_property_readonly(
          "message", [](const OneAssessed& one) { return one.assessment().grasp.message; },
          "One sentence on the grasp: why it isn't held, which fingers are open.")
      .def_property_readonly(
          "hold", [](const OneAssessed& one) { return one.assessment().grasp.hold_words; },
          "How it is held: \"medium wrap of the handle, 40 % along it\".")
      .def_property_readonly(
          "grip_force_n", number([](const auto& one) { return study::grip_force_of(one.get()); }),
          "Grip force as a dynamometer reads it, N.")
      .def_property_readonly("force_n",
                             number([](const auto& one) { return one.contact().total.force; }),
                             "Sum of the normal forces of the skin, N.")
      .def_property_readonly("contact_area_mm2",
                             number([](const auto& one) { return one.contact().total.area; }),
                             "Area in contact on the product, mm2.")
      .def_property_readonly("peak_pressure_mpa", number([](const auto& one) {
                               return one.contact().total.peak_pressure;
                             }),
                             "Largest pressure of one vertex, MPa.")
      .def_property_readonly(
          "peak_pressure_cells_mpa",
          number([](const auto& one) { return one.contact().total.peak_pressure_cells; }),
          "Largest mean over a sensor cell of 24 mm2 (Xie 2014: 4.2 cells/cm2), MPa.")
      .def_property_readonly("mean_pressure_mpa", number([](const auto& one) {
                               return one.contact().total.mean_pressure;
                             }),
                             "Force over area, MPa.")
      .def_property_readonly(
          "skin_mm", field([](const auto& one) -> auto& { return one.contact().undeformed; }),
          "Posed skin before contact, n x 3, mm, product frame.")
      .def_property_readonly("deformed_skin_mm",
                             field([](const auto& one) -> auto& { return one.contact().deformed; }),
                             "Skin after contact, n x 3, mm, product frame.")
      .def_property_readonly(
          "distance_mm", field([](const auto& one) -> auto& { return one.contact().distance; }),
          "Signed distance of the skin to the product before contact, n, mm; negative inside.")
      .def_property_readonly(
          "displacement_mm",
          field([](const auto& one) -> auto& { return one.contact().displacement; }),
          "Displacement of the skin, n, mm: positive into the hand, negative a bulge.")
      .def_property_readonly("skin_force_n",
                             field([](const auto& one) -> auto& { return one.contact().force; }),
                             "Force on each vertex of the skin, n, N.")
      .def_property_readonly("skin_pressure_mpa",
                             field([](const auto& one) -> auto& { return one.contact().pressure; }),
                             "Force over area on the product, n, MPa.")
      .def_property_readonly(
          "map_vertices_mm", field([](const auto& one) -> auto& {
            return one.assessment().footprint.surface.vertices;
          }),
          "The product's surface, refined where it is touched: k x 3, mm, product frame.")
      .def_property_readonly("map_triangles", field([](const auto& one) -> auto& {
                               return one.assessment().footprint.surface.triangles;
                             }),
                             "Corner indices of that surface.")
      .def_property_readonly(
          "map_pressure_mpa",
          field([](const auto& one) -> auto& { return one.assessment().footprint.pressure; }),
          "Pressure on each vertex of that surface, k, MPa; 0 where it isn't touched.")
      .def("__repr__", [](const OneAssessed& one) {
        return "<palmar.Assessment of " + one.get().product.name + ": " +
               name_of(one.assessment().grasp.status) + ">";
      });
}

}  // namespace

void bind_assess(py::module_& module) {
  bind_one(module);
  py::class_<workflow::AssessOutcome, OutcomeValue>(module, "AssessOutcome")
      .def("__len__",
           [](const workflow::AssessOutcome& outcome) { return outcome.set.assessments.size(); })
      .def(
          "one",
          [](const OutcomeValue& outcome, std::size_t index) {
            return OneAssessed{outcome, index};
          },
          py::arg("index"))
      .def_property_readonly(
          "record",
          [](const workflow::AssessOutcome& outcome) {
            return from_json(records::assessment_json(outcome.set, outcome.words));
          })
      .def_property_readonly(
          "sentence", [](const workflow::AssessOutcome& outcome) { return outcome.words.sentence; })
      .def_property_readonly(
          "reasons", [](const workflow::AssessOutcome& outcome) { return outcome.words.reasons; })
      .def_readonly("folder", &workflow::AssessOutcome::folder)
      .def_readonly("has_converged", &workflow::AssessOutcome::has_converged)
      .def("regions",
           [](const workflow::AssessOutcome& outcome) {
             return table(records::region_table(outcome.set));
           })
      .def("indices",
           [](const workflow::AssessOutcome& outcome) {
             return table(records::index_table(outcome.set));
           })
      .def("faces",
           [](const workflow::AssessOutcome& outcome) {
             return table(records::face_table(outcome.set));
           })
      .def("sensors", [](const workflow::AssessOutcome& outcome) {
        return table(records::sensor_table(outcome.set));
      });
  module.def("assess", &assess, py::arg("arguments"), py::arg("progress"), py::arg("note"));
}

}  // namespace palmar::python
