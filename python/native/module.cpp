// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The module palmar._native: tasks of the layer workflow with their arguments in a dict. Python's
// own functions (python/palmar) stand over it; nobody else calls it.
#include <exception>

#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/program_folder.h"
#include "palmar/core/version.h"
#include "palmar/formats/process/program_missing.h"

namespace palmar::python {
namespace {

void raise(const char* name, const std::exception& error) {
  const py::object type = py::module_::import("palmar._errors").attr(name);
  PyErr_SetString(type.ptr(), error.what());
}

/// Every Error as the exception of the same kind; the kinds are those of the exit codes.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const Cancelled& error) {
    raise("Cancelled", error);
  } catch (const UsageError& error) {
    raise("UsageError", error);
  } catch (const InputError& error) {
    raise("InputError", error);
  } catch (const NumericalError& error) {
    raise("NumericalError", error);
  } catch (const CheckFailed& error) {
    raise("CheckFailed", error);
  } catch (const OutputError& error) {
    raise("OutputError", error);
  } catch (const formats::ProgramMissing& error) {
    raise("ProgramMissing", error);
  } catch (const Error& error) {
    raise("Error", error);
  }
}

}  // namespace
}  // namespace palmar::python

PYBIND11_MODULE(_native, module) {
  using namespace palmar::python;
  py::register_exception_translator(&palmar::python::translate);
  module.def("version", &palmar::version);
  module.def("build_description", &palmar::build_description);
  module.def("set_thread_count", &palmar::set_thread_count, py::arg("count"));
  module.def("thread_count", &palmar::thread_count);
  module.def(
      "set_program_folder", [](const std::string& folder) { palmar::set_program_folder(folder); },
      py::arg("folder"));
  palmar::python::bind_values(module);
  palmar::python::bind_assess(module);
  palmar::python::bind_products(module);
  palmar::python::bind_hands(module);
  palmar::python::bind_contact(module);
  palmar::python::bind_effort(module);
  palmar::python::bind_studies(module);
  palmar::python::bind_redesigns(module);
}
