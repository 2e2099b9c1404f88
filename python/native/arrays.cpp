// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "arrays.h"

#include <cmath>
#include <limits>
#include <optional>

#include "palmar/formats/text_scan.h"

namespace palmar::python {
namespace {

py::array read_only(py::array array) {
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <typename Scalar>
py::array rows_of_three(const Scalar* data, std::size_t rows, py::handle owner) {
  return read_only(py::array_t<Scalar>({rows, std::size_t{3}}, data, owner));
}

/// The column as numbers; nothing if a cell holds anything else, or none holds one.
std::optional<py::array> numbers_of(const std::vector<std::vector<std::string>>& rows,
                                    std::size_t column) {
  std::vector<double> values;
  values.reserve(rows.size());
  bool is_whole = true, has_value = false;
  for (const std::vector<std::string>& row : rows) {
    const std::string& cell = row[column];
    const std::optional<double> value =
        cell.empty() ? std::numeric_limits<double>::quiet_NaN() : formats::parse_double(cell);
    if (!value) return std::nullopt;
    is_whole = is_whole && formats::parse_integer(cell).has_value();
    has_value = has_value || !cell.empty();
    values.push_back(*value);
  }
  if (!has_value) return std::nullopt;
  if (!is_whole) return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
  py::array_t<std::int64_t> whole(static_cast<py::ssize_t>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    whole.mutable_at(static_cast<py::ssize_t>(i)) = *formats::parse_integer(rows[i][column]);
  }
  return whole;
}

}  // namespace

py::array view(const std::vector<Vec3>& values, py::handle owner) {
  return rows_of_three(reinterpret_cast<const double*>(values.data()), values.size(), owner);
}

py::array view(const std::vector<Triangle>& values, py::handle owner) {
  return rows_of_three(reinterpret_cast<const int*>(values.data()), values.size(), owner);
}

py::array view(const std::vector<double>& values, py::handle owner) {
  return read_only(
      py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}

py::array view(const std::vector<int>& values, py::handle owner) {
  return read_only(py::array_t<int>(static_cast<py::ssize_t>(values.size()), values.data(), owner));
}

py::dict table(const records::CsvTable& cells) {
  py::dict columns;
  for (std::size_t c = 0; c < cells.header.size(); ++c) {
    const py::str name(cells.header[c]);
    if (const auto numbers = numbers_of(cells.rows, c)) {
      columns[name] = *numbers;
      continue;
    }
    py::list texts;
    for (const std::vector<std::string>& row : cells.rows) texts.append(row[c]);
    columns[name] = py::module_::import("numpy").attr("array")(texts, py::arg("dtype") = "str");
  }
  return columns;
}

py::object from_json(const std::string& text) {
  return py::module_::import("json").attr("loads")(text);
}

}  // namespace palmar::python
