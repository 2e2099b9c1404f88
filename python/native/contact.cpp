// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/geometry/degrees.h"
#include "palmar/workflow/press.h"
#include "palmar/workflow/words/press_words.h"
#include "task.h"

namespace palmar::python {
namespace {

constexpr double kMegapascalsPerKilopascal = 1e-3;

workflow::PressRequest press_request(Arguments& arguments) {
  workflow::PressRequest request;
  contact::PressOptions& test = request.test;
  std::string specimen = "plane", indenter, level, cover, hand;
  arguments.take("specimen", specimen);
  test.specimen = workflow::parse_specimen(specimen, hand);
  arguments.take("indenter", indenter);
  test.indenter = workflow::parse_indenter(indenter);
  const bool has_depths = arguments.take("depth_mm", test.depths);
  const bool has_forces = arguments.take("force_n", test.forces);
  if (has_depths == has_forces) {
    throw UsageError(
        "either setting \"depth\" or setting \"force\" is needed, and only one of them");
  }
  arguments.take("tilt_deg", test.tilt, geometry::kDegree);
  arguments.take("spacing_mm", test.spacing);
  double cell = 0.0;
  if (arguments.take("cell_mm", cell)) {
    if (!(cell > 0.0 && cell <= 30.0)) {
      throw UsageError("setting \"cell\" is " + std::to_string(cell) +
                       "; more than 0 and at most 30 mm is required");
    }
    test.cell_area = cell * cell;
  }
  arguments.take("layer_mm", test.layer_thickness);
  arguments.take("poisson", test.poisson);
  if (arguments.take("coating", cover)) test.coating = workflow::parse_cover(cover);
  if (arguments.take("tissue_level", level))
    test.tissue_level = workflow::parse_tissue_level(level);
  arguments.take("shear_modulus_kpa", test.shear_modulus, kMegapascalsPerKilopascal);
  workflow::ContactModelWords words;
  arguments.take("preset", words.preset);
  arguments.take("kernel", words.kernel);
  arguments.take("tissue_model", words.tissue_model);
  request.model = workflow::press_model(words, test.layer_thickness, !hand.empty());
  request.hand.name = hand;
  arguments.take("tissue", request.hand.tissue);
  arguments.take("out", request.out);
  arguments.finish();
  return request;
}

py::dict press(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::PressRequest request = press_request(arguments);
  return table(run_task({progress, note}, [&](const Progress&, const workflow::NoteSink& notes) {
    request.note = notes;
    return records::press_table(workflow::run_press(request).steps);
  }));
}

}  // namespace

void bind_contact(py::module_& module) {
  module.def("contact_press", &press, py::arg("arguments"), py::arg("progress"), py::arg("note"));
}

}  // namespace palmar::python
