// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "palmar/geometry/types.h"
#include "palmar/records/csv.h"

namespace palmar::python {

namespace py = pybind11;

// NumPy arrays that look at values which `owner` keeps alive: no copy, read-only.

py::array view(const std::vector<Vec3>& values, py::handle owner);      ///< n x 3
py::array view(const std::vector<Triangle>& values, py::handle owner);  ///< n x 3, int32
py::array view(const std::vector<double>& values, py::handle owner);    ///< n
py::array view(const std::vector<int>& values, py::handle owner);       ///< n, int32

/// A table as dict of columns: numbers where all cells are (empty ones: nan), else text.
py::dict table(const records::CsvTable& cells);

/// A JSON text as Python has it.
py::object from_json(const std::string& text);

}  // namespace palmar::python
