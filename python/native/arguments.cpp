// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "arguments.h"

#include <algorithm>

#include "palmar/core/error.h"

namespace palmar::python {
namespace {

[[noreturn]] void refuse(const std::string& name, py::handle value, const std::string& needed) {
  throw py::type_error(name + " is " + std::string(py::repr(value)) + "; " + needed +
                       " is required");
}

double number_in(const std::string& name, py::handle value, const std::string& needed) {
  const double number = PyFloat_AsDouble(value.ptr());
  if (PyErr_Occurred() == nullptr) return number;
  PyErr_Clear();
  refuse(name, value, needed);
}

std::string text_in(const std::string& name, py::handle value) {
  PyObject* const path = PyOS_FSPath(value.ptr());
  if (path == nullptr) {
    PyErr_Clear();
    refuse(name, value, "a string or a path");
  }
  return py::reinterpret_steal<py::object>(path).cast<std::string>();
}

/// The items of a sequence, or the one value if it is none. A string is one value.
std::vector<py::object> items_in(py::handle value) {
  std::vector<py::object> items;
  if (py::isinstance<py::str>(value) || !py::hasattr(value, "__iter__")) {
    items.push_back(py::reinterpret_borrow<py::object>(value));
    return items;
  }
  for (const py::handle item : value) items.push_back(py::reinterpret_borrow<py::object>(item));
  return items;
}

std::vector<double> numbers_in(const std::string& name, py::handle value,
                               const std::string& needed) {
  std::vector<double> numbers;
  for (const py::object& item : items_in(value)) numbers.push_back(number_in(name, item, needed));
  return numbers;
}

Box3 box_in(const std::string& name, py::handle value) {
  const std::string needed = "two corners of a box in mm (x0, y0, z0, x1, y1, z1)";
  const std::vector<double> v = numbers_in(name, value, needed);
  if (v.size() != 6) refuse(name, value, needed);
  Box3 box;
  box.extend(Vec3(v[0], v[1], v[2])).extend(Vec3(v[3], v[4], v[5]));
  return box;
}

}  // namespace

py::object Arguments::get(const char* name) {
  taken_.emplace_back(name);
  if (!given_.contains(name)) return {};
  py::object value = given_[name];
  return value.is_none() ? py::object() : value;
}

bool Arguments::take(const char* name, double& value) {
  const py::object given = get(name);
  if (given) value = number_in(name, given, "a number");
  return static_cast<bool>(given);
}

bool Arguments::take(const char* name, double& value, double factor) {
  double one = 0.0;
  if (!take(name, one)) return false;
  value = one * factor;
  return true;
}

bool Arguments::take(const char* name, std::optional<double>& value, double factor) {
  double one = 0.0;
  if (!take(name, one)) return false;
  value = one * factor;
  return true;
}

bool Arguments::take(const char* name, int& value) {
  const py::object given = get(name);
  if (!given) return false;
  try {
    value = given.cast<int>();
  } catch (const py::cast_error&) {
    refuse(name, given, "a whole number");
  }
  return true;
}

bool Arguments::take(const char* name, std::uint64_t& value) {
  const py::object given = get(name);
  if (!given) return false;
  try {
    value = given.cast<std::uint64_t>();
  } catch (const py::cast_error&) {
    refuse(name, given, "a whole number from 0");
  }
  return true;
}

bool Arguments::take(const char* name, bool& value) {
  const py::object given = get(name);
  if (!given) return false;
  if (!py::isinstance<py::bool_>(given)) refuse(name, given, "True or False");
  value = given.cast<bool>();
  return true;
}

bool Arguments::take(const char* name, std::string& value) {
  const py::object given = get(name);
  if (given) value = text_in(name, given);
  return static_cast<bool>(given);
}

bool Arguments::take(const char* name, std::filesystem::path& value) {
  std::string text;
  if (!take(name, text)) return false;
  value = text;
  return true;
}

bool Arguments::take(const char* name, Vec3& value) {
  const py::object given = get(name);
  if (!given) return false;
  const std::vector<double> v = numbers_in(name, given, "three numbers (x, y, z)");
  if (v.size() != 3) refuse(name, given, "three numbers (x, y, z)");
  value = Vec3(v[0], v[1], v[2]);
  return true;
}

bool Arguments::take(const char* name, Box3& value) {
  const py::object given = get(name);
  if (given) value = box_in(name, given);
  return static_cast<bool>(given);
}

bool Arguments::take(const char* name, geometry::LengthUnit& value) {
  std::string text;
  if (!take(name, text)) return false;
  value = geometry::length_unit(text);
  return true;
}

bool Arguments::take(const char* name, Language& value) {
  std::string text;
  if (!take(name, text)) return false;
  value = language_named(text);
  return true;
}

bool Arguments::take(const char* name, std::vector<double>& value) {
  const py::object given = get(name);
  if (given) value = numbers_in(name, given, "numbers");
  return static_cast<bool>(given);
}

bool Arguments::take(const char* name, std::vector<std::string>& value) {
  const py::object given = get(name);
  if (!given) return false;
  value.clear();
  for (const py::object& item : items_in(given)) {
    // Faces have numbers, too.
    value.push_back(text_in(name, py::isinstance<py::int_>(item) ? py::str(item) : item));
  }
  return true;
}

bool Arguments::take(const char* name, std::vector<Box3>& value) {
  const py::object given = get(name);
  if (!given) return false;
  value.clear();
  for (const py::object& item : items_in(given)) value.push_back(box_in(name, item));
  return true;
}

void Arguments::finish(const std::string& beside) const {
  for (const auto& [name, value] : given_) {
    const std::string text = name.cast<std::string>();
    if (std::find(taken_.begin(), taken_.end(), text) == taken_.end() && !value.is_none()) {
      throw UsageError("setting \"" + text + "\" doesn't go with the others: " + beside);
    }
  }
}

}  // namespace palmar::python
