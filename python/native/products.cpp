// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/product/parametric_kinds.h"
#include "palmar/workflow/product_files.h"
#include "palmar/workflow/product_variants.h"
#include "task.h"

namespace palmar::python {
namespace {

std::shared_ptr<product::Product> read(py::dict given, const py::object& progress,
                                       const py::object& note) {
  Arguments arguments(std::move(given));
  const records::LoadProductOptions reading = reading_of(arguments);
  const workflow::ProductChoice choice = product_choice(arguments.get("file"), reading);
  arguments.finish();
  return for_python(
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        product::Product product = load_product(choice, watch);
        for (const std::string& text : product.notes) notes(product.name + ": " + text);
        return product;
      }));
}

std::shared_ptr<product::Product> make(py::dict given, const py::object& progress,
                                       const py::object& note) {
  Arguments arguments(std::move(given));
  records::MadeProduct made;
  arguments.take("kind", made.kind);
  const py::dict parameters = arguments.get("parameters");
  for (const auto& [name, value] : parameters) {
    Arguments one(parameters);
    double number = 0.0;
    const std::string key = name.cast<std::string>();
    if (one.take(key.c_str(), number)) made.given.emplace_back(key, number);
  }
  workflow::ProductVariantsRequest files;
  arguments.take("chordal_error_mm", files.chordal_error);
  workflow::ProductVariantsRequest::Entry entry{
      .name = title_of(made), .family = "", .product = made, .files = {}};
  arguments.take("out", entry.files);
  arguments.finish();
  product::complete_values(product::parametric_kind(made.kind), made.given);
  return for_python(
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink&) {
        if (!entry.files.empty()) {
          files.products.push_back(entry);
          workflow::write_variants(files, watch);
        }
        return records::make_solid(made, {.chordal_error = files.chordal_error});
      }));
}

py::dict check(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::InspectRequest request;
  request.reading = reading_of(arguments);
  arguments.take("file", request.file);
  arguments.finish();
  const workflow::InspectOutcome outcome =
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink&) {
        return workflow::inspect_product(request, watch);
      });
  const product::ProductCheck& found = outcome.check;
  py::dict result;
  result["product"] = for_python(outcome.product);
  result["verdict"] = name_of(found.verdict);
  py::list findings;
  for (const product::Finding& one : found.findings) {
    findings.append(py::make_tuple(name_of(one.severity), one.text));
  }
  result["findings"] = findings;
  result["triangles"] = found.triangles;
  result["vertices"] = found.vertices;
  result["parts"] = found.parts;
  result["is_closed"] = found.is_closed;
  result["holes"] = found.holes;
  result["crossing_pairs"] = found.crossing_pairs;
  result["volume_mm3"] = found.volume;
  result["area_mm2"] = found.area;
  result["size_mm"] = py::make_tuple(found.size.x(), found.size.y(), found.size.z());
  return result;
}

py::list kinds() {
  py::list all;
  for (const product::ParametricKind& kind : product::parametric_kinds()) {
    py::list parameters;
    for (const product::KindParameter& one : kind.parameters) {
      parameters.append(py::dict(py::arg("name") = one.name, py::arg("default") = one.fallback,
                                 py::arg("lowest") = one.lowest, py::arg("highest") = one.highest,
                                 py::arg("meaning") = one.meaning));
    }
    all.append(py::dict(py::arg("kind") = kind.name, py::arg("description") = kind.description,
                        py::arg("parameters") = parameters));
  }
  return all;
}

}  // namespace

void bind_products(py::module_& module) {
  module.def("product_read", &read, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("product_make", &make, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("product_check", &check, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("product_kinds", &kinds);
}

}  // namespace palmar::python
