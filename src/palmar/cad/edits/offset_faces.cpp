// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/offset_faces.h"

#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepOffsetAPI_DraftAngle.hxx>
#include <BRepOffset_MakeOffset.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <gp_Pln.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Vec.hxx>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kSameWay = 0.9;     // rad; a taper tilts by less than 0.79, other faces lie across
constexpr double kTolerance = 1e-4;  // mm; of intersections, a tenth of what machines keep

std::string words_of(BRepOffset_Error error) {
  switch (error) {
    case BRepOffset_BadNormalsOnGeometry:
      return "a face has no normal somewhere";
    case BRepOffset_C0Geometry:
      return "a face has a kink inside";
    case BRepOffset_NullOffset:
      return "nothing moves";
    case BRepOffset_NotConnectedShell:
      return "the faces don't hang together";
    default:
      return "the moved faces and those beside don't meet";
  }
}

/// A point of a face, not at its rim, and the outward normal there.
struct FaceSample {
  gp_Pnt at;
  gp_Vec normal;
};

FaceSample sample_near(const TopoDS_Face& face, const gp_Pnt* target) {
  const BRepAdaptor_Surface surface(face);
  double u = 0.5 * (surface.FirstUParameter() + surface.LastUParameter());
  double v = 0.5 * (surface.FirstVParameter() + surface.LastVParameter());
  if (target != nullptr) {
    const gp_Pnt2d uv = ShapeAnalysis_Surface(BRep_Tool::Surface(face)).ValueOfUV(*target, 1e-6);
    u = uv.X();
    v = uv.Y();
  }
  BRepLProp_SLProps there(surface, u, v, 1, 1e-7);
  FaceSample sample{there.Value(), gp_Vec(0, 0, 0)};
  if (there.IsNormalDefined()) {
    sample.normal = gp_Vec(there.Normal()) * (face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0);
  }
  return sample;
}

/// A face that was moved through the body, or a cylinder through its axis, comes out with material
/// on its other side: valid, but not what was asked for.
bool is_turned_over(const TopoDS_Face& before, const std::vector<TopoDS_Face>& after,
                    double distance) {
  const FaceSample was = sample_near(before, nullptr);
  const gp_Pnt aim = was.at.Translated(was.normal * distance);
  return std::any_of(after.begin(), after.end(), [&](const TopoDS_Face& face) {
    return sample_near(face, &aim).normal.Dot(was.normal) < 0.0;
  });
}

/// The face of a tilted body that a face has become: nearest to a point in its middle, and facing
/// the same way.
TopTools_ListOfShape nearest_face(const TopoDS_Face& before,
                                  const TopTools_IndexedMapOfShape& made) {
  const FaceSample was = sample_near(before, nullptr);
  const TopoDS_Vertex point = BRepBuilderAPI_MakeVertex(was.at).Vertex();
  TopTools_ListOfShape nearest;
  double least = 0.0;
  for (int i = 1; i <= made.Extent(); ++i) {
    const TopoDS_Face face = TopoDS::Face(made(i));
    const FaceSample now = sample_near(face, &was.at);
    if (now.normal.Magnitude() == 0.0 || now.normal.Angle(was.normal) > kSameWay) continue;
    const BRepExtrema_DistShapeShape away(point, face);
    if (!away.IsDone() || (!nearest.IsEmpty() && away.Value() >= least)) continue;
    least = away.Value();
    nearest.Clear();
    nearest.Append(face);
  }
  return nearest;
}

}  // namespace

void offset_faces(SolidEdit& edit, const std::map<int, double>& distance,
                  const std::string& feature) {
  try_feature(feature, [&] {
    BRepOffset_MakeOffset offset;
    offset.Initialize(edit.solid, 0.0, kTolerance, BRepOffset_Skin, Standard_False, Standard_False,
                      GeomAbs_Intersection);
    bool moves = false;
    for (const auto& [number, by] : distance) {
      for (const TopoDS_Face& face : edit.image.at(number)) {
        offset.SetOffsetOnFace(face, by);
        moves = moves || by != 0.0;
      }
    }
    if (!moves) return;
    offset.MakeOffsetShape();
    if (!offset.IsDone() || offset.Error() != BRepOffset_NoError) {
      throw NumericalError(
          fmt::format("{}: can't be made ({})", feature, words_of(offset.Error())));
    }
    TopoDS_Shape made = offset.Shape();
    if (!made.IsNull() && made.ShapeType() == TopAbs_SHELL) {
      made = BRepBuilderAPI_MakeSolid(TopoDS::Shell(made)).Shape();
    }
    const TopoDS_Shape solid = checked_solid(made, feature);
    const std::map<int, std::vector<TopoDS_Face>> before = edit.image;
    edit.follow(solid, [&](const TopoDS_Face& face) {
      TopTools_ListOfShape images = offset.Modified(face);
      if (images.IsEmpty()) images = offset.Generated(face);
      return images;
    });
    for (const auto& [number, by] : distance) {
      if (edit.image.at(number).empty() ||
          is_turned_over(before.at(number).front(), edit.image.at(number), by)) {
        throw NumericalError(
            fmt::format("{}: can't be made (face {} vanishes or turns over)", feature, number));
      }
    }
  });
}

void taper_faces(SolidEdit& edit, const std::vector<int>& faces, double angle,
                 const gp_Ax1& neutral, const std::string& feature) {
  if (angle == 0.0) return;
  try_feature(feature, [&] {
    BRepOffsetAPI_DraftAngle draft(edit.solid);
    const gp_Pln plane(neutral.Location(), neutral.Direction());
    for (const int number : faces) {
      for (const TopoDS_Face& face : edit.image.at(number)) {
        draft.Add(face, neutral.Direction(), angle, plane);
        if (!draft.AddDone()) {
          throw NumericalError(fmt::format(
              "{}: can't be made (face {} is no plane, cylinder or cone along the taper)", feature,
              number));
        }
      }
    }
    draft.Build();
    if (!draft.IsDone()) {
      throw NumericalError(feature + ": can't be made (the tilted faces don't meet)");
    }
    const TopoDS_Shape solid = checked_solid(draft.Shape(), feature);
    // The history speaks of faces that the kernel replaced once more: found again by their place.
    TopTools_IndexedMapOfShape made;
    TopExp::MapShapes(solid, TopAbs_FACE, made);
    edit.follow(solid, [&](const TopoDS_Face& face) { return nearest_face(face, made); });
  });
}

}  // namespace palmar::cad
