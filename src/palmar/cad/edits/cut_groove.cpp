// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/edits/cut_groove.h"

#include <fmt/format.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Section.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Tool.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GCPnts_UniformAbscissa.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_Surface.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>
#include <gp_Pnt2d.hxx>
#include <vector>

#include "palmar/core/error.h"

namespace palmar::cad {
namespace {

constexpr double kNear = 5.0;     // mm; points of a line farther from the surface aren't on it
constexpr double kOnEdge = 1e-4;  // mm; nearer than this both faces are equally near
constexpr double kCutterSpacing = 3.0;  // mm; between the cutter's places
constexpr double kCutterRise = 0.5;     // mm; the cutter's end above the surface
constexpr double kSpineError = 1e-3;    // mm
constexpr int kCurvatureTests = 200;

gp_Pnt point_of(const Vec3& at) { return {at.x(), at.y(), at.z()}; }

/// Nearest point of the surface and the outward normal there; on an edge between both faces'.
struct FootPoint {
  gp_Pnt at;
  gp_Vec normal;
};

std::string words_of(const gp_Pnt& at) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g}) mm", at.X(), at.Y(), at.Z());
}

FootPoint foot_of(const TopoDS_Shape& solid, const gp_Pnt& point, const std::string& title) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(solid, TopAbs_FACE, faces);
  FootPoint foot;
  double least = kNear;
  for (int i = 1; i <= faces.Extent(); ++i) {
    const TopoDS_Face face = TopoDS::Face(faces(i));
    const BRepExtrema_DistShapeShape onto(BRepBuilderAPI_MakeVertex(point).Vertex(), face);
    if (!onto.IsDone() || onto.NbSolution() == 0 || onto.Value() > least + kOnEdge) continue;
    if (onto.Value() < least - kOnEdge) foot.normal = gp_Vec(0, 0, 0);
    least = std::min(least, onto.Value());
    foot.at = onto.PointOnShape2(1);
    ShapeAnalysis_Surface surface(BRep_Tool::Surface(face));
    const gp_Pnt2d uv = surface.ValueOfUV(foot.at, 1e-6);
    BRepLProp_SLProps there(BRepAdaptor_Surface(face), uv.X(), uv.Y(), 1, 1e-7);
    if (!there.IsNormalDefined()) continue;
    foot.normal += gp_Vec(there.Normal()) * (face.Orientation() == TopAbs_REVERSED ? -1.0 : 1.0);
  }
  if (foot.normal.Magnitude() < 1e-9) {
    throw NumericalError(fmt::format("{}: the surface has no normal near {} (farther than {} mm?)",
                                     title, words_of(point), kNear));
  }
  foot.normal.Normalize();
  return foot;
}

Handle(Geom_BSplineCurve) closed_through(const std::vector<gp_Pnt>& points) {
  const Handle(TColgp_HArray1OfPnt) all =
      new TColgp_HArray1OfPnt(1, static_cast<int>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) all->SetValue(static_cast<int>(i) + 1, points[i]);
  GeomAPI_Interpolate through(all, Standard_True, 1e-6);
  through.Perform();
  return through.IsDone() ? through.Curve() : Handle(Geom_BSplineCurve)();
}

Handle(Geom_BSplineCurve) open_near(const std::vector<gp_Pnt>& points, double tolerance) {
  TColgp_Array1OfPnt all(1, static_cast<int>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) all.SetValue(static_cast<int>(i) + 1, points[i]);
  const GeomAPI_PointsToBSpline near(all, 3, 8, GeomAbs_C2, tolerance);
  return near.IsDone() ? near.Curve() : Handle(Geom_BSplineCurve)();
}

/// Points along a curve, about kCutterSpacing apart; of a closed one without the last, which is the
/// first.
std::vector<gp_Pnt> points_along(const Handle(Geom_BSplineCurve) & curve, bool is_closed) {
  const GeomAdaptor_Curve adaptor(curve);
  const double length = GCPnts_AbscissaPoint::Length(adaptor);
  const int count =
      std::max(is_closed ? 12 : 4, static_cast<int>(std::lround(length / kCutterSpacing)) + 1);
  const GCPnts_UniformAbscissa even(adaptor, count);
  std::vector<gp_Pnt> points;
  for (int i = 1; even.IsDone() && i <= even.NbPoints(); ++i) {
    points.push_back(curve->Value(even.Parameter(i)));
  }
  if (is_closed && !points.empty()) points.pop_back();
  return points;
}

/// Lifts the cutter out of the surface beyond the last of its places: along a parabola as bent as
/// twice the cutter, until it is clear.
void run_out(std::vector<gp_Pnt>& centres, const gp_Vec& normal, const GrooveEdit& groove) {
  const gp_Pnt last = centres.back();
  const gp_Vec way = gp_Vec(centres[centres.size() - 2], last).Normalized();
  const double bend = 2 * groove.radius;
  const double run = std::sqrt(2 * bend * (groove.depth + kCutterRise));
  const int steps = std::max(3, static_cast<int>(std::ceil(run / kCutterSpacing)));
  for (int i = 1; i <= steps; ++i) {
    const double s = run * i / steps;
    centres.push_back(last.Translated(way * s + normal * (s * s / (2 * bend))));
  }
}

double sharpest_radius(const Handle(Geom_BSplineCurve) & curve) {
  double least = 1e9;
  for (int i = 0; i <= kCurvatureTests; ++i) {
    const double share = static_cast<double>(i) / kCurvatureTests;
    gp_Pnt at;
    gp_Vec first, second;
    curve->D2(curve->FirstParameter() * (1 - share) + curve->LastParameter() * share, at, first,
              second);
    const double speed = first.Magnitude();
    const double bend = first.Crossed(second).Magnitude();
    if (bend > 1e-12) least = std::min(least, speed * speed * speed / bend);
  }
  return least;
}

TopoDS_Shape bar_along(const TopoDS_Shape& solid, const GrooveEdit& groove) {
  const std::string title = groove.title();
  std::vector<gp_Pnt> line_points;
  for (const Vec3& point : groove.points) line_points.push_back(point_of(point));
  const Handle(Geom_BSplineCurve) smooth =
      groove.is_closed ? closed_through(line_points) : open_near(line_points, groove.smoothing);
  if (smooth.IsNull()) throw NumericalError(title + ": no smooth line goes through its points");
  const std::vector<gp_Pnt> along = points_along(smooth, groove.is_closed);
  std::vector<gp_Pnt> centres;
  std::vector<gp_Vec> normals;
  for (const gp_Pnt& point : along) {
    const FootPoint foot = foot_of(solid, point, title);
    normals.push_back(foot.normal);
    centres.push_back(foot.at.Translated(foot.normal * (groove.radius - groove.depth)));
  }
  if (centres.size() < 3) throw NumericalError(title + ": its line is too short");
  if (!groove.is_closed) {
    run_out(centres, normals.back(), groove);
    std::reverse(centres.begin(), centres.end());
    run_out(centres, normals.front(), groove);
  }
  const Handle(Geom_BSplineCurve) spine =
      groove.is_closed ? closed_through(centres) : open_near(centres, kSpineError);
  if (spine.IsNull()) throw NumericalError(title + ": no smooth line goes through its points");
  const double bend = sharpest_radius(spine);
  if (bend < groove.radius) {
    throw NumericalError(fmt::format(
        "{}: its line bends with a radius of {:.3g} mm, sharper than the cutter", title, bend));
  }
  gp_Pnt start;
  gp_Vec way;
  spine->D1(spine->FirstParameter(), start, way);
  const gp_Circ circle(gp_Ax2(start, gp_Dir(way)), groove.radius);
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle).Edge()).Wire();
  const TopoDS_Wire line = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(spine).Edge()).Wire();
  return BRepOffsetAPI_MakePipe(line, BRepBuilderAPI_MakeFace(wire).Face()).Shape();
}

TopoDS_Shape ring_at(const TopoDS_Shape& solid, const GrooveEdit& groove, const gp_Ax1& axis) {
  const std::string title = groove.title();
  const gp_Pnt centre = axis.Location().Translated(gp_Vec(axis.Direction()) * *groove.ring_at);
  BRepAlgoAPI_Section section(solid, gp_Pln(centre, axis.Direction()));
  double outer = 0.0;
  for (TopExp_Explorer it(section.Shape(), TopAbs_EDGE); it.More(); it.Next()) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(it.Current()));
    for (int i = 0; i <= 32; ++i) {
      const double t =
          curve.FirstParameter() + (curve.LastParameter() - curve.FirstParameter()) * i / 32.0;
      outer = std::max(outer, centre.Distance(curve.Value(t)));
    }
  }
  if (outer == 0.0) {
    throw NumericalError(fmt::format("{}: the product doesn't reach {:.4g} mm along its axis",
                                     title, *groove.ring_at));
  }
  const double run = outer - groove.depth + groove.radius;  // the cutter's centre, from the axis
  if (groove.depth >= outer || run <= groove.radius) {
    throw NumericalError(
        fmt::format("{}: the product is only {:.4g} mm thick there", title, 2 * outer));
  }
  return BRepPrimAPI_MakeTorus(gp_Ax2(centre, axis.Direction()), run, groove.radius).Shape();
}

}  // namespace

void cut_groove(SolidEdit& edit, const GrooveEdit& groove, const gp_Ax1& axis) {
  groove.check();
  const std::string title = groove.title();
  try_feature(title, [&] {
    TopTools_ListOfShape solids, bars;
    solids.Append(edit.solid);
    bars.Append(groove.ring_at ? ring_at(edit.solid, groove, axis) : bar_along(edit.solid, groove));
    BRepAlgoAPI_Cut cut;
    cut.SetArguments(solids);
    cut.SetTools(bars);
    cut.Build();
    if (!cut.IsDone() || cut.HasErrors()) {
      throw NumericalError(title + ": can't be cut");
    }
    const double before = volume_of(edit.solid);
    const TopoDS_Shape solid = checked_solid(cut.Shape(), title);
    if (!(volume_of(solid) < before)) {
      throw NumericalError(title + ": cuts nothing");
    }
    edit.follow(solid, [&](const TopoDS_Face& face) { return cut.Modified(face); });
    if (groove.rim <= 0.0) return;
    const std::string rim = fmt::format("{}, rim of {:.4g} mm", title, groove.rim);
    TopTools_IndexedMapOfShape old;
    for (const auto& [number, images] : edit.image) {
      for (const TopoDS_Face& face : images) old.Add(face);
    }
    TopTools_IndexedDataMapOfShapeListOfShape faces_of;
    TopExp::MapShapesAndAncestors(solid, TopAbs_EDGE, TopAbs_FACE, faces_of);
    BRepFilletAPI_MakeFillet fillet(solid);
    for (int i = 1; i <= faces_of.Extent(); ++i) {
      const TopTools_ListOfShape& faces = faces_of(i);
      const bool is_rim =
          faces.Extent() == 2 && old.Contains(faces.First()) != old.Contains(faces.Last());
      const TopoDS_Edge edge = TopoDS::Edge(faces_of.FindKey(i));
      if (is_rim && fillet.Contour(edge) == 0) fillet.Add(groove.rim, edge);
    }
    fillet.Build();
    if (!fillet.IsDone()) throw NumericalError(rim + ": leaves no room beside the groove");
    const TopoDS_Shape rounded = checked_solid(fillet.Shape(), rim);
    edit.follow(rounded, [&](const TopoDS_Face& face) { return fillet.Modified(face); });
  });
}

}  // namespace palmar::cad
