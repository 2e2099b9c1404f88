// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"

namespace palmar::python {

namespace py = pybind11;

/// Keyword arguments of a task by their names; None counts as not given, so that defaults are those
/// of the request alone. A value of the wrong type is a TypeError that names the argument.
class Arguments {
 public:
  explicit Arguments(py::dict given) : given_(std::move(given)) {}

  /// Sets the value if the argument is given; returns whether it is.
  bool take(const char* name, double& value);
  bool take(const char* name, int& value);
  bool take(const char* name, bool& value);
  bool take(const char* name, std::string& value);            ///< also of os.PathLike
  bool take(const char* name, std::filesystem::path& value);  ///< the same
  bool take(const char* name, std::uint64_t& value);
  bool take(const char* name, Vec3& value);                      ///< three numbers
  bool take(const char* name, Box3& value);                      ///< two corners: six numbers
  bool take(const char* name, geometry::LengthUnit& value);      ///< "mm", "cm", "m", "inch"
  bool take(const char* name, Language& value);                  ///< "en", "de"
  bool take(const char* name, std::vector<double>& value);       ///< or one number
  bool take(const char* name, std::vector<std::string>& value);  ///< or one string
  bool take(const char* name, std::vector<Box3>& value);

  template <typename T>
  bool take(const char* name, std::optional<T>& value) {
    T one{};
    if (!take(name, one)) return false;
    value = one;
    return true;
  }
  /// The number times `factor`: kPa to MPa, degrees to radians.
  bool take(const char* name, double& value, double factor);
  bool take(const char* name, std::optional<double>& value, double factor);

  /// As it was given; a null handle if it wasn't.
  py::object get(const char* name);

  /// An argument that no take() asked for would be left out silently: throws UsageError naming it
  /// and what it doesn't go with.
  void finish(const std::string& beside = "the task doesn't take it") const;

 private:
  py::dict given_;
  std::vector<std::string> taken_;
};

}  // namespace palmar::python
