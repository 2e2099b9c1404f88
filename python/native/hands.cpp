// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/population/built_in_populations.h"
#include "palmar/records/population/hand_sample_table.h"
#include "palmar/records/population/population_file.h"
#include "palmar/workflow/population/population_sample.h"
#include "palmar/workflow/population/table_correlate.h"
#include "palmar/workflow/population/table_describe.h"
#include "palmar/workflow/population/table_regress.h"
#include "task.h"

namespace palmar::python {
namespace {

std::shared_ptr<hand::Hand> load(py::dict given, const py::object& progress,
                                 const py::object& note) {
  Arguments arguments(std::move(given));
  std::string person;
  arguments.take("person", person);
  const workflow::HandChoice choice = hand_choice(arguments, person);
  arguments.finish();
  return for_python(run_task({progress, note}, [&](const Progress&, const workflow::NoteSink&) {
    return workflow::load_hand(choice);
  }));
}

py::dict sample(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::PopulationSampleRequest request;
  population::SamplingOptions& sampling = request.sampling;
  arguments.take("population", request.population);
  std::string design = name_of(sampling.design);
  arguments.take("design", design);
  const auto named = population::sampling_design_named(design);
  if (!named) {
    throw UsageError("setting \"design\": \"" + design +
                     "\" is not known; random, latin_hypercube, boundary or percentiles is "
                     "allowed");
  }
  sampling.design = *named;
  arguments.take("hands", sampling.hands);
  arguments.take("seed", sampling.seed);
  arguments.take("residuals", sampling.residuals);
  arguments.take("boundary_share", sampling.boundary);
  arguments.take("boundary_points", sampling.boundary_points);
  arguments.take("percentiles", sampling.percentiles);
  arguments.take("out", request.out);
  arguments.finish();
  const workflow::PopulationSampleOutcome outcome =
      run_task({progress, note}, [&](const Progress&, const workflow::NoteSink& notes) {
        request.note = notes;
        return workflow::sample_population(request);
      });
  return table(records::hand_sample_table(outcome.hands));
}

workflow::TableChoice table_choice(Arguments& arguments) {
  workflow::TableChoice choice;
  arguments.take("file", choice.file);
  arguments.take("unit", choice.unit);
  arguments.take("where", choice.conditions);
  arguments.take("by", choice.by);
  arguments.take("dimension", choice.columns);
  return choice;
}

py::dict describe(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::TableDescribeRequest request{.table = table_choice(arguments)};
  arguments.take("out", request.out);
  arguments.finish();
  return table(run_task({progress, note}, [&](const Progress&, const workflow::NoteSink& notes) {
    request.note = notes;
    return records::descriptions_csv(workflow::describe_table(request));
  }));
}

py::dict correlate(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::TableCorrelateRequest request{.table = table_choice(arguments)};
  arguments.take("confidence", request.level);
  arguments.take("out", request.out);
  arguments.finish();
  return table(run_task({progress, note}, [&](const Progress&, const workflow::NoteSink& notes) {
    request.note = notes;
    return records::correlations_csv(workflow::correlate_table(request));
  }));
}

py::dict regress(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::TableRegressRequest request{.table = table_choice(arguments)};
  arguments.take("on", request.predictors);
  arguments.take("confidence", request.level);
  arguments.take("out", request.out);
  arguments.take("population_out", request.population_out);
  arguments.take("name", request.name);
  arguments.take("title", request.title);
  arguments.finish();
  return table(run_task({progress, note}, [&](const Progress&, const workflow::NoteSink& notes) {
    request.note = notes;
    return records::regressions_csv(workflow::regress_table(request).regressions);
  }));
}

}  // namespace

void bind_hands(py::module_& module) {
  module.def("hand_load", &load, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("population_names", [] {
    py::dict names;
    for (const population::Population& one : population::built_in_populations())
      names[py::str(one.name)] = one.title;
    return names;
  });
  module.def(
      "population_show",
      [](const std::string& name_or_path) {
        return from_json(records::population_json(records::load_population(name_or_path)));
      },
      py::arg("name_or_path"));
  module.def("population_sample", &sample, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
  module.def("population_describe", &describe, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
  module.def("population_correlate", &correlate, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
  module.def("population_regress", &regress, py::arg("arguments"), py::arg("progress"),
             py::arg("note"));
}

}  // namespace palmar::python
