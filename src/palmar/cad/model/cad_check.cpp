// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/cad_check.h"

#include <Adaptor3d_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepCheck_ListIteratorOfListOfStatus.hxx>
#include <BRepCheck_ListOfStatus.hxx>
#include <BRepCheck_Result.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <functional>
#include <gp_Lin.hxx>
#include <gp_Torus.hxx>
#include <optional>
#include <vector>

#include "palmar/cad/model/occt_model.h"
#include "palmar/core/text.h"

namespace palmar::cad {
namespace {

constexpr std::size_t kMostFindings = 20;

/// Status in plain words; the kernel's others by number.
std::string words_of(BRepCheck_Status status) {
  switch (status) {
    case BRepCheck_SelfIntersectingWire:
      return "its outline crosses itself";
    case BRepCheck_IntersectingWires:
      return "its outlines cross";
    case BRepCheck_UnorientableShape:
      return "inside and outside can't be determined";
    case BRepCheck_BadOrientationOfSubshape:
    case BRepCheck_BadOrientation:
      return "it is turned the wrong way";
    case BRepCheck_NotClosed:
      return "it is not closed";
    case BRepCheck_NoSurface:
      return "it has no surface";
    case BRepCheck_InvalidCurveOnSurface:
    case BRepCheck_InvalidSameParameterFlag:
    case BRepCheck_InvalidCurveOnClosedSurface:
      return "an edge is off the surface";
    case BRepCheck_FreeEdge:
      return "an edge is free";
    case BRepCheck_InvalidPointOnCurve:
    case BRepCheck_InvalidPointOnSurface:
    case BRepCheck_InvalidPointOnCurveOnSurface:
      return "a corner is off its edge";
    default:
      return "kernel's finding " + std::to_string(static_cast<int>(status));
  }
}

void add_findings(const BRepCheck_Analyzer& analyzer, const TopTools_IndexedMapOfShape& shapes,
                  const std::string& what, std::vector<std::string>& findings) {
  for (int i = 1; i <= shapes.Extent(); ++i) {
    if (findings.size() >= kMostFindings) return;
    const Handle(BRepCheck_Result) result = analyzer.Result(shapes(i));
    if (result.IsNull()) continue;
    std::string text;
    const auto add = [&](const BRepCheck_ListOfStatus& list) {
      for (BRepCheck_ListIteratorOfListOfStatus it(list); it.More(); it.Next()) {
        if (it.Value() == BRepCheck_NoError) continue;
        const std::string words = words_of(it.Value());
        if (text.find(words) == text.npos) text += (text.empty() ? "" : ", ") + words;
      }
    };
    add(result->Status());
    for (result->InitContextIterator(); result->MoreShapeInContext();
         result->NextShapeInContext()) {
      add(result->StatusOnShape());
    }
    if (!text.empty()) findings.push_back(what + " " + std::to_string(i) + ": " + text);
  }
}

int free_edges_of(const TopoDS_Shape& shape) {
  TopTools_IndexedDataMapOfShapeListOfShape faces_of;
  TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces_of);
  int count = 0;
  for (int i = 1; i <= faces_of.Extent(); ++i) {
    const TopoDS_Edge& edge = TopoDS::Edge(faces_of.FindKey(i));
    if (BRep_Tool::Degenerated(edge)) continue;
    // A seam has its face twice in the list.
    if (faces_of(i).Extent() == 1) ++count;
  }
  return count;
}

constexpr double kHalfTurn = 3.2;  // rad, a little more: what is turned less needn't meet itself

/// Whether a surface of revolution lies on both sides of its axis; `radius`: of its meridian by v,
/// below 0 beyond the axis, mm.
bool crosses_axis(const BRepAdaptor_Surface& surface,
                  const std::function<double(double v)>& radius) {
  constexpr int kSteps = 360;
  constexpr double kTouching = 1e-3;  // mm; one that only touches it
  double least = 0.0, most = 0.0;
  for (int k = 0; k <= kSteps; ++k) {
    const double v = surface.FirstVParameter() +
                     (surface.LastVParameter() - surface.FirstVParameter()) * k / kSteps;
    least = std::min(least, radius(v));
    most = std::max(most, radius(v));
  }
  return least < -kTouching && most > kTouching;
}

/// The signed radius of a surface whose meridian lies in a plane with its axis; nothing of others.
std::optional<std::function<double(double v)>> signed_radius(const BRepAdaptor_Surface& surface) {
  constexpr int kSteps = 64;
  const Handle(Adaptor3d_Curve) meridian = surface.BasisCurve();
  const gp_Ax1 axis = surface.AxeOfRevolution();
  const auto outwards = [meridian, axis](double v) {
    const gp_Vec from(axis.Location(), meridian->Value(v)), along(axis.Direction());
    return from - along * from.Dot(along);
  };
  gp_Vec farthest;
  std::vector<gp_Vec> all;
  for (int k = 0; k <= kSteps; ++k) {
    all.push_back(outwards(surface.FirstVParameter() +
                           (surface.LastVParameter() - surface.FirstVParameter()) * k / kSteps));
    if (all.back().Magnitude() > farthest.Magnitude()) farthest = all.back();
  }
  if (farthest.Magnitude() < 1e-6) return std::nullopt;
  const gp_Vec way = farthest.Normalized();
  for (const gp_Vec& one : all) {
    if (one.Crossed(way).Magnitude() > 1e-4) return std::nullopt;
  }
  return [outwards, way](double v) { return outwards(v).Dot(way); };
}

}  // namespace

Box3 box_of(const CadModel& model) {
  Box3 result;
  if (model.is_empty()) return result;
  Bnd_Box box;
  BRepBndLib::AddOptimal(model.impl().shape, box, Standard_False, Standard_False);
  if (box.IsVoid()) return result;
  const gp_Pnt low = box.CornerMin(), high = box.CornerMax();
  result.extend(Vec3(low.X(), low.Y(), low.Z()));
  result.extend(Vec3(high.X(), high.Y(), high.Z()));
  return result;
}

double volume_of(const CadModel& model) {
  double volume = 0.0;
  if (model.is_empty()) return volume;
  for (TopExp_Explorer it(model.impl().shape, TopAbs_SOLID); it.More(); it.Next()) {
    GProp_GProps properties;
    BRepGProp::VolumeProperties(it.Current(), properties);
    volume += properties.Mass();
  }
  return volume;
}

CadCheck check_cad(const CadModel& model) {
  CadCheck check;
  if (model.is_empty()) {
    check.findings.push_back("there is no shape");
    return check;
  }
  const CadModel::Impl& impl = model.impl();
  check.bodies = static_cast<int>(impl.bodies.size());
  check.solids = model.solid_count();
  check.faces = model.face_count();
  check.edges = model.edge_count();
  const BRepCheck_Analyzer analyzer(impl.shape);
  const std::string crossing = self_crossing(model);
  check.is_valid = analyzer.IsValid() && crossing.empty();
  if (!crossing.empty()) check.findings.push_back(crossing);
  if (!check.is_valid) {
    add_findings(analyzer, impl.faces, "face", check.findings);
    add_findings(analyzer, impl.edges, "edge", check.findings);
    if (check.findings.empty()) {
      check.findings.push_back("the shells and solids don't fit together");
    }
  }
  int loose = 0;
  for (TopExp_Explorer it(impl.shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next()) ++loose;
  for (const CadModel::Impl::Body& body : impl.bodies)
    check.free_edges += free_edges_of(body.shape);
  check.is_closed = check.solids > 0 && loose == 0 && check.free_edges == 0;
  if (check.free_edges > 0) {
    check.findings.push_back("open shell: " + std::to_string(check.free_edges) +
                             " edges have a face on one side only");
  }
  if (loose > 0) {
    check.findings.push_back(std::to_string(loose) + " faces belong to no solid");
  }
  check.volume = volume_of(model);
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(impl.shape, properties);
  check.area = properties.Mass();
  if (check.solids > 0 && !(check.volume > 0.0)) {
    check.findings.push_back("its volume is " + std::to_string(check.volume) +
                             " mm3; a solid's is positive");
  }
  return check;
}

std::string self_crossing(const CadModel& model) {
  for (int f = 1; f <= model.face_count(); ++f) {
    const BRepAdaptor_Surface surface(TopoDS::Face(model.impl().faces(f)), Standard_True);
    if (surface.LastUParameter() - surface.FirstUParameter() < kHalfTurn) continue;
    std::string what;
    if (surface.GetType() == GeomAbs_Torus) {
      const gp_Torus torus = surface.Torus();
      if (crosses_axis(surface, [&](double v) {
            return torus.MajorRadius() + torus.MinorRadius() * std::cos(v);
          })) {
        what = "a torus with a ring of radius " + significant(torus.MajorRadius(), 4) +
               " mm and a tube of " + significant(torus.MinorRadius(), 4) + " mm";
      }
    } else if (surface.GetType() == GeomAbs_SurfaceOfRevolution) {
      if (const auto radius = signed_radius(surface); radius && crosses_axis(surface, *radius)) {
        what = "a surface of revolution";
        if (surface.BasisCurve()->GetType() == GeomAbs_Circle) {
          const gp_Circ circle = surface.BasisCurve()->Circle();
          const double ring = gp_Lin(surface.AxeOfRevolution()).Distance(circle.Location());
          what = "a torus with a ring of radius " + significant(ring, 4) + " mm and a tube of " +
                 significant(circle.Radius(), 4) + " mm";
        }
      }
    }
    if (what.empty()) continue;
    return "face " + std::to_string(f) + " passes through itself: " + what +
           " crosses its own axis; a surface of a solid doesn't. Make the tube thinner than the "
           "ring, or trim the face where it meets the axis";
  }
  return "";
}

int most_poles(const CadModel& model) {
  int most = 0;
  for (TopExp_Explorer it(model.impl().shape, TopAbs_FACE); it.More(); it.Next()) {
    const Handle(Geom_BSplineSurface) surface =
        Handle(Geom_BSplineSurface)::DownCast(BRep_Tool::Surface(TopoDS::Face(it.Current())));
    if (!surface.IsNull()) most = std::max(most, surface->NbUPoles() * surface->NbVPoles());
  }
  return most;
}

}  // namespace palmar::cad
