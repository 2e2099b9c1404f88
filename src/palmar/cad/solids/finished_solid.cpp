// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/solids/finished_solid.h"

#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <ShapeUpgrade_RemoveLocations.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <memory>

#include "palmar/cad/model/occt_model.h"
#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

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

NamedSolid moved(const NamedSolid& made, const geometry::Rigid3& to) {
  const Quat& q = to.rotation;
  gp_Trsf way;
  way.SetTransformation(gp_Quaternion(q.x(), q.y(), q.z(), q.w()),
                        gp_Vec(to.translation.x(), to.translation.y(), to.translation.z()));
  BRepBuilderAPI_Transform transform(made.shape, way, true);
  NamedSolid result{transform.Shape(), {}};
  for (const NamedSolid::Name& one : made.names) {
    result.names.push_back({TopoDS::Face(transform.ModifiedShape(one.face)), one.text});
  }
  return result;
}

}  // namespace

CadModel finished_solid(const NamedSolid& made, const std::string& name,
                        const geometry::Rigid3& to) {
  const bool stays = to.rotation.isApprox(Quat::Identity()) && to.translation.isZero();
  const NamedSolid flat = without_locations(stays ? made : moved(made, to));
  const std::string wrong = what_is_wrong(flat.shape);
  if (!wrong.empty()) throw NumericalError(wrong);
  const CadModel plain = make_cad_model(in_order(flat), name);
  auto named = std::make_shared<CadModel::Impl>(plain.impl());
  for (const NamedSolid::Name& one : flat.names) {
    const int number = named->faces.FindIndex(one.face);
    if (number > 0 && !one.text.empty()) named->face_name[number] = one.text;
  }
  return CadModel(std::move(named));
}

}  // namespace palmar::cad
