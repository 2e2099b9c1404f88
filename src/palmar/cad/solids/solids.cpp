// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/solids.h"

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <ShapeUpgrade_RemoveLocations.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <functional>
#include <map>
#include <memory>

#include "palmar/cad/model/occt_model.h"
#include "palmar/cad/solids/kind_makers.h"
#include "palmar/core/error.h"

namespace palmar {
namespace {

const std::map<std::string, std::function<NamedSolid(const KindValues&)>>& makers() {
  static const std::map<std::string, std::function<NamedSolid(const KindValues&)>> all = {
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

std::string with_values(const ParametricKind& kind, const KindValues& values) {
  std::string text = kind.name;
  for (const KindParameter& one : kind.parameters) {
    std::string number = std::to_string(values.at(one.name));
    number.erase(number.find_last_not_of('0') + 1);
    if (number.back() == '.') number.pop_back();
    text += " " + one.name + "=" + number;
  }
  return text;
}

/// "" if the shape is one valid, closed solid with something inside.
std::string what_is_wrong(const TopoDS_Shape& shape) {
  int solids = 0;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) ++solids;
  if (solids != 1) return std::to_string(solids) + " solids came out";
  for (TopExp_Explorer it(shape, TopAbs_SHELL); it.More(); it.Next()) {
    if (!BRep_Tool::IsClosed(it.Current())) return "its surface is open";
  }
  if (!BRepCheck_Analyzer(shape).IsValid()) return "its faces don't fit together";
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass() > 0.0 ? "" : "it has no volume";
}

/// The same without parts that are only moved: a STEP file has no names of those.
NamedSolid without_locations(const NamedSolid& made) {
  ShapeUpgrade_RemoveLocations flat;
  flat.Remove(made.shape);
  NamedSolid result{flat.GetResult(), {}};
  for (const NamedSolid::Name& one : made.names) {
    const TopoDS_Shape face = flat.ModifiedShape(one.face);
    if (!face.IsNull()) result.names.push_back({TopoDS::Face(face), one.text});
  }
  return result;
}

/// The solid with its faces in the order of their names.
TopoDS_Solid in_order(const NamedSolid& made) {
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  TopTools_IndexedMapOfShape faces;
  for (TopExp_Explorer it(made.shape, TopAbs_FACE); it.More(); it.Next()) faces.Add(it.Current());
  TopTools_MapOfShape done;
  const auto add = [&](const TopoDS_Shape& face) {
    if (done.Add(face)) builder.Add(shell, face);
  };
  for (const NamedSolid::Name& one : made.names) {
    const int index = faces.FindIndex(one.face);
    if (index > 0) add(faces(index));  // turned as the solid has it
  }
  for (int f = 1; f <= faces.Extent(); ++f) add(faces(f));
  shell.Closed(true);
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

}  // namespace

CadModel make_kind_solid(const ParametricKind& kind, const KindValues& values) {
  const auto refuse = [&](const std::string& why) -> NumericalError {
    return NumericalError(with_values(kind, values) + ": no solid can be made: " + why);
  };
  const auto maker = makers().find(kind.name);
  if (maker == makers().end()) throw refuse("its kind has no maker");
  NamedSolid made;
  try {
    made = without_locations(maker->second(values));
  } catch (const Standard_Failure& failure) {
    throw refuse(failure.DynamicType()->Name());
  } catch (const NumericalError& error) {
    throw refuse(error.what());
  }
  const std::string wrong = what_is_wrong(made.shape);
  if (!wrong.empty()) throw refuse(wrong);
  const TopoDS_Solid solid = in_order(made);

  const CadModel plain = make_cad_model(solid, kind.name);
  auto named = std::make_shared<CadModel::Impl>(plain.impl());
  for (const NamedSolid::Name& one : made.names) {
    const int number = named->faces.FindIndex(one.face);
    if (number > 0 && !one.text.empty()) named->face_name[number] = one.text;
  }
  return CadModel(std::move(named));
}

}  // namespace palmar
