// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/body_repair.h"

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_DataMapOfShapeShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <cmath>

namespace palmar::cad {
namespace {

constexpr double kSewShare = 1e-5;  // of the size: 1 micrometre on a handle of 100 mm
constexpr double kLeastSew = 1e-5;  // mm

std::vector<TopoDS_Shape> faces_of(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, TopAbs_FACE, map);
  return {map.cbegin(), map.cend()};
}

double signed_volume(const TopoDS_Shape& solid) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(solid, properties);
  return properties.Mass();
}

double size_of(const std::vector<TopoDS_Face>& faces) {
  Bnd_Box box;
  for (const TopoDS_Face& face : faces) BRepBndLib::Add(face, box);
  if (box.IsVoid()) return 0.0;
  return std::sqrt(box.SquareExtent());
}

}  // namespace

RepairedBody repaired(const TopoDS_Shape& solid) {
  RepairedBody body;
  body.shape = solid;
  body.original_faces = faces_of(solid);
  body.is_solid = true;
  if (!BRepCheck_Analyzer(solid).IsValid()) {
    body.was_invalid = true;
    ShapeFix_Shape fix(solid);
    fix.Perform();
    const TopoDS_Shape fixed = fix.Shape();
    if (!fixed.IsNull() && fixed.ShapeType() == TopAbs_SOLID &&
        faces_of(fixed).size() == body.original_faces.size() &&
        BRepCheck_Analyzer(fixed).IsValid()) {
      body.shape = fixed;
      body.is_healed = true;
    }
  }
  if (signed_volume(body.shape) < 0.0) {
    body.shape.Reverse();
    body.is_turned = true;
  }
  return body;
}

std::vector<RepairedBody> sew(const std::vector<TopoDS_Face>& faces) {
  BRepBuilderAPI_Sewing sewing(std::max(kLeastSew, kSewShare * size_of(faces)));
  for (const TopoDS_Face& face : faces) sewing.Add(face);
  sewing.Perform();
  const TopoDS_Shape sewn = sewing.SewedShape();
  std::vector<RepairedBody> bodies;
  if (sewn.IsNull()) return bodies;
  TopTools_DataMapOfShapeShape original_of;
  for (const TopoDS_Face& face : faces) {
    original_of.Bind(sewing.ModifiedSubShape(face), face);  // itself if not modified
  }
  std::vector<TopoDS_Shape> pieces;
  for (TopExp_Explorer it(sewn, TopAbs_SHELL); it.More(); it.Next()) pieces.push_back(it.Current());
  for (TopExp_Explorer it(sewn, TopAbs_FACE, TopAbs_SHELL); it.More(); it.Next()) {
    pieces.push_back(it.Current());
  }
  for (const TopoDS_Shape& piece : pieces) {
    RepairedBody body;
    body.shape = piece;
    body.was_sewn = true;
    for (const TopoDS_Shape& face : faces_of(piece)) {
      const TopoDS_Shape* const found = original_of.Seek(face);
      body.original_faces.push_back(found != nullptr ? *found : TopoDS_Shape());
    }
    if (piece.ShapeType() == TopAbs_SHELL && BRep_Tool::IsClosed(piece)) {
      BRepBuilderAPI_MakeSolid maker(TopoDS::Shell(piece));
      if (maker.IsDone()) {
        body.shape = maker.Solid();
        body.is_solid = true;
        if (signed_volume(body.shape) < 0.0) body.shape.Reverse();
        body.was_invalid = !BRepCheck_Analyzer(body.shape).IsValid();
      }
    }
    bodies.push_back(std::move(body));
  }
  return bodies;
}

TopoDS_Shape placed(const TopoDS_Shape& shape, const TopLoc_Location& place, double scale) {
  const gp_Trsf move = place.Transformation();
  gp_Trsf all;
  all.SetScaleFactor(scale);
  all.Multiply(move);
  constexpr double kRigid = 1e-12;
  if (std::abs(all.ScaleFactor() - 1.0) < kRigid && !all.IsNegative()) return shape.Moved(place);
  // Mirrors and scales change the geometry itself.
  return BRepBuilderAPI_Transform(shape, all, Standard_True).Shape();
}

}  // namespace palmar::cad
