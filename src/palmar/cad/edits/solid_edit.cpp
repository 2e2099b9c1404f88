// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/solid_edit.h"

#include <fmt/format.h>

#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRepLib.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Solid.hxx>

#include "palmar/core/error.h"

namespace palmar::cad {

void SolidEdit::follow(const TopoDS_Shape& next,
                       const std::function<TopTools_ListOfShape(const TopoDS_Face&)>& images_of) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(next, TopAbs_FACE, faces);
  for (auto& [number, images] : image) {
    std::vector<TopoDS_Face> after;
    const auto add = [&](const TopoDS_Shape& face) {
      const int at = faces.FindIndex(face);
      if (at > 0) after.push_back(TopoDS::Face(faces(at)));
    };
    for (const TopoDS_Face& face : images) {
      const TopTools_ListOfShape became = images_of(face);
      if (became.IsEmpty()) add(face);
      for (const TopoDS_Shape& one : became) add(one);
    }
    images = std::move(after);
  }
  solid = next;
}

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

TopoDS_Shape checked_solid(const TopoDS_Shape& shape, const std::string& feature) {
  if (shape.IsNull()) throw NumericalError(feature + ": can't be made (nothing comes out)");
  TopTools_IndexedMapOfShape solids;
  TopExp::MapShapes(shape, TopAbs_SOLID, solids);
  if (solids.Extent() != 1) {
    throw NumericalError(fmt::format("{}: can't be made ({} solids come out; one is needed)",
                                     feature, solids.Extent()));
  }
  TopoDS_Solid solid = TopoDS::Solid(solids(1));
  if (volume_of(solid) < 0.0) BRepLib::OrientClosedSolid(solid);
  for (TopExp_Explorer it(solid, TopAbs_SHELL); it.More(); it.Next()) {
    if (!BRep_Tool::IsClosed(it.Current())) {
      throw NumericalError(feature + ": can't be made (the shell that comes out is open)");
    }
  }
  if (!BRepCheck_Analyzer(solid).IsValid()) {
    throw NumericalError(feature + ": can't be made (what comes out is not a valid solid)");
  }
  if (!(volume_of(solid) > 0.0)) {
    throw NumericalError(feature + ": can't be made (no volume is left)");
  }
  return solid;
}

void try_feature(const std::string& feature, const std::function<void()>& step) {
  try {
    step();
  } catch (const Standard_Failure& failure) {
    throw NumericalError(
        fmt::format("{}: can't be made ({})", feature, failure.DynamicType()->Name()));
  }
}

}  // namespace palmar::cad
