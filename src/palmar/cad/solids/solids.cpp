// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/solids.h"

#include <Standard_Failure.hxx>
#include <functional>
#include <map>

#include "palmar/cad/solids/finished_solid.h"
#include "palmar/cad/solids/kind_makers.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

const std::map<std::string, std::function<NamedSolid(const product::KindValues&)>>& makers() {
  static const std::map<std::string, std::function<NamedSolid(const product::KindValues&)>> all = {
      {"cylinder", make_cylinder},
      {"elliptic_handle", make_elliptic_handle},
      {"tapered_handle", make_tapered_handle},
      {"prism", make_prism},
      {"bottle", make_bottle},
      {"bicycle_grip", make_bicycle_grip},
      {"pistol_grip", make_pistol_grip},
      {"phone", make_phone},
      {"knife_handle", make_knife_handle},
      {"screwdriver_handle", make_screwdriver_handle},
      {"sphere", make_sphere},
      {"ellipsoid", make_ellipsoid}};
  return all;
}

std::string with_values(const product::ParametricKind& kind, const product::KindValues& values) {
  std::string text = kind.name;
  for (const product::KindParameter& one : kind.parameters) {
    std::string number = std::to_string(values.at(one.name));
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    text += " " + one.name + "=" + number;
  }
  return text;
}

}  // namespace

CadModel make_kind_solid(const product::ParametricKind& kind, const product::KindValues& values) {
  const auto refuse = [&](const std::string& why) -> NumericalError {
    return NumericalError(with_values(kind, values) + ": no solid can be made: " + why);
  };
  const auto maker = makers().find(kind.name);
  if (maker == makers().end()) throw refuse("its kind has no maker");
  try {
    return finished_solid(maker->second(values), kind.name);
  } catch (const Standard_Failure& failure) {
    throw refuse(failure.DynamicType()->Name());
  } catch (const NumericalError& error) {
    throw refuse(error.what());
  }
}

}  // namespace palmar::cad
